//! Fits any plant to its records and names what its model lacks.
//!
//! # What it is
//!
//! A plant is a program file: rates and outputs with exact derivatives, a description, and a catalogue of
//! effects, written by the Python package `gyrocal_plant` (`docs/any-plant.md`). [`LoadedPlant`] interprets
//! it, or takes generated Rust ([`Generated`]) for its functions. [`diagnose`] fits the nominal model to a
//! [`PlantRecord`], searches for the effects of the catalogue and returns them with sets, sizes,
//! significance and, with a later record, their gain: a [`gyrocal_answer::Answer`]. [`diagnose_records`] does so
//! for several records of one plant. [`fit()`] fits the nominal model alone, [`compare`] several of them beside
//! each other, and [`simulate`] tells what is uncertain of a run. `gyrocal-words` says it in words.
//!
//! # How it works
//!
//! [`FittedPlant`] is a [`gyrocal_hypothesis::FittedModel`]; the search is that of `gyrocal-hypothesis`.
//! A record is linearised about a trajectory. A Kalman filter on the states carries the derivatives by
//! initial states, parameters and effects along as columns. Without noise of the rates it is a simulation.
//! Records that are joined have a step between them that begins with free states.
//! Gauss-Newton steps by multiple shooting lead to the fit; noise levels maximise the restricted likelihood.
//! What a search in white noise finds is judged beside process noise of every rate and correlated noise of every
//! output. Where what is left is not white, each effect must also simulate parts better that were left out of the fit.
//!
//! # Example
//!
//! ```no_run
//! use std::path::Path;
//!
//! use gyrocal_plant::{ColumnMap, LoadedPlant, SearchOptions, diagnose};
//!
//! let plant = LoadedPlant::read(Path::new("plant.json"))?;
//! let columns = ColumnMap::read(Path::new("columns.toml"))?;
//! let record = columns.record(plant.description(), Path::new("record.csv"))?;
//! let diagnosed = diagnose(&plant, record, None, &SearchOptions::default())?;
//! for sentence in gyrocal_words::plant::all(&diagnosed.answer) {
//!     println!("{sentence}");
//! }
//! # Ok::<(), gyrocal_plant::PlantError>(())
//! ```
//!
//! # What it does not do
//!
//! It draws nothing, and has no random walks. Play and delays are those of inputs.

mod all_noise;
mod answer;
mod catalogue;
mod columns;
mod comparison;
mod correlation;
mod cross_validation;
pub mod description;
mod diagnosed;
mod diagnosis;
mod dynamics;
mod error;
mod extension;
mod first_values;
mod fit;
mod fitted;
mod fitted_noise;
mod forward;
mod functions;
mod generated;
mod identifiability;
mod interpreted;
mod judged;
mod knee_interval;
mod late;
mod later_starts;
mod left_out;
mod linearised;
mod lines;
mod loaded;
mod next_run;
mod noise;
mod play;
mod prediction;
mod problem;
mod record;
mod series;
mod several;
mod simulation;
mod solve;
mod starts;
mod taken_up;
mod tape;

pub use columns::{ColumnMap, RecordText};
pub use comparison::compare;
pub use diagnosed::Diagnosed;
pub use diagnosis::diagnose;
pub use error::PlantError;
pub use extension::{Extension, ExtensionTerm};
pub use fit::{Fit, fit};
pub use fitted::FittedPlant;
pub use forward::{SimulatedCourse, Simulation, simulate};
pub use functions::{Functions, OutputsAt, Point, RatesAt, Sizes, Workspace};
pub use generated::Generated;
pub use gyrocal_hypothesis::SearchOptions;
pub use interpreted::Interpreted;
pub use loaded::LoadedPlant;
pub use record::{NamedRecord, PlantRecord};
pub use series::{OutputCorrelation, OutputSeries, RecordSeries};
pub use several::{DiagnosedRecords, diagnose_records};

//! Fits any plant to its records.
#![allow(missing_docs)]
pub mod answer;
mod backward;
mod catalogue;
mod columns;
pub mod description;
mod diagnosis;
mod dynamics;
mod error;
mod fitted;
mod functions;
mod generated;
mod identifiability;
mod interpreted;
mod lines;
mod loaded;
mod noise;
mod pass;
mod prediction;
mod problem;
mod record;
mod solve;
mod starts;
mod taken_up;
mod tape;

pub use columns::ColumnMap;
pub use diagnosis::{Diagnosed, diagnose};
pub use error::PlantError;
pub use fitted::FittedPlant;
pub use gyrocal_hypothesis::SearchOptions;
pub use functions::{Functions, OutputsAt, Point, RatesAt, Sizes, Workspace};
pub use generated::Generated;
pub use identifiability::{NullDirection, NullPart};
pub use interpreted::Interpreted;
pub use loaded::LoadedPlant;
pub use record::PlantRecord;
pub use starts::Starts;

//! Operating characteristics of the diagnosis: how often it is right, over populations of records.
//!
//! # What it is
//!
//! A [`Cell`] is a population of simulated records in which the same is hidden: nothing, an effect
//! of the catalogue a number of sigmas large, two effects, something that the catalogue does not
//! hold. [`Cell::examine`] draws the record of a seed, diagnoses it, asks other [`Method`]s too, and
//! returns a [`Case`]; [`campaign`] runs a cell over many seeds, resumable, and [`cell_report`] says
//! what they show: [`Characteristic`]s with their targets, the same by family, and the methods side by
//! side.
//!
//! The size of an effect is its length d in sigmas of its own bound: sizes δ with
//! d² = δᵀ J δ, J the information of the record on them with the nine coefficients, the first
//! attitude and whatever else is hidden projected out, white noise of the gyros included.
//! [`plant`] draws such sizes.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_characterise::{Cell, campaign, cell_report};
//!
//! let (cell, seeds) = (Cell::Single(8), 0..100);
//! let outcome = campaign(cell, seeds.clone(), &[])
//!     .results("d8.jsonl")
//!     .run(|seed| cell.examine(seed, &[]), |_| ())?;
//! for figure in cell_report(cell, &outcome, &seeds).characteristics {
//!     println!("{}: {:?}", figure.figure, figure.measured);
//! }
//! # Ok::<(), gyrocal_campaign::CampaignError>(())
//! ```
//!
//! # What it does not do
//!
//! It prints nothing. Noise in its records is as declared, effects of noise are not among what is
//! hidden.

mod bank;
mod beyond;
mod case;
mod cell;
mod characteristic;
mod comparison;
mod error;
mod family;
mod judge;
mod methods;
mod plant;
mod population;
mod report;
mod signature;
mod summary;

pub use bank::Bank;
pub use case::{Case, FoundCase, HiddenCase, MethodCase, same};
pub use cell::Cell;
pub use characteristic::{Characteristic, Target};
pub use comparison::{ComparisonRow, OWN, comparison};
pub use error::CharacteriseError;
pub use family::{FamilyRow, families, family};
pub use methods::{Called, Method};
pub use plant::{Planted, fitted, plant, plant_any, plant_in, searched, shape};
pub use population::scenario;
pub use report::{CellReport, CharacteriseReport, campaign, cell_report};
pub use signature::{Columns, Signature};
pub use summary::{NEAR_PARALLEL, characteristics};

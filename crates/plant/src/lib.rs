//! Fits any plant to its records.
#![allow(missing_docs)]
mod backward;
mod catalogue;
pub mod description;
mod dynamics;
mod error;
mod fitted;
mod functions;
mod generated;
mod interpreted;
mod lines;
mod loaded;
mod noise;
mod pass;
mod problem;
mod record;
mod solve;
mod starts;
mod tape;

pub use error::PlantError;
pub use fitted::FittedPlant;
pub use functions::{Functions, OutputsAt, Point, RatesAt, Sizes, Workspace};
pub use generated::Generated;
pub use interpreted::Interpreted;
pub use loaded::LoadedPlant;
pub use record::PlantRecord;
pub use starts::Starts;

//! Errors of this crate.

use std::path::PathBuf;

use gyrocal_hypothesis::Singular;
use gyrocal_inference::{PassError, Stopped};

/// A plant or a record that cannot be used, or a fit that fails.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlantError {
    /// A file cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        reason: std::io::Error,
    },
    /// A program file is not one, or contradicts itself.
    #[error(transparent)]
    Program(#[from] gyrocal_codegen::Error),
    /// A program file is not that of a plant.
    #[error("{origin}: {problem}; write it with gyrocal_plant (docs/any-plant.md)")]
    NoPlant {
        /// The file.
        origin: String,
        /// The problem.
        problem: String,
    },
    /// Content of a file of columns or of a record is not as it should be.
    #[error("{origin}: {problem}; {advice}")]
    Input {
        /// The file, with line and column where there is one.
        origin: String,
        /// What was found.
        problem: String,
        /// What to do.
        advice: String,
    },
    /// The model leaves the numbers.
    #[error(
        "the model gives no finite numbers from row {row} on; check the parameters and the inputs there"
    )]
    NotFinite {
        /// The row.
        row: usize,
    },
    /// The record does not determine all unknowns.
    #[error(
        "the record does not determine all parameters and initial states together; give priors, or hold some"
    )]
    Singular,
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// No start leads to a fit.
    #[error(
        "the model cannot be fitted to the record from any start: {reason}; check units and signs of the \
             columns, and the values of the parameters"
    )]
    NoFit {
        /// The failure of the start that came nearest, and where it ended.
        reason: String,
        /// Its cost, and the values of its unknowns.
        reached: Option<Box<(f64, Vec<f64>)>>,
    },
    /// One of several models fails.
    #[error("{name}: {reason}")]
    OfModel {
        /// The model.
        name: String,
        /// What fails.
        reason: Box<PlantError>,
    },
}

impl From<Singular> for PlantError {
    fn from(_: Singular) -> Self {
        Self::Singular
    }
}

/// A pass fails where the numbers do not suffice, or in a job that was stopped.
impl From<PassError> for PlantError {
    fn from(error: PassError) -> Self {
        match error {
            PassError::Stopped(stopped) => stopped.into(),
            PassError::Estimation(_) => Self::Singular,
        }
    }
}

/// `None` in the place of a model that cannot be fitted.
pub(crate) fn or_none<T>(result: Result<T, PlantError>) -> Result<Option<T>, PlantError> {
    match result {
        Ok(found) => Ok(Some(found)),
        Err(PlantError::NoFit { .. } | PlantError::Singular | PlantError::NotFinite { .. }) => {
            Ok(None)
        }
        Err(other) => Err(other),
    }
}

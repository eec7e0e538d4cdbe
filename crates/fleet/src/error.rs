//! Errors of this crate.

use gyrocal_hypothesis::Stopped;
use gyrocal_record::Error as RecordError;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FleetError {
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// Nothing to look at.
    #[error("found no diagnosed record, expected one at least")]
    NoRecords,
    /// A probability out of its range.
    #[error("{what} is {found}, expected a probability between 0 and 1")]
    Probability {
        /// The setting.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// Bytes that are no scores.
    #[error("scores of a record: {0}")]
    Scores(&'static str),
    /// A result that cannot be read.
    #[error(transparent)]
    Result(#[from] RecordError),
}

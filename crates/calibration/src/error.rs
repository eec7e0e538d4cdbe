use gyrocal::EstimationError;

/// Why a record could not be calibrated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The record has fewer rows than the filter has states.
    #[error(
        "the record has {found} rows, expected at least {expected}, the number of states; record for longer"
    )]
    TooShort {
        /// Rows of the record.
        found: usize,
        /// Rows that are needed.
        expected: usize,
    },
    /// The filter could not go on.
    #[error("the filter stopped at row {row} of the data (t = {time_s} s): {source}")]
    Filter {
        /// Row of the data, counted from 1.
        row: usize,
        /// Time of that row, s.
        time_s: f64,
        /// What the filter said.
        source: EstimationError,
    },
}

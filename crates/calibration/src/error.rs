use gyrocal::EstimationError;

/// Why a record could not be calibrated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The record has fewer rows with a measured value than the filter has states.
    #[error(
        "the record has {found} rows with a value of an accelerometer, expected at least \
         {expected}, the number of states; record for longer"
    )]
    TooShort {
        /// Rows in which an accelerometer has a value.
        found: usize,
        /// Rows that are needed.
        expected: usize,
    },
    /// The columns of the record differ in length.
    #[error("the record has {times} times and {samples} samples, expected as many of each")]
    UnequalLengths {
        /// Number of times.
        times: usize,
        /// Number of accelerometer samples.
        samples: usize,
    },
    /// The filter could not go on; the source says why.
    #[error("the filter stopped at row {row} of the data (t = {time_s} s)")]
    Filter {
        /// Row of the data, counted from 1.
        row: usize,
        /// Time of that row, s.
        time_s: f64,
        /// What the filter said.
        source: EstimationError,
    },
    /// Rounding left the coefficients a covariance that no errors can have: variances are
    /// positive, but that of some combination of coefficients is not.
    #[error(
        "the covariance of the coefficients is not positive definite after the last row: the \
         prior is too wide for what the record says; narrow it, record for longer, or carry the \
         covariance as factors"
    )]
    NotPositiveDefinite,
}

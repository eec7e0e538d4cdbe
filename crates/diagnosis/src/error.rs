use gyrocal_statistics::StatisticsError;

/// Why a record could not be examined.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// Two series that belong together differ in length.
    #[error("{found} rows of {what}, expected {expected}, as many as the record has")]
    UnequalLengths {
        /// What has another length.
        what: &'static str,
        /// Its number of rows.
        found: usize,
        /// The number of rows of the record.
        expected: usize,
    },
    /// Too few values for a test.
    #[error("{test} has {found} values, expected at least {expected}; record for longer")]
    TooShort {
        /// The test.
        test: &'static str,
        /// Number of values.
        found: usize,
        /// Number of values needed.
        expected: usize,
    },
    /// A covariance of an innovation that no errors can have.
    #[error("the covariance of the innovation of row {row} is not positive definite")]
    NotPositiveDefinite {
        /// Row, counted from 1.
        row: usize,
    },
    /// An argument without meaning.
    #[error("{what} is {found}, expected {expected}")]
    InvalidArgument {
        /// The argument.
        what: &'static str,
        /// Its value.
        found: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A statistic that could not be computed.
    #[error(transparent)]
    Statistics(#[from] StatisticsError),
}

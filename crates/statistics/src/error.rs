/// Failure of the computation of a statistic.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StatisticsError {
    /// Two series that belong together differ in length.
    #[error("{found} {what}, expected {expected}, as many as there are values in the other series")]
    UnequalLengths {
        /// The series of the other length.
        what: &'static str,
        /// Its number of values.
        found: usize,
        /// The number of values of the series it belongs to.
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
    /// An argument without meaning.
    #[error("{what} is {found}, expected {expected}")]
    InvalidArgument {
        /// The argument.
        what: &'static str,
        /// Its value.
        found: f64,
        /// The values it may have.
        expected: &'static str,
    },
    /// Fewer than three samples for each averaging time.
    #[error(
        "found {found} samples, expected at least {expected}; record for longer, or ask for \
         shorter averaging times"
    )]
    AveragingTooLong {
        /// Number of samples.
        found: usize,
        /// Number of samples needed for the longest averaging time.
        expected: usize,
    },
    /// A sample that is missing or infinite where every one is needed.
    #[error(
        "found a sample that is no finite number (number {sample}), expected a rate at every \
         sample; cut the recording where samples are missing"
    )]
    NotFinite {
        /// Number of the sample, counted from 1.
        sample: usize,
    },
    /// A deviation outside the range of numbers.
    #[error(
        "found a deviation of {deviation:e} at an averaging time of {tau_s:e} s, expected finite \
         numbers; choose a unit of the rate and a sampling rate of a usual size"
    )]
    Overflow {
        /// The deviation, or a bound of it, as computed.
        deviation: f64,
        /// Its averaging time \[s\].
        tau_s: f64,
    },
}

//! The error of this crate.

use gyrocal_record::printable_line;
use gyrocal_statistics::StatisticsError;

/// Failure of an instrument test.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InstrumentError {
    /// A file violates its format.
    #[error(transparent)]
    File(#[from] gyrocal_record::Error),
    /// A statistic has no meaning with these arguments.
    #[error(transparent)]
    Statistics(StatisticsError),
    /// The recording contradicts its description, or is not suitable for the test.
    #[error(
        "found {}, expected {}; {}",
        printable_line(found),
        printable_line(expected),
        printable_line(advice)
    )]
    Unfit {
        /// Kind of the problem.
        kind: Unfit,
        /// Found property of the recording.
        found: String,
        /// Expected property.
        expected: String,
        /// Advice to the user.
        advice: String,
    },
}

/// Kind of a problem of a recording as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unfit {
    /// Too few samples, stops or turns.
    TooShort,
    /// Samples are missing.
    Gap,
    /// The intervals between time stamps scatter too much.
    Jitter,
    /// A binary file is not as its description says.
    Binary,
    /// No interval is at rest.
    NeverStatic,
    /// The norm of specific force is not gravity.
    Norm,
    /// The rate at rest or between stops contradicts the unit of the gyros.
    GyroScale,
    /// The scale of raw counts is missing.
    NoScale,
    /// The log of an instrument test has no gyros.
    NoGyros,
    /// What a command computes needs accelerometers, and the log has none.
    NoAccelerometers,
    /// The axes are left-handed, or those of gyros and accelerometers are not the same.
    Axes,
    /// The attitudes do not determine the unknowns.
    Undetermined,
    /// A temperature that is none in its unit.
    Temperature,
    /// A gyro at the end of its range.
    Saturated,
    /// A gyro that repeats one value, or rows that are padding.
    Stuck,
    /// A setting outside its range.
    Setting,
}

impl InstrumentError {
    pub(crate) fn unfit(
        kind: Unfit,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self::Unfit {
            kind,
            found: found.into(),
            expected: expected.into(),
            advice: advice.into(),
        }
    }

    /// Advice to the user; empty if there is none.
    #[must_use]
    pub fn advice(&self) -> &str {
        match self {
            Self::File(gyrocal_record::Error::Input(input)) => &input.advice,
            Self::Unfit { advice, .. } => advice,
            Self::File(_) | Self::Statistics(_) => "",
        }
    }

    /// Kind of a problem of the recording; `None` for errors of files and of arguments.
    #[must_use]
    pub fn kind(&self) -> Option<Unfit> {
        match self {
            Self::Unfit { kind, .. } => Some(*kind),
            Self::File(_) | Self::Statistics(_) => None,
        }
    }
}

impl From<StatisticsError> for InstrumentError {
    fn from(error: StatisticsError) -> Self {
        match error {
            StatisticsError::AveragingTooLong { found, expected } => Self::unfit(
                Unfit::TooShort,
                format!("{found} samples"),
                format!("at least {expected}"),
                "record for longer, or ask for shorter averaging times",
            ),
            StatisticsError::NotFinite { sample } => Self::unfit(
                Unfit::Gap,
                format!("a sample that is no finite number (number {sample})"),
                "a rate at every sample",
                "cut the recording where samples are missing",
            ),
            StatisticsError::Overflow { deviation, tau_s } => Self::unfit(
                Unfit::Setting,
                format!("a deviation of {deviation:e} at an averaging time of {tau_s:e} s"),
                "finite numbers",
                "choose a unit of the rate and a sampling rate of a usual size",
            ),
            other => Self::Statistics(other),
        }
    }
}

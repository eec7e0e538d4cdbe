use gyrocal_statistics::StatisticsError;

/// Why a recording could not be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeasuredError {
    /// A file is not what its format asks for.
    #[error(transparent)]
    File(#[from] gyrocal_record::Error),
    /// A statistic has no meaning with these arguments.
    #[error(transparent)]
    Statistics(StatisticsError),
    /// The recording contradicts what was said of it, or is not fit for the job.
    #[error("found {found}, expected {expected}; {advice}")]
    Unfit {
        /// What kind of thing is wrong.
        kind: Unfit,
        /// What the recording shows.
        found: String,
        /// What the job needs.
        expected: String,
        /// What to do.
        advice: String,
    },
}

/// What can be wrong with a recording as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unfit {
    /// Too few samples, stops or turns for the job.
    TooShort,
    /// Samples are missing.
    Gap,
    /// The intervals between time stamps scatter too much.
    Jitter,
    /// There is no stretch at rest.
    NeverStatic,
    /// The norm of specific force is not gravity.
    Norm,
    /// The rate at rest, or between stops, does not fit the unit of the gyros.
    GyroScale,
    /// Counts, and nothing that says what a count is.
    NoScale,
    /// The axes are left-handed, or those of gyros and accelerometers are not the same.
    Axes,
    /// The attitudes do not determine what is to be estimated.
    Undetermined,
    /// A setting outside its range.
    Setting,
}

impl MeasuredError {
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

    /// What kind of thing is wrong with the recording; `None` for errors of files and of
    /// arguments.
    #[must_use]
    pub fn kind(&self) -> Option<Unfit> {
        match self {
            Self::Unfit { kind, .. } => Some(*kind),
            Self::File(_) | Self::Statistics(_) => None,
        }
    }
}

impl From<StatisticsError> for MeasuredError {
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

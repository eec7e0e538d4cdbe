use core::fmt;

use gyrocal_estimation::EstimationError;

/// Answer of a [`ControllerFilter`](crate::ControllerFilter) that did not do as it was told.
///
/// [`Self::is_refusal`] and [`Self::has_coasted`] tell the kinds apart: a refused call has changed
/// nothing, and the next one may succeed; after a sample that only surprised the filter has coasted and
/// goes on; after a failure the filter has stopped and must be started or restored.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ControllerError {
    /// A component of the sample is infinite or no number; nothing has changed.
    SampleNotFinite {
        /// Index of the accelerometer.
        axis: usize,
    },
    /// A component of the sample is beyond the sensor's range; nothing has changed.
    SampleOutOfRange {
        /// Index of the accelerometer.
        axis: usize,
    },
    /// The NIS of the sample is beyond the limit. The sample was not taken; the time of the call has passed
    /// without it, so it needs no coasting.
    SampleSurprising,
    /// As [`Self::SampleSurprising`], and so were all samples of the last hour, ten at least: it is the
    /// filter that is wrong, see [`reopen`](crate::ControllerFilter::reopen).
    Diverged,
    /// No sample was taken since the start, and the drift of the prior has made the attitude so uncertain
    /// meanwhile that a linear filter cannot use one: start again at a sample. The time of the call has
    /// passed.
    GapAtStart,
    /// The interval is zero, negative or no number; nothing has changed.
    IntervalNotPositive,
    /// The interval is longer than declared possible, or infinite; nothing has changed.
    IntervalTooLong,
    /// The filter has not started, or has stopped with an error: start or restore it.
    NotRunning,
    /// A setting or a limit has no meaning, or a prior sigma is not positive: the filter is not
    /// running.
    Settings(EstimationError),
    /// The step failed, and the filter has stopped: start or restore it.
    Failed(EstimationError),
    /// The place of a saved state has another length than [`SAVED_BYTES`], nothing has changed.
    ///
    /// [`SAVED_BYTES`]: crate::ControllerFilter::SAVED_BYTES
    SavedLength {
        /// Expected length in bytes.
        expected: usize,
    },
    /// The saved state was written by another version of the format, for another model, number
    /// type or form of the covariance; nothing has changed.
    SavedVersion,
    /// The checksum of the saved state is wrong; nothing has changed.
    SavedChecksum,
    /// A number of the saved state is not finite, a variance not positive, or the attitude no
    /// rotation; nothing has changed.
    SavedNumbers,
}

impl ControllerError {
    /// True if nothing has changed, so that a running filter goes on.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        !self.has_coasted()
            && !matches!(self, Self::NotRunning | Self::Settings(_) | Self::Failed(_))
    }

    /// True if the time of the call has passed without its sample, and the filter goes on.
    #[must_use]
    pub fn has_coasted(&self) -> bool {
        matches!(
            self,
            Self::SampleSurprising | Self::Diverged | Self::GapAtStart
        )
    }
}

impl fmt::Display for ControllerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SampleNotFinite { axis } => write!(f, "sample {axis} is not finite"),
            Self::SampleOutOfRange { axis } => {
                write!(f, "sample {axis} is beyond the range of the sensor")
            }
            Self::SampleSurprising => write!(
                f,
                "the sample disagrees with the state beyond the limit of its NIS; it was not taken"
            ),
            Self::Diverged => write!(
                f,
                "the samples of an hour disagree with the state; reopen the filter or start it again"
            ),
            Self::GapAtStart => write!(
                f,
                "the attitude has become too uncertain since the start for a first sample; \
                 start again at a sample"
            ),
            Self::IntervalNotPositive => write!(f, "the interval is not positive"),
            Self::IntervalTooLong => write!(f, "the interval is longer than the limit"),
            Self::NotRunning => write!(f, "the filter is not running; start or restore it"),
            Self::Settings(error) => write!(f, "the filter has not started: {error}"),
            Self::Failed(error) => write!(f, "the filter has stopped: {error}"),
            Self::SavedLength { expected } => {
                write!(f, "a saved state has {expected} bytes")
            }
            Self::SavedVersion => write!(
                f,
                "the saved state is of another version, model, number type or form"
            ),
            Self::SavedChecksum => write!(f, "the checksum of the saved state is wrong"),
            Self::SavedNumbers => write!(f, "a number of the saved state has no meaning"),
        }
    }
}

impl core::error::Error for ControllerError {}

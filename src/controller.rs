use gyrocal_estimation::form::Form;
use gyrocal_estimation::{EstimationError, Innovation, Precision, Recentring};

use crate::controller_error::ControllerError;
use crate::filter::PlatformFilter;
use crate::initial_attitude::InitialAttitude;
use crate::limits::{Limits, Surprises};
use crate::saved::{self, SavedForm, SavedNumber};
use crate::settings::FilterSettings;

mod taking;

/// A streaming filter that a controller can run unattended: it refuses input that has no meaning
/// and says so, it starts in place and again after an error, and it can be saved and restored.
///
/// | call | time | sample | use |
/// |---|---|---|---|
/// | [`start`](Self::start) | | | once, and to forget everything |
/// | [`update`](Self::update) | stands | now | the first sample after a start |
/// | [`step`](Self::step) | passes | at the end of the interval | every sample after it |
/// | [`coast`](Self::coast) | passes | none | where a sample is missing or was refused |
/// | [`reopen`](Self::reopen) | stands | now | after [`ControllerError::Diverged`] |
/// | [`save`](Self::save), [`restore`](Self::restore) | stands | | around a reset |
///
/// A refused call changes nothing, so time has not passed either: after a refused sample,
/// [`Self::coast`] over its interval. A sample whose NIS is beyond [`Limits::largest_nis`] is not taken
/// either, but the filter has coasted to its time: [`ControllerError::SampleSurprising`]. The limit does
/// not hold while the attitude is so uncertain that no NIS says which sample is sound, as after a start
/// from a wide prior. Nothing here panics or allocates.
///
/// ```
/// use gyrocal::{ControllerError, ControllerFilter, FilterSettings, InitialAttitude, Limits, Site};
///
/// # fn main() -> Result<(), ControllerError> {
/// // In firmware, a static: nothing is built on the stack.
/// let mut filter = ControllerFilter::<f32>::unset();
/// let settings = FilterSettings::at_site(Site::at_latitude_deg(39.1));
/// filter.start(&settings, &InitialAttitude::aligned(), Limits::default())?;
/// filter.update(&[0.0, 0.0, 1.0])?;
/// // A sample that has no meaning is refused; the time passes without it.
/// let answer = filter.step(60.0, &[f32::NAN, 0.0, 1.0]);
/// assert_eq!(answer, Err(ControllerError::SampleNotFinite { axis: 0 }));
/// filter.coast(60.0)?;
/// let innovation = filter.step(60.0, &[0.006_8, 0.0, 0.999_97])?;
/// assert!(innovation.nis < 16.3, "NIS of three components, 99.9 %");
/// let _ = (filter.filter().drift(), filter.filter().drift_sigma());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct ControllerFilter<T: Precision = f32, F = <T as Precision>::Form> {
    filter: PlatformFilter<T, F>,
    limits: Limits<T>,
    surprises: Surprises<T>,
    /// Variance of the attitude at the start, rad², until a sample is taken.
    at_start: Option<T>,
    running: bool,
}

impl<T: SavedNumber, F: Form<T> + SavedForm> ControllerFilter<T, F> {
    /// Bytes of a saved state.
    pub const SAVED_BYTES: usize = saved::length(T::BYTES);

    /// A filter that has not started, for `static` memory: every call but [`Self::start`] is
    /// answered by [`ControllerError::NotRunning`].
    #[must_use]
    pub const fn unset() -> Self {
        Self {
            filter: PlatformFilter::unset(),
            limits: Limits::NONE,
            surprises: Surprises::NONE,
            at_start: None,
            running: false,
        }
    }

    /// Starts in place, at the first sample, which [`Self::update`] takes; whatever the filter was
    /// before is forgotten.
    ///
    /// # Errors
    /// [`ControllerError::Settings`] for a number without meaning ([`FilterSettings::check`]), and for a
    /// chart that does not move at every step; the filter is then not running.
    pub fn start(
        &mut self,
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
        limits: Limits<T>,
    ) -> Result<(), ControllerError> {
        self.running = false;
        self.limits = Limits::NONE;
        self.surprises = Surprises::NONE;
        if !limits.are_positive() {
            return Err(ControllerError::Settings(
                EstimationError::InvalidArgument {
                    expected: "positive limits",
                },
            ));
        }
        let meaningful = settings.check().and_then(|()| attitude.check());
        meaningful.map_err(ControllerError::Settings)?;
        if settings.discretisation.recentring != Recentring::EveryStep {
            return Err(ControllerError::Settings(
                EstimationError::InvalidArgument {
                    expected: "a chart that moves at every step",
                },
            ));
        }
        self.filter
            .start(settings, attitude)
            .map_err(ControllerError::Settings)?;
        self.limits = limits;
        self.at_start = Some(self.filter.attitude_variance());
        self.running = true;
        Ok(())
    }

    /// Starts again as [`Self::start`] does, with the limits that hold already.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn reset(
        &mut self,
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<(), ControllerError> {
        self.start(settings, attitude, self.limits)
    }

    /// Time passes, and at its end a sample is taken.
    ///
    /// # Errors
    /// A refusal of the sample or of the interval, and nothing has changed;
    /// [`ControllerError::SampleSurprising`] and [`ControllerError::Diverged`], and time has passed
    /// without the sample; [`ControllerError::NotRunning`]; [`ControllerError::Failed`], and the filter has stopped.
    #[inline]
    pub fn step(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        self.check_interval(interval_s)?;
        self.check_sample(specific_force_g)?;
        let result = self.filter.predict(interval_s);
        self.stopped_by(result)?;
        self.take(interval_s, specific_force_g)
    }

    /// Takes a sample at the time the filter is at: the first one after a start.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn update(
        &mut self,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        self.check_sample(specific_force_g)?;
        self.take(T::ZERO, specific_force_g)
    }

    /// Time passes without a sample.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn coast(&mut self, interval_s: T) -> Result<(), ControllerError> {
        self.check_interval(interval_s)?;
        let result = self.filter.predict(interval_s);
        self.stopped_by(result)
    }

    /// Writes the state, its covariance and the attitude to `place`, with version and checksum.
    ///
    /// # Errors
    /// [`ControllerError::SavedLength`] unless `place` has [`Self::SAVED_BYTES`];
    /// [`ControllerError::NotRunning`].
    pub fn save(&self, place: &mut [u8]) -> Result<(), ControllerError> {
        self.check_running()?;
        saved::save(&self.filter, place)
    }

    /// Takes over a saved state. The filter must have started, with the same site and noise as the
    /// one that was saved; the steps that follow then have the same bits as without a reset.
    /// A filter that has failed runs again.
    ///
    /// # Errors
    /// [`ControllerError::SavedLength`], [`ControllerError::SavedVersion`],
    /// [`ControllerError::SavedChecksum`] or [`ControllerError::SavedNumbers`], and nothing has
    /// changed; [`ControllerError::NotRunning`] if the filter was never started.
    pub fn restore(&mut self, saved: &[u8]) -> Result<(), ControllerError> {
        if !self.limits.longest_interval_s.is_positive() {
            return Err(ControllerError::NotRunning);
        }
        saved::restore(&mut self.filter, saved)?;
        self.at_start = None;
        self.surprises.end();
        self.running = true;
        Ok(())
    }

    /// True between a start and a failure.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.running
    }

    /// The filter, for its estimates and their sigmas.
    #[must_use]
    pub fn filter(&self) -> &PlatformFilter<T, F> {
        &self.filter
    }

    /// As [`PlatformFilter::predict`], in one part; for the watch.
    #[cfg(feature = "watch")]
    #[inline]
    pub(crate) fn predict(&mut self, interval_s: T) -> Result<(), ControllerError> {
        let result = self.filter.predict(interval_s);
        self.stopped_by(result)
    }

    /// The state has moved along a direction; for the watch.
    #[cfg(feature = "watch")]
    #[inline]
    pub(crate) fn displace(
        &mut self,
        direction: &[T; crate::generated::platform::Platform::STATES],
        size: T,
        variance: T,
    ) -> Result<(), ControllerError> {
        self.check_running()?;
        let kernel = self.filter.kernel_mut();
        let result = kernel.displace(direction, size, variance);
        self.stopped_by(result)
    }

    #[inline(always)]
    fn check_running(&self) -> Result<(), ControllerError> {
        if self.running {
            Ok(())
        } else {
            Err(ControllerError::NotRunning)
        }
    }

    #[inline(always)]
    pub(crate) fn check_interval(&self, interval_s: T) -> Result<(), ControllerError> {
        self.check_running()?;
        if !interval_s.is_positive() {
            return Err(ControllerError::IntervalNotPositive);
        }
        if interval_s > self.limits.longest_interval_s || !interval_s.is_finite() {
            return Err(ControllerError::IntervalTooLong);
        }
        Ok(())
    }

    #[inline(always)]
    pub(crate) fn check_sample(&self, specific_force_g: &[T; 3]) -> Result<(), ControllerError> {
        self.check_running()?;
        for (axis, force) in specific_force_g.iter().enumerate() {
            if !force.is_finite() {
                return Err(ControllerError::SampleNotFinite { axis });
            }
            if force.abs() > self.limits.largest_force_g {
                return Err(ControllerError::SampleOutOfRange { axis });
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn stopped_by<R>(&mut self, result: Result<R, EstimationError>) -> Result<R, ControllerError> {
        result.map_err(|error| match error {
            // With limits that are no limits: more than a million parts, and nothing has changed.
            EstimationError::InvalidArgument { .. } => ControllerError::IntervalTooLong,
            error => {
                self.running = false;
                ControllerError::Failed(error)
            }
        })
    }
}

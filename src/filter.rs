use gyrocal_estimation::form::Form;
use gyrocal_estimation::{ArrayStorage, EstimationError, Factors, Filter, Innovation, Precision};

use crate::anchor::{Anchored, Chart};
use crate::generated::platform::platform_index::GYRO_X_BIAS;
use crate::generated::platform::{Drift, Platform, reanchor};
use crate::initial_attitude::InitialAttitude;
// emit: off
use crate::rotation::angles;
// emit: on
use crate::settings::FilterSettings;

mod curvature;

/// Most parts that one interval is divided into: years of two-minute steps.
const MOST_PARTS: f64 = 1e6;

type PlatformKernel<T, F> =
    Filter<T, Anchored<Platform>, Chart<T>, ArrayStorage<T, 3, 3, { Platform::STATES }>, 3, 3, F>;

/// Streaming filter of the nominal platform: feed it accelerometer samples, read coefficients.
///
/// No call allocates. `F` is the form of the covariance. The default is the one that suits the
/// number type ([`Precision`]): P itself for `f64`; for `f32` its factors, because from the usual
/// priors P itself soon stops with an error in single precision. [`FactorisedPlatformFilter`] names
/// the factors for any number type.
///
/// | call | time | sample |
/// |---|---|---|
/// | [`step`](Self::step) | passes | at the end of the interval |
/// | [`update`](Self::update) | stands | now: the first sample, or a second sensor's |
/// | [`predict`](Self::predict) | passes | none: a gap in the data |
///
/// A call that fails may leave the filter unusable: each error says so. A controller that must go
/// on has [`ControllerFilter`](crate::ControllerFilter) around it.
#[derive(Clone, Debug)]
pub struct PlatformFilter<T: Precision = f64, F = <T as Precision>::Form> {
    kernel: PlatformKernel<T, F>,
    accel_variance_g2: [T; 3],
    drift_density: [T; 3],
    longest_step_s: T,
}

/// The streaming filter on the factors of the covariance, which cannot lose definiteness: the
/// default for `f32`, and for wide priors in `f64`.
///
/// ```
/// use gyrocal::{FactorisedPlatformFilter, FilterSettings, InitialAttitude, Site};
///
/// # fn main() -> Result<(), gyrocal::EstimationError> {
/// let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(39.1));
/// let mut filter = FactorisedPlatformFilter::factorised(&settings, &InitialAttitude::aligned())?;
/// filter.update(&[0.0, 0.0, 1.0])?;
/// # Ok(())
/// # }
/// ```
pub type FactorisedPlatformFilter<T = f32> = PlatformFilter<T, Factors>;

impl<T: Precision> PlatformFilter<T> {
    /// A filter at the first sample, which [`Self::update`] takes, in the form that suits its
    /// numbers.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn new(
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<Self, EstimationError> {
        Self::with_form(settings, attitude)
    }
}

impl<T: Precision> FactorisedPlatformFilter<T> {
    /// A filter at the first sample, which [`Self::update`] takes, on the factors of the
    /// covariance.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn factorised(
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<Self, EstimationError> {
        Self::with_form(settings, attitude)
    }
}

impl<T: Precision, F: Form<T>> PlatformFilter<T, F> {
    /// A filter at the first sample, which [`Self::update`] takes, in the form `F`.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn with_form(
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<Self, EstimationError> {
        let mut filter = Self::unset();
        filter.start(settings, attitude)?;
        Ok(filter)
    }

    /// A filter that has not started: for `static` memory, where [`Self::start`] starts it without
    /// a copy on the stack. Until then every step fails.
    #[must_use]
    pub const fn unset() -> Self {
        Self {
            kernel: Filter::unset(Anchored(Platform), Chart::unset(), ArrayStorage::new()),
            accel_variance_g2: [T::ZERO; 3],
            drift_density: [T::ZERO; 3],
            longest_step_s: T::ZERO,
        }
    }

    /// Starts in place, at the first sample, which [`Self::update`] takes; whatever the filter was
    /// before is forgotten.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`] or [`EstimationError::InvalidArgument`] if a
    /// sigma or noise is not positive; the filter has then not started.
    pub fn start(
        &mut self,
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<(), EstimationError> {
        let noise = settings.drift_noise_deg_per_h;
        if !(settings.accel_noise_g.is_positive()
            && noise.is_positive()
            && settings.discretisation.longest_step_s.is_positive())
        {
            return Err(EstimationError::InvalidArgument {
                expected: "positive noise and a positive longest step",
            });
        }
        let join = |moving: &[T; 3], parameters: [T; Platform::PARAMETERS]| {
            let mut all = [T::ZERO; Platform::STATES];
            all[..3].copy_from_slice(moving);
            all[3..].copy_from_slice(&parameters);
            all
        };
        let chart = self.kernel.inputs_mut();
        *chart = Chart::east_north_up(settings.site);
        let angles = attitude.place(chart);
        self.accel_variance_g2 = [settings.accel_noise_g * settings.accel_noise_g; 3];
        self.drift_density = [settings.drift_noise_density(); 3];
        self.longest_step_s = settings.discretisation.longest_step_s;
        self.kernel.start(
            settings.discretisation.integration,
            settings.discretisation.recentring,
            &join(&angles.angles_rad, settings.drift.to_array()),
            &join(&angles.sigma_rad, settings.drift_sigma.to_array()),
        )
    }

    /// Takes a sample at the time the filter is at. Components that are NaN are skipped.
    ///
    /// # Errors
    /// [`EstimationError::NotFinite`] if the sample is infinite,
    /// [`EstimationError::LostPrecision`] if the prior is too wide for this form, and
    /// [`EstimationError::NotPositiveDefinite`].
    #[inline]
    pub fn update(
        &mut self,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, EstimationError> {
        self.kernel
            .update(specific_force_g, &self.accel_variance_g2)
    }

    /// As [`Self::update`], for a chart that moves at every step, with `noise` added to the variances of
    /// the sample. One whose NIS exceeds `largest_nis` changes nothing, and takes no longer.
    #[inline(always)]
    pub(crate) fn update_at_origin(
        &mut self,
        specific_force_g: &[T; 3],
        noise: T,
        largest_nis: T,
    ) -> Result<Innovation<T, 3>, EstimationError> {
        let variance = self.accel_variance_g2.map(|variance| variance + noise);
        self.kernel
            .update_at_origin(specific_force_g, &variance, largest_nis)
    }

    /// As [`Self::update_at_origin`], with clipped innovations.
    #[cfg(feature = "watch")]
    #[inline]
    pub(crate) fn update_clipped(
        &mut self,
        specific_force_g: &[T; 3],
        clip: T,
        largest_nis: T,
    ) -> Result<Innovation<T, 3>, EstimationError> {
        self.kernel
            .update_clipped(specific_force_g, &self.accel_variance_g2, clip, largest_nis)
    }

    /// Number of parts that [`Self::predict`] divides an interval into.
    #[cfg(feature = "watch")]
    #[inline]
    pub(crate) fn parts(&self, interval_s: T) -> u32 {
        let parts = interval_s / self.longest_step_s;
        let whole = parts.to_u32();
        whole
            .saturating_add(u32::from(parts > T::from_u32(whole)))
            .clamp(1, MOST_PARTS as u32)
    }

    /// As [`Self::update`], but a sample whose NIS exceeds `largest_nis` is not used. Returns
    /// the innovation and whether the sample was used.
    ///
    /// # Errors
    /// As [`Self::update`].
    pub fn update_gated(
        &mut self,
        specific_force_g: &[T; 3],
        largest_nis: T,
    ) -> Result<(Innovation<T, 3>, bool), EstimationError> {
        self.kernel
            .update_gated(specific_force_g, &self.accel_variance_g2, largest_nis)
    }

    /// Predicts over `interval_s` seconds.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if the interval is not positive and finite, or longer
    /// than a million longest steps; other variants if the prediction is not finite.
    #[inline]
    pub fn predict(&mut self, interval_s: T) -> Result<(), EstimationError> {
        let parts = interval_s / self.longest_step_s;
        if parts > T::from_f64(1.0) && interval_s.is_finite() {
            if parts > T::from_f64(MOST_PARTS) {
                return Err(EstimationError::InvalidArgument {
                    expected: "an interval of at most a million longest steps",
                });
            }
            let whole = parts.to_u32();
            let count = whole + u32::from(parts > T::from_u32(whole));
            let part_s = interval_s / T::from_u32(count);
            for _ in 1..count {
                self.kernel.predict(part_s, &self.drift_density)?;
            }
            return self.kernel.predict(part_s, &self.drift_density);
        }
        self.kernel.predict(interval_s, &self.drift_density)
    }

    /// Predicts over `interval_s` seconds and takes the sample at the end of it.
    ///
    /// # Errors
    /// As [`Self::predict`] and [`Self::update`].
    #[inline]
    pub fn step(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, EstimationError> {
        self.predict(interval_s)?;
        self.update(specific_force_g)
    }

    /// The estimated drift coefficients: deg/h, deg/h/g, deg/h/g².
    #[must_use]
    pub fn drift(&self) -> Drift<T> {
        let state = self.kernel.state();
        Drift::from_array(core::array::from_fn(|i| state[GYRO_X_BIAS + i]))
    }

    /// Standard deviations of the errors of [`Self::drift`].
    #[must_use]
    pub fn drift_sigma(&self) -> Drift<T> {
        Drift::from_array(core::array::from_fn(|i| self.kernel.sigma(GYRO_X_BIAS + i)))
    }

    /// Covariance of the errors of [`Self::drift`], in the order of its fields.
    #[must_use]
    pub fn drift_covariance(&self) -> [[T; Platform::PARAMETERS]; Platform::PARAMETERS] {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| self.kernel.covariance(GYRO_X_BIAS + i, GYRO_X_BIAS + j))
        })
    }

    /// Estimated attitude: platform components from East, North, Up components.
    #[must_use]
    pub fn platform_c_enu(&self) -> [[T; 3]; 3] {
        let state = self.kernel.state();
        let platform_c_chart = reanchor(&[state[0], state[1], state[2]]).platform_c_chart;
        let chart_c_enu = self.kernel.inputs().chart_c_enu();
        core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                (0..3).fold(T::from_f64(0.0), |sum, l| {
                    platform_c_chart[i][l].mul_add(chart_c_enu[l][j], sum)
                })
            })
        })
    }

    // emit: off
    /// Estimated platform angles against East-North-Up, rad: rotations about x, then y, then z.
    #[must_use]
    pub fn angles_rad(&self) -> [T; 3] {
        angles(&self.platform_c_enu())
    }
    // emit: on

    /// The filter underneath, to restore it.
    pub(crate) fn kernel_mut(&mut self) -> &mut PlatformKernel<T, F> {
        &mut self.kernel
    }

    /// The filter underneath, for what this type does not show.
    #[must_use]
    pub fn kernel(&self) -> &PlatformKernel<T, F> {
        &self.kernel
    }
}

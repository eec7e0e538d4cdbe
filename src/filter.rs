use gyrocal_estimation::form::Form;
use gyrocal_estimation::{
    ArrayStorage, Covariance, EstimationError, Factors, Filter, Innovation, Integration, Recentring,
};
use gyrocal_scalar::Real;

use crate::anchor::{Anchored, Chart};
use crate::generated::platform::{Drift, Platform, reanchor};
use crate::rotation::angles;
use crate::site::Site;

/// Duration over which the declared drift noise is held, s.
const HELD_S: f64 = 60.0;

/// Most parts that one interval is divided into: years of two-minute steps.
const MOST_PARTS: f64 = 1e6;

/// What a filter starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<T> {
    /// Where the platform stands.
    pub site: Site<T>,
    /// Platform angles against East-North-Up at the first sample, rad.
    pub angles_rad: [T; 3],
    /// Their standard deviations, rad. At theta_y = ±90° the angles leave one rotation open,
    /// which then counts as known: start from another description of the attitude.
    pub angles_sigma_rad: [T; 3],
    /// Expected drift coefficients: deg/h, deg/h/g, deg/h/g².
    pub drift: Drift<T>,
    /// Their standard deviations.
    pub drift_sigma: Drift<T>,
    /// Standard deviation of one accelerometer sample, g.
    pub accel_noise_g: T,
    /// Standard deviation of the drift noise held over one minute, deg/h; the noise is white,
    /// so over Δt it is this times √(60 s / Δt).
    pub drift_noise_deg_per_h: T,
    /// How the angles are integrated over a step.
    pub integration: Integration,
    /// When the chart moves.
    pub recentring: Recentring<T>,
    /// Longest interval that is integrated in one step, s; longer ones are divided.
    pub longest_step_s: T,
}

impl<T: Real> Settings<T> {
    /// A levelled and aligned platform (0.01 deg), coefficients unknown to 1 deg/h (per g, per
    /// g²), 1e-5 g, 0.002 deg/h, RK4 steps of at most two minutes, chart moved at every step.
    #[must_use]
    pub fn level_at(site: Site<T>) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        Self {
            site,
            angles_rad: [zero; 3],
            angles_sigma_rad: [T::from_f64(0.01_f64.to_radians()); 3],
            drift: Drift::from_array([zero; Platform::PARAMETERS]),
            drift_sigma: Drift::from_array([one; Platform::PARAMETERS]),
            accel_noise_g: T::from_f64(1e-5),
            drift_noise_deg_per_h: T::from_f64(0.002),
            integration: Integration::RK4,
            recentring: Recentring::EveryStep,
            longest_step_s: T::from_f64(120.0),
        }
    }

    /// Spectral density of the drift noise, (deg/h)² s: what is declared is held over a minute.
    #[must_use]
    pub fn drift_noise_density(&self) -> T {
        self.drift_noise_deg_per_h * self.drift_noise_deg_per_h * T::from_f64(HELD_S)
    }

    /// The paper's own filter, equations (14) to (23): Euler angles as states in one chart,
    /// one Euler step a sample. It is consistent with data simulated by the same rule only.
    #[must_use]
    pub fn of_the_paper(self) -> Self {
        Self {
            integration: Integration::EULER,
            recentring: Recentring::Never,
            longest_step_s: T::from_f64(f64::INFINITY),
            ..self
        }
    }
}

type PlatformKernel<T, F> =
    Filter<T, Anchored<Platform>, Chart<T>, ArrayStorage<T, 3, 3, { Platform::STATES }>, 3, 3, F>;

/// Streaming filter of the nominal platform: feed it accelerometer samples, read coefficients.
///
/// No call allocates. `F` is the form of the covariance: P itself for double precision, or its
/// factors ([`FactorisedPlatformFilter`]) for single precision and wide priors. In
/// single precision P itself soon stops with an error.
#[derive(Clone, Debug)]
pub struct PlatformFilter<T = f64, F = Covariance> {
    kernel: PlatformKernel<T, F>,
    accel_variance_g2: [T; 3],
    drift_density: [T; 3],
    longest_step_s: T,
}

/// The streaming filter on the factors of the covariance: it cannot lose definiteness, so it is
/// the one for controllers that compute in single precision.
///
/// ```
/// use gyrocal::{FactorisedPlatformFilter, Settings, Site};
///
/// # fn main() -> Result<(), gyrocal::EstimationError> {
/// let settings = Settings::<f32>::level_at(Site::at_latitude_deg(39.1));
/// let mut filter = FactorisedPlatformFilter::factorised(&settings)?;
/// filter.update(&[0.0, 0.0, 1.0])?;
/// # Ok(())
/// # }
/// ```
pub type FactorisedPlatformFilter<T = f32> = PlatformFilter<T, Factors>;

impl<T: Real> PlatformFilter<T, Covariance> {
    /// A filter at the first sample, which [`Self::update`] takes.
    ///
    /// # Errors
    /// As [`Self::with_form`].
    pub fn new(settings: &Settings<T>) -> Result<Self, EstimationError> {
        Self::with_form(settings)
    }
}

impl<T: Real> FactorisedPlatformFilter<T> {
    /// A filter at the first sample, which [`Self::update`] takes.
    ///
    /// # Errors
    /// As [`Self::with_form`].
    pub fn factorised(settings: &Settings<T>) -> Result<Self, EstimationError> {
        Self::with_form(settings)
    }
}

impl<T: Real, F: Form<T>> PlatformFilter<T, F> {
    /// A filter at the first sample, which [`Self::update`] takes, in the form `F`.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`] or [`EstimationError::InvalidArgument`] if a
    /// sigma or noise is not positive.
    pub fn with_form(settings: &Settings<T>) -> Result<Self, EstimationError> {
        Self::in_chart(
            settings,
            Chart::east_north_up(settings.site),
            &settings.angles_rad,
            &settings.angles_sigma_rad,
        )
    }

    /// As [`Self::with_form`] for any initial attitude, angles near θy = ±90° included:
    /// components of North and Up (orthogonal unit vectors) along the platform axes, and the
    /// standard deviations of the attitude's error as a rotation about these axes, rad. The
    /// angles of the settings are not used.
    ///
    /// # Errors
    /// As [`Self::with_form`].
    pub fn at_attitude(
        settings: &Settings<T>,
        north_and_up: &[[T; 3]; 2],
        rotation_sigma_rad: &[T; 3],
    ) -> Result<Self, EstimationError> {
        let mut chart = Chart::east_north_up(settings.site);
        chart.lay(north_and_up);
        Self::in_chart(settings, chart, &[T::from_f64(0.0); 3], rotation_sigma_rad)
    }

    fn in_chart(
        settings: &Settings<T>,
        chart: Chart<T>,
        angles_rad: &[T; 3],
        angles_sigma_rad: &[T; 3],
    ) -> Result<Self, EstimationError> {
        let (zero, noise) = (T::from_f64(0.0), settings.drift_noise_deg_per_h);
        if !(settings.accel_noise_g.is_positive()
            && noise.is_positive()
            && settings.longest_step_s.is_positive())
        {
            return Err(EstimationError::InvalidArgument {
                expected: "positive noise and a positive longest step",
            });
        }
        let join = |moving: &[T; 3], parameters: [T; Platform::PARAMETERS]| {
            let mut all = [zero; Platform::STATES];
            all[..3].copy_from_slice(moving);
            all[3..].copy_from_slice(&parameters);
            all
        };
        let kernel = Filter::with_form(
            Anchored(Platform),
            chart,
            settings.integration,
            settings.recentring,
            ArrayStorage::new(),
            &join(angles_rad, settings.drift.to_array()),
            &join(angles_sigma_rad, settings.drift_sigma.to_array()),
        )?;
        Ok(Self {
            kernel,
            accel_variance_g2: [settings.accel_noise_g * settings.accel_noise_g; 3],
            drift_density: [settings.drift_noise_density(); 3],
            longest_step_s: settings.longest_step_s,
        })
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
    /// than a million longest steps; other variants if the prediction left the numbers.
    #[inline]
    pub fn predict(&mut self, interval_s: T) -> Result<(), EstimationError> {
        let parts = (interval_s / self.longest_step_s).to_f64();
        if parts > 1.0 && interval_s.is_finite() {
            if parts > MOST_PARTS {
                return Err(EstimationError::InvalidArgument {
                    expected: "an interval of at most a million longest steps",
                });
            }
            let whole = parts as u64;
            let count = whole + u64::from(parts > whole as f64);
            let part_s = interval_s / T::from_f64(count as f64);
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
        Drift::from_array(core::array::from_fn(|i| state[3 + i]))
    }

    /// Standard deviations of the errors of [`Self::drift`].
    #[must_use]
    pub fn drift_sigma(&self) -> Drift<T> {
        Drift::from_array(core::array::from_fn(|i| self.kernel.sigma(3 + i)))
    }

    /// Covariance of the errors of [`Self::drift`], in the order of its fields.
    #[must_use]
    pub fn drift_covariance(&self) -> [[T; Platform::PARAMETERS]; Platform::PARAMETERS] {
        core::array::from_fn(|i| core::array::from_fn(|j| self.kernel.covariance(3 + i, 3 + j)))
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

    /// Estimated platform angles against East-North-Up, rad: rotations about x, then y, then z.
    #[must_use]
    pub fn angles_rad(&self) -> [T; 3] {
        angles(&self.platform_c_enu())
    }

    /// The filter underneath, for what this type does not show.
    #[must_use]
    pub fn kernel(&self) -> &PlatformKernel<T, F> {
        &self.kernel
    }
}

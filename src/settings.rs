use gyrocal_estimation::{EstimationError, Integration, Recentring};
use gyrocal_scalar::Real;

use crate::generated::platform::{Drift, Platform};
use crate::site::Site;

/// Duration over which the declared drift noise is held, s.
const HELD_S: f64 = 60.0;

/// Discretisation of the platform model: how its angles are integrated from sample to sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discretisation<T> {
    /// Integration rule of the angles over a step.
    pub integration: Integration,
    /// When the chart moves to the estimated attitude.
    pub recentring: Recentring<T>,
    /// Longest interval that is integrated in one step, s; longer ones are divided.
    pub longest_step_s: T,
}

impl<T: Real> Default for Discretisation<T> {
    /// RK4 steps of at most two minutes, the chart moved at every step.
    fn default() -> Self {
        Self {
            integration: Integration::RK4,
            recentring: Recentring::EveryStep,
            longest_step_s: T::from_f64(120.0),
        }
    }
}

impl<T: Real> Discretisation<T> {
    /// The discretisation of the paper's filter, equations (14) to (23): Euler angles as states in
    /// one chart, one Euler step a sample. It is consistent only with data simulated by the same
    /// rule.
    #[must_use]
    pub fn paper_baseline() -> Self {
        Self {
            integration: Integration::EULER,
            recentring: Recentring::Never,
            longest_step_s: T::from_f64(f64::INFINITY),
        }
    }
}

/// Settings of a filter: site, prior of the coefficients, noise and discretisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSettings<T> {
    /// Site of the platform.
    pub site: Site<T>,
    /// Prior means of the drift coefficients: deg/h, deg/h/g, deg/h/g².
    pub drift: Drift<T>,
    /// Their standard deviations.
    pub drift_sigma: Drift<T>,
    /// Standard deviation of one accelerometer sample, g.
    pub accel_noise_g: T,
    /// Standard deviation of the drift noise held over one minute, deg/h; the noise is white,
    /// so over Δt it is this times √(60 s / Δt).
    pub drift_noise_deg_per_h: T,
    /// Discretisation of the model.
    pub discretisation: Discretisation<T>,
}

impl<T: Real> FilterSettings<T> {
    /// Settings at a site: coefficients of zero known to 1 deg/h (per g, per g²), noise of 1e-5 g
    /// and 0.002 deg/h, the default discretisation.
    #[must_use]
    pub fn at_site(site: Site<T>) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        Self {
            site,
            drift: Drift::from_array([zero; Platform::PARAMETERS]),
            drift_sigma: Drift::from_array([one; Platform::PARAMETERS]),
            accel_noise_g: T::from_f64(1e-5),
            drift_noise_deg_per_h: T::from_f64(0.002),
            discretisation: Discretisation::default(),
        }
    }

    /// Checks that every number has a meaning.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] with the domain of the first one that has none.
    pub fn check(&self) -> Result<(), EstimationError> {
        let Site {
            latitude_rad,
            earth_rate_rad_per_s,
            gravity_g,
        } = self.site;
        // In single precision a quarter of a turn is rounded up.
        let quarter = T::from_f64(core::f64::consts::FRAC_PI_2 * (1.0 + 1e-6));
        let domains = [
            (latitude_rad.abs() <= quarter, "a latitude within ±90°"),
            (
                earth_rate_rad_per_s.is_finite(),
                "a rate of the Earth that is finite",
            ),
            (
                is_variance(gravity_g),
                "a gravity that is positive and finite",
            ),
            (
                self.drift
                    .to_array()
                    .iter()
                    .all(|number| number.is_finite()),
                "coefficients that are finite",
            ),
            (
                self.drift_sigma.to_array().into_iter().all(is_sigma),
                "sigmas of the coefficients that are positive and finite, as are their squares",
            ),
            (
                is_sigma(self.accel_noise_g) && is_sigma(self.drift_noise_deg_per_h),
                "noise that is positive and finite, as is its square",
            ),
            (
                self.discretisation.longest_step_s.is_positive(),
                "a longest step that is positive",
            ),
        ];
        for (holds, expected) in domains {
            if !holds {
                return Err(EstimationError::InvalidArgument { expected });
            }
        }
        Ok(())
    }

    /// Spectral density of the drift noise, (deg/h)² s: the square of the declared sigma times the
    /// minute over which it is held.
    #[must_use]
    pub fn drift_noise_density(&self) -> T {
        self.drift_noise_deg_per_h * self.drift_noise_deg_per_h * T::from_f64(HELD_S)
    }
}

/// Positive and finite. Out of line, as many numbers are checked.
#[inline(never)]
fn is_variance<T: Real>(number: T) -> bool {
    number.is_positive() && number.is_finite()
}

/// A standard deviation whose variance is neither zero nor infinite in these numbers.
#[inline(never)]
pub(crate) fn is_sigma<T: Real>(number: T) -> bool {
    number.is_positive() && is_variance(number * number)
}

//! Result of a calibration.

use gyrocal::Drift;
use gyrocal::generated::platform::DRIFT;
use gyrocal_record::NoiseEstimate;

use crate::coefficients::PARAMETERS;
use crate::fit::FitStatistics;
use crate::layout::SiteQuantity;
use crate::observability::{DETERMINED, UnobservableCombination};

/// Drift coefficients estimated from records, with their covariance.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Estimated coefficients: deg/h, deg/h/g, deg/h/g². Where turn-ons differ, the constant drifts
    /// are their means over turn-ons.
    pub drift: Drift<f64>,
    /// Covariance of their errors, in the order of the fields; it includes the declared uncertainty
    /// of the site.
    pub covariance: [[f64; PARAMETERS]; PARAMETERS],
    /// Standard deviations of the prior.
    pub prior_sigma: Drift<f64>,
    /// Statistics of the innovations, for the consistency test.
    pub fit: FitStatistics,
    /// Platform components from East, North, Up components at the last row of the last record.
    pub platform_c_enu: [[f64; 3]; 3],
    /// The same as platform angles, rad.
    pub final_angles_rad: [f64; 3],
    /// Gauss-Newton steps of the batch estimator; 1 for the streaming filter.
    pub iterations: usize,
    /// Results of each record; empty for the streaming filter.
    pub runs: Vec<RunResult>,
    /// Sensitivities of the coefficients to the considered parameters of the first record's site;
    /// empty for the streaming filter.
    pub site_sensitivities: Vec<ConsiderSensitivity>,
    /// Combinations of coefficients that the records do not determine; empty for the streaming
    /// filter.
    pub unobservable: Vec<UnobservableCombination>,
}

/// Results of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult {
    /// Platform components from East, North, Up components at the first row.
    pub first_platform_c_enu: [[f64; 3]; 3],
    /// The same at the last row.
    pub last_platform_c_enu: [[f64; 3]; 3],
    /// Offset of this turn-on from the mean constant drift of gyros x, y, z, and its sigma, deg/h.
    pub turn_on_deg_per_h: Option<[[f64; 2]; 3]>,
    /// Search for the azimuth, if the bench did not declare the attitude.
    pub azimuth: Option<AzimuthSearch>,
    /// Maximum-likelihood estimate of the noise, if requested.
    pub noise: Option<NoiseEstimate>,
    /// Number of values with a Huber weight below 1, if outliers are bounded.
    pub bounded_values: usize,
}

/// Search for an unknown azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AzimuthSearch {
    /// Number of azimuths tried.
    pub starts: usize,
    /// Log-likelihood of the best solution less that of the best one with another azimuth;
    /// infinite if all azimuths led to one solution.
    pub margin: f64,
    /// Azimuth of that other solution relative to the best, rad.
    pub other_rad: f64,
}

impl AzimuthSearch {
    /// The two azimuths are not distinguishable: their likelihood ratio is below 20.
    #[must_use]
    pub fn is_ambiguous(&self) -> bool {
        self.margin < 3.0
    }
}

/// Sensitivity of the estimates to a considered parameter of the site: a parameter that keeps its
/// assumed value and whose uncertainty enters the covariance (Schmidt).
#[derive(Clone, Debug, PartialEq)]
pub struct ConsiderSensitivity {
    /// The considered parameter.
    pub quantity: SiteQuantity,
    /// Standard deviation that the bench declares; `None` if the parameter counts as exact.
    pub declared_sigma: Option<f64>,
    /// Standard deviation of the parameter if it were estimated from the records without a prior;
    /// infinite if it is unobservable.
    pub from_record_sigma: f64,
    /// Bias of each coefficient when the true value exceeds the assumed one by a unit.
    pub bias_per_unit: [f64; PARAMETERS],
}

impl ConsiderSensitivity {
    /// Error for which biases are reported: the declared sigma, or [`SiteQuantity::reference_error`].
    #[must_use]
    pub fn assumed_error(&self) -> f64 {
        self.declared_sigma
            .unwrap_or_else(|| self.quantity.reference_error())
    }
}

/// One estimated coefficient with its name and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientEstimate {
    /// Public name, such as `gyro_x.bias`.
    pub id: &'static str,
    /// Unit of estimate and sigma.
    pub unit: &'static str,
    /// Meaning in a phrase.
    pub meaning: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation of its error.
    pub sigma: f64,
    /// True if the records determined the coefficient: its sigma is below a tenth of the prior's, and
    /// the innovations are not far larger than any effect makes them.
    pub determined: bool,
}

impl Calibration {
    /// Sensitivity of the coefficients to a quantity of the site.
    #[must_use]
    pub fn site_sensitivity(&self, quantity: SiteQuantity) -> Option<&ConsiderSensitivity> {
        let mut sensitivities = self.site_sensitivities.iter();
        sensitivities.find(|sensitivity| sensitivity.quantity == quantity)
    }

    /// True if the turn-ons of the runs differ, so that each has its own constant drifts.
    #[must_use]
    pub fn has_turn_ons(&self) -> bool {
        let mut runs = self.runs.iter();
        runs.any(|run| run.turn_on_deg_per_h.is_some())
    }

    /// The coefficients with names, in the order of [`Self::covariance`].
    #[must_use]
    pub fn coefficients(&self) -> [CoefficientEstimate; PARAMETERS] {
        let (estimates, priors) = (self.drift.to_array(), self.prior_sigma.to_array());
        core::array::from_fn(|i| {
            let sigma = self.covariance[i][i].sqrt();
            CoefficientEstimate {
                id: DRIFT[i].id,
                unit: DRIFT[i].unit,
                meaning: DRIFT[i].doc,
                estimate: estimates[i],
                sigma,
                determined: sigma < DETERMINED * priors[i] && !self.fit.is_gross(),
            }
        })
    }
}

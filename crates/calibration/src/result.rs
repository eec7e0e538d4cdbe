//! What a calibration found.

use gyrocal::Drift;
use gyrocal::generated::platform::DRIFT;

use crate::PARAMETERS;
use crate::fit::FitStatistics;
use crate::layout::SiteQuantity;
use crate::noise::NoiseEstimate;
use crate::observability::{DETERMINED, Undetermined};

/// What records said of the gyros.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Estimated coefficients: deg/h, deg/h/g, deg/h/g². Where turn-ons differ, constant drifts
    /// are those of the mean over turn-ons.
    pub drift: Drift<f64>,
    /// Covariance of their errors, in the order of the fields; the declared uncertainty of the
    /// site is in it.
    pub covariance: [[f64; PARAMETERS]; PARAMETERS],
    /// Standard deviations before the records.
    pub prior_sigma: Drift<f64>,
    /// Agreement of the records with the model.
    pub fit: FitStatistics,
    /// Platform components from East, North, Up components at the last row of the last record.
    pub platform_c_enu: [[f64; 3]; 3],
    /// The same as platform angles, rad.
    pub final_angles_rad: [f64; 3],
    /// Steps of the batch estimator; 1 of the streaming filter.
    pub iterations: usize,
    /// What belongs to each record; empty after the streaming filter.
    pub runs: Vec<RunResult>,
    /// What errors of the first record's site do; empty after the streaming filter.
    pub site: Vec<SiteInfluence>,
    /// Combinations of coefficients that the records do not determine; empty after the streaming
    /// filter.
    pub undetermined: Vec<Undetermined>,
}

/// What belongs to one record.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult {
    /// Platform components from East, North, Up components at the first row.
    pub first_platform_c_enu: [[f64; 3]; 3],
    /// The same at the last row.
    pub last_platform_c_enu: [[f64; 3]; 3],
    /// What this turn-on adds to the constant drifts of gyros x, y, z, and its sigma, deg/h.
    pub turn_on_deg_per_h: Option<[[f64; 2]; 3]>,
    /// How the azimuth was found, if the bench did not give it.
    pub azimuth: Option<AzimuthSearch>,
    /// Noise by maximum likelihood, if it was asked for.
    pub noise: Option<NoiseEstimate>,
    /// Values whose influence was bounded, if outliers were to be bounded.
    pub bounded_values: usize,
}

/// How an unknown azimuth was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AzimuthSearch {
    /// Starts that were tried.
    pub starts: usize,
    /// How much less likely the best solution with another azimuth is, as a difference of
    /// log-likelihoods; infinite if all starts led to one solution.
    pub margin: f64,
    /// That other azimuth relative to the one that was chosen, rad.
    pub other_rad: f64,
}

impl AzimuthSearch {
    /// Whether the record cannot tell the two azimuths apart: a likelihood ratio below 20.
    #[must_use]
    pub fn is_ambiguous(&self) -> bool {
        self.margin < 3.0
    }
}

/// What an error of something known of the site does.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteInfluence {
    /// What is in error.
    pub quantity: SiteQuantity,
    /// The standard deviation that the bench declares.
    pub declared_sigma: Option<f64>,
    /// The standard deviation that the record alone gives it; infinite if it says nothing.
    pub from_record_sigma: f64,
    /// Bias of each coefficient when the true quantity exceeds the assumed one by a unit.
    pub bias_per_unit: [f64; PARAMETERS],
}

impl SiteInfluence {
    /// The error that its effect is told for: the declared sigma, or a small one.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.declared_sigma
            .unwrap_or_else(|| self.quantity.small_error())
    }
}

/// One estimated coefficient with its name and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientEstimate {
    /// Public name, such as `gyro_x.bias`.
    pub id: &'static str,
    /// Unit of estimate and sigma.
    pub unit: &'static str,
    /// Meaning in a few words.
    pub meaning: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation of its error.
    pub sigma: f64,
    /// Whether the record, and not the prior, determined it.
    pub determined: bool,
}

impl Calibration {
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
                determined: sigma < DETERMINED * priors[i],
            }
        })
    }
}

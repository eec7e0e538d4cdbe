//! Result of a multi-position test, as it is serialised.

use gyrocal_statistics::root_mean_square;
use serde::Serialize;

use super::alternatives::Alternative;
use super::between_stops::NoiseBetweenStops;
use super::cross_validation::CrossValidation;
use super::log_biases::LogBiases;
use super::search::LEAST_FREEDOM;
use super::terms::Term;

/// Result of a multi-position test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MultiPositionReport {
    /// Number of stops.
    pub stops: usize,
    /// The laws of each gyro.
    pub gyros: Vec<GyroReport>,
    /// Degrees of freedom of all gyros that tell the noise between stops beside a term of each. Of less than six no term
    /// is tested.
    pub freedom_of_noise: usize,
    /// Logs after the first that have a bias of their own in each law, which then has the bias in the first log. Zero where
    /// logs have too few stops for that: the scatter of the stops has the change of the bias too.
    pub biases_of_further_logs: usize,
    /// Gyros whose bias differs between the logs of the test. Empty of one log.
    pub log_biases: Vec<LogBiases>,
    /// Terms that the nominal laws lack, in the order of the search.
    pub findings: Vec<Finding>,
    /// Significant terms that do not enter the laws, since held-out stops are predicted worse with them.
    pub not_confirmed: Vec<String>,
    /// Cross-validation of the extended laws; `None` without findings, or with too few stops: less than fourteen, or too
    /// few beside those held out.
    #[serde(rename = "gain")]
    pub cross_validation: Option<CrossValidation>,
}

impl MultiPositionReport {
    /// Whether the stops tell the noise between them, so that a term is tested.
    #[must_use]
    pub fn tells_noise(&self) -> bool {
        self.freedom_of_noise >= LEAST_FREEDOM
    }

    /// Root mean square of the residuals of all gyros at all stops for the nominal and for the extended
    /// laws, deg/h.
    #[must_use]
    pub fn residual_rms_deg_per_h(&self) -> [f64; 2] {
        let rms = |law: fn(&GyroReport) -> &LawReport| {
            let gyros = self.gyros.iter();
            root_mean_square(gyros.map(|gyro| root_mean_square(&law(gyro).residuals_deg_per_h)))
        };
        [rms(|gyro| &gyro.nominal), rms(|gyro| &gyro.extended)]
    }
}

/// Nominal and extended law of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GyroReport {
    /// Name of the gyro.
    pub gyro: String,
    /// Those terms of the nominal law that the positions determine.
    pub nominal: LawReport,
    /// The law with the terms that the search added.
    pub extended: LawReport,
    /// Terms of the catalogue that the positions do not determine in addition to the extended law.
    pub undetermined: Vec<String>,
}

/// One law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LawReport {
    /// Its coefficients. Their standard deviations are those of the noise within and between stops: intervals of 1.96 of
    /// them hold 95 %. Where no degrees of freedom are left they are those without scatter of the stops.
    pub coefficients: Vec<CoefficientReport>,
    /// Covariance of the coefficients in their order.
    pub covariance: Vec<Vec<f64>>,
    /// Sum of squares of the residuals over the standard errors of the stops, at the coefficients that make it least.
    pub chi_square: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of a larger `chi_square` without noise between stops; `None` without degrees of freedom.
    pub p_value: Option<f64>,
    /// Noise between stops, over which the coefficients are integrated.
    pub noise: NoiseBetweenStops,
    /// Residual of each stop \[deg/h\].
    pub residuals_deg_per_h: Vec<f64>,
}

/// One coefficient of a law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientReport {
    /// Its name.
    pub name: String,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation, noise between stops included.
    pub sigma: f64,
    /// Unit of `estimate` and `sigma`.
    pub unit: String,
}

/// A term that the nominal law lacks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Finding {
    /// Index of the gyro.
    #[serde(skip)]
    pub gyro: usize,
    /// The term.
    #[serde(skip)]
    pub term: Term,
    /// Name of the term.
    pub effect: String,
    /// Its coefficient in the extended law.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// Unit of `estimate` and `sigma`.
    pub unit: String,
    /// Factor of the coefficient at each stop.
    pub regressor: Vec<f64>,
    /// Probability of as large a term in any of the tests of a law without it.
    pub p_value: f64,
    /// Alternatives: terms that explain the stops as well in its place, the nearest first.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Alternative>,
    /// The nearest term that does not.
    pub nearest_ruled_out: Option<Alternative>,
    /// Exact equivalents.
    pub equivalents: Vec<String>,
    /// For a cross-axis term: misalignment of the accelerometers with which the along-axis term would
    /// mimic it \[rad\].
    pub misalignment_needed_rad: Option<f64>,
}

impl Finding {
    /// Names of the term and of its alternatives.
    pub fn with_alternatives(&self) -> impl Iterator<Item = &str> {
        let others = self.alternatives.iter().map(|other| &*other.effect);
        core::iter::once(&*self.effect).chain(others)
    }
}

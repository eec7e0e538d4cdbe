//! Result of a multi-position test, as it is serialised.

use gyrocal_statistics::root_mean_square;
use serde::Serialize;

use super::alternatives::Alternative;
use super::cross_validation::CrossValidation;
use super::log_biases::LogBiases;
use super::negative_controls::NegativeControls;
use super::terms::Term;

/// Result of a multi-position test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MultiPositionReport {
    /// Number of stops.
    pub stops: usize,
    /// The laws of each gyro.
    pub gyros: Vec<GyroReport>,
    /// Gyros whose bias differs between the logs of the test: these differences are taken off before the
    /// search. Empty of one log.
    pub log_biases: Vec<LogBiases>,
    /// Terms that the nominal laws lack, in the order of the search.
    pub findings: Vec<Finding>,
    /// Significant terms that do not enter the laws, since they predict held-out stops no better than the
    /// nominal laws.
    pub not_confirmed: Vec<String>,
    /// Cross-validation of the extended laws; `None` without findings, or with too few stops.
    #[serde(rename = "gain")]
    pub cross_validation: Option<CrossValidation>,
    /// Searches in data without effects.
    pub controls: NegativeControls,
}

impl MultiPositionReport {
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
    /// The nominal law.
    pub nominal: LawReport,
    /// The law with the terms that the search added.
    pub extended: LawReport,
    /// F test of the nominal law against one with all determined terms of the catalogue.
    pub nominal_against_catalogue: FTest,
    /// The same of the extended law.
    pub extended_against_catalogue: FTest,
    /// Terms of the catalogue that the attitudes of the stops do not determine in addition to the others.
    pub undetermined: Vec<String>,
}

/// Fit of one law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LawReport {
    /// Its coefficients.
    pub coefficients: Vec<CoefficientReport>,
    /// Sum of squares of the residuals over their standard errors.
    pub chi_square: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: f64,
    /// p-value of `chi_square`: the probability of a larger one if law and standard errors are right.
    pub p_value: f64,
    /// Excess scatter: standard deviation of the residuals beyond the standard errors.
    pub excess_deg_per_h: f64,
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
    /// Standard deviation, excess scatter included.
    pub sigma: f64,
    /// Unit of `estimate` and `sigma`.
    pub unit: String,
}

/// F test of a law against a larger one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FTest {
    /// The F statistic.
    pub f: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: [f64; 2],
    /// p-value: the probability of a larger statistic if the smaller law is right.
    pub p_value: f64,
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
    /// F statistic of the search step that added it.
    pub f: f64,
    /// Family-wise p-value of `f` over the whole search.
    pub p_value: f64,
    /// Alternatives: terms that cannot be rejected in its place at the coverage of the settings.
    #[serde(rename = "rivals")]
    pub alternatives: Vec<Alternative>,
    /// The nearest term that is rejected.
    pub nearest_ruled_out: Option<Alternative>,
    /// Largest log-likelihood deficit of an alternative.
    pub deficit_limit: f64,
    /// Exact equivalents.
    pub equivalents: Vec<String>,
    /// For a cross-axis term: misalignment of the accelerometers with which the along-axis term would
    /// mimic it \[rad\].
    pub misalignment_needed_rad: Option<f64>,
}

//! The coefficients of the nominal and of the extended model: of drifts, or parameters of a plant.

use serde::{Deserialize, Serialize};

/// The coefficients with and without the accepted effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficients {
    /// Declared values, in the order of the nominal ones; none of a platform, whose bench file has a prior.
    pub declared: Vec<f64>,
    /// Estimates of the nominal model.
    pub nominal: Vec<CoefficientEstimate>,
    /// Estimates of the extended model, in the same order; `None` if no effect was accepted.
    pub extended: Option<Vec<CoefficientEstimate>>,
    /// The same over all members of the confidence sets, each with the weight of its penalised
    /// likelihood; `None` if no effect was accepted.
    pub over_set: Option<Vec<CoefficientInterval>>,
    /// The members of the confidence sets, the likeliest first; empty if there is only one.
    pub members: Vec<SetMember>,
    /// Covariance of the extended estimates, row by row, in products of their units; of the nominal
    /// ones if no effect was accepted; empty of a diagnosis of a plant.
    pub covariance: Vec<Vec<f64>>,
}

impl Coefficients {
    /// Estimates of the extended model, or of the nominal one if no effect was accepted.
    #[must_use]
    pub fn best(&self) -> &[CoefficientEstimate] {
        self.extended.as_ref().unwrap_or(&self.nominal)
    }
}

/// One drift coefficient over all members of the confidence sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientInterval {
    /// Its id.
    pub name: String,
    /// Mean of the mixture of the members' distributions, in `unit`.
    pub estimate: f64,
    /// Standard deviation of the mixture, in `unit`.
    pub sigma: f64,
    /// Its 2.5 % and 97.5 % quantiles, in `unit`: of a mixture of Student's distributions.
    pub interval: [f64; 2],
    /// Degrees of freedom of the noise that the sigma rests on; `None` where it was not estimated.
    pub degrees_of_freedom: Option<f64>,
    /// The unit.
    pub unit: String,
}

/// A model with one member of each confidence set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetMember {
    /// Its effects; random walks that are one model are joined by `+`.
    pub effects: Vec<String>,
    /// Its share of the likelihood of all members, penalised for their searches.
    pub weight: f64,
    /// The coefficients estimated with it, in the order of the nominal ones.
    pub coefficients: Vec<CoefficientEstimate>,
    /// Their covariance, row by row, in products of their units.
    pub covariance: Vec<Vec<f64>>,
}

/// One estimated drift coefficient.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientEstimate {
    /// Its id: `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, ….
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation, in `unit`.
    pub sigma: f64,
    /// The unit.
    pub unit: String,
}

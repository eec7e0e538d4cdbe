//! The drift coefficients of the nominal and of the extended model.

use serde::{Deserialize, Serialize};

/// The drift coefficients with and without the accepted effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficients {
    /// Estimates of the nominal model.
    pub nominal: Vec<CoefficientEstimate>,
    /// Estimates of the extended model, in the same order; `None` if no effect was accepted.
    pub extended: Option<Vec<CoefficientEstimate>>,
    /// Covariance of the extended estimates, row by row, in products of their units; of the nominal
    /// ones if no effect was accepted.
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

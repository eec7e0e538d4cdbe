//! Magnitude test of specific force.

use serde::{Deserialize, Serialize};

/// Test of the magnitude of specific force against gravity: its mean, and its dependence on each
/// component, time and temperature. No gyro and no attitude enters it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MagnitudeTest {
    /// Whether accelerometers, or gravity, are other than declared.
    pub accelerometers: bool,
    /// Upper bound of the probability of as large a deviation by chance: the tests that it is the
    /// least of share samples, and are counted as if they did not.
    pub p_value: f64,
    /// Mean magnitude less gravity \[g\].
    pub mean_g: f64,
    /// Its standard deviation \[g\].
    pub mean_sigma_g: f64,
    /// The most significant deviation in words; empty if there is none.
    pub description: String,
}

//! What a diagnosis tells beside its findings: the norm channel, and how noise averages out.

use serde::{Deserialize, Serialize};

/// What the norm of specific force says, which neither a gyro nor the attitude enters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NormReport {
    /// Whether accelerometers, or gravity, are other than declared.
    pub accelerometers: bool,
    /// Probability of a norm as far from gravity by chance.
    pub p_value: f64,
    /// Mean of the norm less gravity \[g\].
    pub mean_g: f64,
    /// Its standard deviation \[g\].
    pub mean_sigma_g: f64,
    /// What stands out; empty if nothing does.
    pub description: String,
}

/// Allan deviation of the innovations with all causes in the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AllanReport {
    /// What the noise does when it is averaged.
    pub course: AllanCourse,
    /// Probability that white noise of the believed size exceeds its expectation as much.
    pub p_value: f64,
    /// Rows of the longest stretch without a gap, over which it is taken.
    pub rows: usize,
    /// Each averaging time.
    pub points: Vec<AllanPointReport>,
}

/// What noise does when it is averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AllanCourse {
    /// It falls as white noise of the believed size does.
    White,
    /// It falls so, but is larger.
    LargerWhite,
    /// It stops falling.
    Flicker,
    /// It rises.
    Slow,
}

/// The Allan deviations of one averaging time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AllanPointReport {
    /// The averaging time.
    pub tau_s: f64,
    /// Of white noise of the believed size.
    pub white: f64,
    /// For x, y, z, in standard deviations of an innovation.
    pub deviation: [f64; 3],
    /// Their 95 % intervals.
    pub interval: [[f64; 2]; 3],
}

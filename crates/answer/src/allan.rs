//! Allan deviation of the innovations with all causes in the model.

use serde::{Deserialize, Serialize};

/// Allan test of the innovations with all causes in the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllanTest {
    /// Course of the deviation over averaging time.
    pub course: AllanCourse,
    /// Upper bound of the probability that white noise of the estimated level exceeds its
    /// expectation as much: averaging times that share samples are counted as if they did not.
    pub p_value: f64,
    /// Rows of the longest stretch without a gap, over which it is taken.
    pub rows: usize,
    /// Each averaging time.
    pub points: Vec<AllanPoint>,
}

/// Course of an Allan deviation over averaging time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AllanCourse {
    /// It falls as white noise of the estimated level does.
    White,
    /// It falls as white noise does, at a higher level.
    LargerWhite,
    /// It stops falling: flicker.
    Flicker,
    /// It rises: a random walk, or another slow process.
    Slow,
}

/// The Allan deviations of one averaging time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllanPoint {
    /// The averaging time \[s\].
    pub tau_s: f64,
    /// Deviation of white noise of the estimated level.
    pub white: f64,
    /// Deviation of x, y, z, in standard deviations of an innovation.
    pub deviation: [f64; 3],
    /// Their 95 % intervals.
    pub interval: [[f64; 2]; 3],
}

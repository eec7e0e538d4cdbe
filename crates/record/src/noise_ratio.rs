//! Noise relative to the declared one.

use serde::{Deserialize, Serialize};

/// Largest upper end of the interval of an observable noise over its estimate.
const OBSERVABLE_FACTOR: f64 = 100.0;

/// An estimated standard deviation over the declared one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseRatio {
    /// The estimate.
    pub ratio: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// Noise by maximum likelihood over the declared one, of instruments x, y, z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseEstimate {
    /// Of the accelerometers.
    pub accel: [NoiseRatio; 3],
    /// Of the gyros.
    pub gyro: [NoiseRatio; 3],
}

/// Difference of a noise from the declared one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseDifference {
    /// The 95 % interval of the ratio lies above 1.
    Larger,
    /// The 95 % interval of the ratio lies below 1.
    Smaller,
}

impl NoiseRatio {
    /// True if the record determines the noise: its interval ends within a factor of 100.
    #[must_use]
    pub fn is_observable(&self) -> bool {
        self.interval[1] <= OBSERVABLE_FACTOR * self.ratio
    }

    /// Significant difference from the declared noise, if the 95 % interval excludes 1.
    #[must_use]
    pub fn difference(&self) -> Option<NoiseDifference> {
        match self.interval {
            [low, _] if low > 1.0 => Some(NoiseDifference::Larger),
            [_, high] if high < 1.0 => Some(NoiseDifference::Smaller),
            _ => None,
        }
    }
}

//! Noise over the declared, in words and for programs.

use gyrocal_calibration::{NoiseEstimate, NoiseRatio};
use gyrocal_record::{NoiseRatioReport, NoiseReport};

/// An interval that spans more than this factor says that the record does not tell the noise.
const TELLS_NOTHING: f64 = 100.0;

/// The estimate for programs.
pub(crate) fn report(estimate: &NoiseEstimate) -> NoiseReport {
    let ratio = |found: NoiseRatio| NoiseRatioReport {
        ratio: found.ratio,
        interval: found.interval,
    };
    NoiseReport {
        accel: estimate.accel.map(ratio),
        gyro: estimate.gyro.map(ratio),
    }
}

/// A ratio with its interval; `None` if the record does not tell it.
pub(crate) fn told(ratio: f64, [low, high]: [f64; 2]) -> Option<String> {
    (high <= TELLS_NOTHING * low).then(|| format!("{ratio:.3} ({low:.3} to {high:.3})"))
}

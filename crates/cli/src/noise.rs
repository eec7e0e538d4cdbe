//! Noise over the declared, in words and for programs.

use gyrocal_calibration::{NoiseEstimate, NoiseRatio};
use gyrocal_record::{Bench, NoiseRatioReport, NoiseReport};

/// An interval that spans more than this factor says that the record does not tell the noise.
const TELLS_NOTHING: f64 = 100.0;

/// White noise of a gyro, as held over one minute, below which the numbers of a bench file are out
/// of proportion: in a day a platform wanders with it by 1e-9 rad, a ten-thousandth of what a good
/// accelerometer, of 1e-5 g, tells in one sample.
const LEAST_GYRO_DEG_PER_H: f64 = 1e-7;

/// What to do if a search for the best fit ends nowhere because of such a noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

/// Whether a bench file says so little of the gyros' noise.
pub(crate) fn has_tiny_gyro_noise(bench: &Bench) -> bool {
    bench.gyro_noise_deg_per_h < LEAST_GYRO_DEG_PER_H
}

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

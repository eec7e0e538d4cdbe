//! Ratio of the estimated to the declared noise, as text and for JSON.

use gyrocal_calibration::{NoiseEstimate, NoiseRatio};
use gyrocal_record::{Bench, NoiseRatioReport, NoiseReport};

/// Ratio of the ends of an interval beyond which the noise is not observable.
const TELLS_NOTHING: f64 = 100.0;

/// White noise of a gyro, held over one minute, below which a bench file is implausible: it moves a
/// platform by 1e-9 rad in a day, a ten-thousandth of the resolution of one sample of a good
/// accelerometer (1e-5 g).
const LEAST_GYRO_DEG_PER_H: f64 = 1e-7;

/// Advice if a fit does not converge because of such a noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

/// Whether a bench file declares so small a gyro noise.
pub(crate) fn has_tiny_gyro_noise(bench: &Bench) -> bool {
    bench.gyro_noise_deg_per_h < LEAST_GYRO_DEG_PER_H
}

/// The estimate for JSON.
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

/// A ratio with its interval; `None` if it is not observable.
pub(crate) fn told(ratio: f64, [low, high]: [f64; 2]) -> Option<String> {
    (high <= TELLS_NOTHING * low).then(|| format!("{ratio:.3} ({low:.3} to {high:.3})"))
}

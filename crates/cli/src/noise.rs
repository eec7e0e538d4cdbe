//! Ratio of the estimated to the declared noise, as text and for JSON.

use gyrocal_calibration::{NoiseEstimate, NoiseRatio};
use gyrocal_record::{NoiseRatioReport, NoiseReport};

/// Advice if a fit does not converge because of such a noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

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
pub(crate) fn ratio_text(found: &NoiseRatio) -> Option<String> {
    let (ratio, [low, high]) = (found.ratio, found.interval);
    found
        .is_observable()
        .then(|| format!("{ratio:.3} ({low:.3} to {high:.3})"))
}

//! Ratio of the estimated to the declared noise, as text.

use gyrocal_calibration::NoiseRatio;

/// Advice if a fit does not converge because of such a noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

/// A ratio with its interval; `None` if it is not observable.
pub(crate) fn ratio_text(found: &NoiseRatio) -> Option<String> {
    let (ratio, [low, high]) = (found.ratio, found.interval);
    found
        .is_observable()
        .then(|| format!("{ratio:.3} ({low:.3} to {high:.3})"))
}

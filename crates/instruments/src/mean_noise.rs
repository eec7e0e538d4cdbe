//! Variance of the mean of a noise whose parts are known.

use gyrocal_statistics::allan::{NoiseFit, NoisePart};

/// Variance of the mean about the mean of the slow parts, which are part of the bias of the record.
pub(crate) fn mean_variance(fit: &NoiseFit, duration_s: f64) -> Option<f64> {
    let white = fit.coefficient(NoisePart::RandomWalk)?;
    let size = match (white.estimate?, white.interval?) {
        (estimate, [low, _]) if low > 0.0 => estimate,
        // Not visible: half of the most that it may be.
        (_, [_, high]) => 0.5 * high,
    };
    let quantisation = fit
        .coefficient(NoisePart::Quantisation)?
        .estimate
        .unwrap_or(0.0);
    // The angle at both ends is quantised.
    Some(size * size / duration_s + 2.0 * (quantisation / duration_s).powi(2))
}

//! Vertical rate of a unit at rest by projection of its gyros on specific force.
//!
//! The motion of gravity in the analytic platform tells the vertical rate by the curvature of its path
//! alone. The mean rate along mean specific force tells it directly, with the noise of the gyros over the
//! whole record, if the unit does not rock: rocking is a rate that noise does not describe.

use gyrocal_statistics::allan::{NoiseFit, NoisePart, fit_noise};
use nalgebra::Vector3;

use crate::earth_rate::deg_per_h;
use crate::log::Log;

/// Mean rate along mean specific force, and its standard deviation \[deg/h\]; `None` if the rate is no
/// stationary noise about a mean. `level_sigma_rad` is the standard deviation of the level and
/// `horizontal_deg_per_h` the horizontal part of Earth rate, which an error of the level adds.
pub(super) fn projected(
    log: &Log,
    level_sigma_rad: f64,
    horizontal_deg_per_h: f64,
) -> Option<[f64; 2]> {
    let force = log.force().ok()?;
    let sum: Vector3<f64> = force.iter().map(|force| Vector3::from(*force)).sum();
    let up = sum.normalize();
    let rates: Vec<f64> = log
        .gyro
        .iter()
        .map(|rate| deg_per_h(up.dot(&Vector3::from(*rate))))
        .collect();
    let fit = fit_noise(&rates, log.interval_s).ok()?;
    // A unit that rocks.
    if !fit.tones.is_empty() {
        return None;
    }
    let duration_s = log.interval_s * rates.len() as f64;
    let variance = mean_variance(&fit, duration_s)?;
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    Some([
        mean,
        variance
            .sqrt()
            .hypot(level_sigma_rad * horizontal_deg_per_h),
    ])
}

/// Variance of the mean about the mean of the slow parts, which are part of the bias of the record.
fn mean_variance(fit: &NoiseFit, duration_s: f64) -> Option<f64> {
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

/// Mean of two estimates weighted by what each knows.
pub(super) fn combined([one, one_sigma]: [f64; 2], other: Option<[f64; 2]>) -> [f64; 2] {
    let Some([other, other_sigma]) = other else {
        return [one, one_sigma];
    };
    let [a, b] = [one_sigma.powi(-2), other_sigma.powi(-2)];
    [(a * one + b * other) / (a + b), (a + b).powf(-0.5)]
}

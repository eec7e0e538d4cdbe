//! Variance of the mean of a log by the fast parts of its noise.

use gyrocal_statistics::allan::{allan_deviation, octaves};
use nalgebra::{Matrix2, Vector2};

/// Means of a block whose scatter determines the fast parts.
const PARTS_OF_BLOCK: usize = 64;

/// Squares of bias instability and rate random walk, which are known from the blocks.
#[derive(Clone, Copy)]
pub(super) struct Slow {
    pub(super) bias_instability: f64,
    pub(super) rate_random_walk: f64,
}

/// Variance of the mean over all `rates` that angle random walk and quantisation make.
///
/// Allan variances at averaging times from a 64th of a block to a block are fitted by 3 Q²/τ² + N²/τ beside
/// the known slow parts; a filter of the samples is shorter than that. `None` if the log is too short.
pub(super) fn mean_variance(
    rates: &[f64],
    interval_s: f64,
    block_s: f64,
    slow: Slow,
) -> Option<f64> {
    const CONFIDENCE: f64 = 0.95;
    let length = ((block_s / interval_s) as usize / PARTS_OF_BLOCK).max(1);
    let means: Vec<f64> = rates
        .chunks_exact(length)
        .map(|chunk| chunk.iter().sum::<f64>() / length as f64)
        .collect();
    let averaging: Vec<usize> = octaves(means.len())
        .into_iter()
        .filter(|count| *count <= PARTS_OF_BLOCK)
        .collect();
    let short_s = interval_s * length as f64;
    let points = allan_deviation(&means, short_s, &averaging, CONFIDENCE).ok()?;
    let of_flicker = 2.0 * core::f64::consts::LN_2 / core::f64::consts::PI;
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    let rows: Vec<(Vector2<f64>, f64, f64)> = points
        .iter()
        .map(|point| {
            let tau_s = point.tau_s;
            let known = of_flicker * slow.bias_instability + slow.rate_random_walk * tau_s / 3.0;
            let variance = point.deviation * point.deviation;
            let weight = point.degrees_of_freedom / (2.0 * variance * variance);
            let row = Vector2::new(1.0 / tau_s, 3.0 / (tau_s * tau_s));
            (row, variance - known, weight)
        })
        .collect();
    for (row, variance, weight) in &rows {
        normal += *weight * row * row.transpose();
        right += *weight * *variance * row;
    }
    let both = normal.cholesky()?.solve(&right);
    let alone = |part: usize| (right[part] / normal[(part, part)]).max(0.0);
    let [random_walk, quantisation] = match (both.x >= 0.0, both.y >= 0.0) {
        (true, true) => [both.x, both.y],
        (true, false) => [alone(0), 0.0],
        _ => [0.0, alone(1)],
    };
    let duration_s = interval_s * rates.len() as f64;
    // The angle at both ends is quantised.
    Some(random_walk / duration_s + 2.0 * quantisation / (duration_s * duration_s))
}

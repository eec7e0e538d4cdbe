//! What the prior of the coefficients says of drifts.

use gyrocal_record::Bench;

use crate::samples::Complete;

/// Least standard deviation of a drift, deg/h: priors are declared smaller than gyros are, and a rate
/// from accelerometers alone is known to a few tenths.
const LEAST_DEG_PER_H: f64 = 1.0;

/// Standard deviation of the mean drift about the vertical over some rows, deg/h.
pub(crate) fn vertical_sigma_deg_per_h(bench: &Bench, rows: &[Complete]) -> f64 {
    let count = rows.len().max(1) as f64;
    let prior = &bench.prior;
    let mut variance = 0.0;
    for axis in 0..3 {
        let mean = |power: i32| -> f64 {
            rows.iter().map(|row| row.up[axis].powi(power)).sum::<f64>() / count
        };
        let parts = [
            bias(bench, axis) * mean(1),
            prior.g_sigma_deg_per_h_per_g[axis] * mean(2),
            prior.gg_sigma_deg_per_h_per_g2[axis] * mean(3),
        ];
        variance += parts.iter().map(|part| part * part).sum::<f64>();
    }
    variance.sqrt().max(LEAST_DEG_PER_H)
}

/// Standard deviation of one component of the drift across the vertical, deg/h.
pub(crate) fn horizontal_sigma_deg_per_h(bench: &Bench) -> f64 {
    let prior = &bench.prior;
    let largest = |sigmas: [f64; 3]| sigmas.into_iter().fold(0.0, f64::max);
    let biases = core::array::from_fn(|axis| bias(bench, axis));
    // Drifts that depend on force are smaller across the vertical: a third of the square of each.
    let square = largest(biases).powi(2)
        + largest(prior.g_sigma_deg_per_h_per_g).powi(2) / 3.0
        + largest(prior.gg_sigma_deg_per_h_per_g2).powi(2) / 3.0;
    square.sqrt().max(LEAST_DEG_PER_H)
}

fn bias(bench: &Bench, axis: usize) -> f64 {
    let prior = &bench.prior;
    prior.bias_sigma_deg_per_h[axis].hypot(prior.turn_on_sigma_deg_per_h[axis])
}

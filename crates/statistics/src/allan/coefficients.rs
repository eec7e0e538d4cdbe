//! Noise coefficients from an Allan deviation.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::{AllanPoint, NoiseType};

/// Parts of a noise by their slopes (IEEE Std 952, annex C), in units of the rate and seconds;
/// zero where a part does not show.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct NoiseCoefficients {
    /// Q: white noise of the angle, variance 3 Q² / τ² \[unit · s\].
    pub quantisation: f64,
    /// N: white noise of the rate, variance N² / τ \[unit · √s\].
    pub random_walk: f64,
    /// B: flicker of the rate, variance B² (2 ln 2) / π \[unit\].
    pub bias_instability: f64,
    /// K: random walk of the rate, variance K² τ / 3 \[unit / √s\].
    pub rate_random_walk: f64,
}

/// Fits the four parts, none of them negative, by least squares of the relative errors of the
/// variances, weighted by their degrees of freedom. Where a ramp makes most of the deviation it says
/// nothing of them.
///
/// Points of one record overlap: the parts describe the curve, they are no test of which
/// exist.
#[must_use]
pub fn noise_coefficients(points: &[AllanPoint]) -> NoiseCoefficients {
    const PARTS: usize = 4;
    let shape = |part: usize, tau: f64| match part {
        0 => 3.0 / (tau * tau),
        1 => 1.0 / tau,
        2 => 2.0 * core::f64::consts::LN_2 / core::f64::consts::PI,
        _ => tau / 3.0,
    };
    let usable: Vec<&AllanPoint> = points
        .iter()
        .filter(|point| point.deviation > 0.0 && point.noise != NoiseType::RateRamp)
        .collect();
    let Some(first) = usable.first() else {
        return NoiseCoefficients::default();
    };
    // In units of the first point, so that squares of any deviation and time are numbers.
    let relative = |point: &AllanPoint| {
        let deviation = point.deviation / first.deviation;
        (point.tau_s / first.tau_s, deviation * deviation)
    };
    let ones = usable.iter().map(|p| (0.5 * p.degrees_of_freedom).sqrt());
    let right = DVector::from_iterator(usable.len(), ones);
    let mut best: Option<(f64, [f64; PARTS])> = None;
    // Few enough to try every set of parts: the best with no negative one is the solution.
    for set in 1_u8..1 << PARTS {
        let parts: Vec<usize> = (0..PARTS).filter(|part| set >> part & 1 == 1).collect();
        if parts.len() > usable.len() {
            continue;
        }
        let matrix = DMatrix::from_fn(usable.len(), parts.len(), |row, column| {
            let (tau, variance) = relative(usable[row]);
            right[row] / variance * shape(parts[column], tau)
        });
        // Of comparable size, so that the solution loses no digits.
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let mut scaled = matrix.clone();
        for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        if scaled.iter().any(|value| !value.is_finite()) {
            continue;
        }
        let Ok(solution) = scaled.clone().svd(true, true).solve(&right, 1e-12) else {
            continue;
        };
        let cost = (&right - scaled * &solution).norm_squared();
        let better = best.is_none_or(|(lowest, _)| cost < lowest);
        if better && solution.iter().all(|value| *value >= 0.0) {
            let mut variances = [0.0; PARTS];
            for ((part, value), length) in parts.iter().zip(solution.iter()).zip(&lengths) {
                variances[*part] = value / length;
            }
            best = Some((cost, variances));
        }
    }
    let [q, n, b, k] = best.map_or([0.0; PARTS], |(_, variances)| {
        variances.map(|variance| first.deviation * variance.sqrt())
    });
    NoiseCoefficients {
        quantisation: q * first.tau_s,
        random_walk: n * first.tau_s.sqrt(),
        bias_instability: b,
        rate_random_walk: k / first.tau_s.sqrt(),
    }
}

//! Covariance of means over blocks by the parts of the noise, estimated with the law.
//!
//! The iteration is that of H. Zhou, L. Hu, J. Zhou and K. Lange, "MM algorithms for variance
//! components models", Journal of Computational and Graphical Statistics 28, 2019: each variance is
//! multiplied by the root of the ratio of its quadratic form to its expectation, which keeps it positive and
//! never lowers the likelihood.

use core::f64::consts::PI;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::blocks::Blocks;

/// Parts of the noise, in the order of [`Variances`].
pub(super) const PARTS: usize = 4;

/// Squares of the coefficients: random walk N \[deg²/h² s\], quantisation Q \[deg²/h² s²\], bias
/// instability B \[deg²/h²\], rate random walk K \[deg²/h²/s\].
pub(super) type Variances = [f64; PARTS];

/// Iterations; the likelihood changes by less than 0.05 after.
const ITERATIONS: usize = 40;

/// Covariances of one gyro's means over all logs.
pub(super) struct NoiseModel {
    parts: [DMatrix<f64>; PARTS],
    /// Covariance that is known: of heading and level.
    known: DMatrix<f64>,
}

/// A law fitted by generalised least squares.
#[derive(Clone)]
pub(super) struct Fit {
    pub(super) estimates: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) variances: Variances,
    /// Twice the logarithm of the likelihood, without its constant.
    pub(super) twice_ln_likelihood: f64,
}

impl NoiseModel {
    /// Model of `gyro`; `horizontal_deg_per_h` is the horizontal part of Earth rate, whose direction is not
    /// known, and `level_sigma_rad` the standard deviation of the level.
    pub(super) fn of(
        logs: &[Blocks],
        gyro: usize,
        horizontal_deg_per_h: f64,
        level_sigma_rad: f64,
    ) -> Self {
        let total = logs.iter().map(Blocks::len).sum();
        let mut parts: [DMatrix<f64>; PARTS] =
            core::array::from_fn(|_| DMatrix::zeros(total, total));
        let mut known = DMatrix::zeros(total, total);
        let mut first = 0;
        for log in logs {
            let count = log.len();
            for (part, matrix) in parts.iter_mut().enumerate() {
                let own = DMatrix::from_fn(count, count, |i, j| {
                    covariance(part, i, j, count, log.block_s)
                });
                matrix
                    .view_mut((first, first), (count, count))
                    .copy_from(&own);
            }
            let mut heading = log.of_heading(gyro) * horizontal_deg_per_h.powi(2);
            if let Some(level) = log.of_level(gyro, level_sigma_rad) {
                heading += level;
            }
            known
                .view_mut((first, first), (count, count))
                .copy_from(&heading);
            first += count;
        }
        Self { parts, known }
    }

    /// Fits columns to rates with the variances of most likelihood, restricted or not; `None` if the columns
    /// are not independent.
    pub(super) fn fit(
        &self,
        columns: &DMatrix<f64>,
        rates: &DVector<f64>,
        start: Variances,
        restricted: bool,
    ) -> Option<Fit> {
        let mut variances = start;
        for _ in 0..ITERATIONS {
            let (solved, inverse) = self.solve(columns, rates, variances)?;
            let weights = match restricted {
                true => {
                    let across = &inverse * columns;
                    &inverse - &across * &solved.covariance * across.transpose()
                }
                false => inverse.clone(),
            };
            let left = &inverse * (rates - columns * &solved.estimates);
            for (variance, part) in variances.iter_mut().zip(&self.parts) {
                let found = left.dot(&(part * &left));
                let expected = weights.component_mul(part).sum();
                *variance *= (found / expected).max(0.0).sqrt();
            }
        }
        Some(self.solve(columns, rates, variances)?.0)
    }

    /// Fits columns with given variances; also the inverse of the covariance.
    pub(super) fn solve(
        &self,
        columns: &DMatrix<f64>,
        rates: &DVector<f64>,
        variances: Variances,
    ) -> Option<(Fit, DMatrix<f64>)> {
        let mut sum = self.known.clone();
        for (part, variance) in self.parts.iter().zip(variances) {
            sum += part * variance;
        }
        let factor: Cholesky<f64, Dyn> = sum.cholesky()?;
        let ln_determinant: f64 = factor
            .l_dirty()
            .diagonal()
            .iter()
            .map(|d| 2.0 * d.ln())
            .sum();
        let inverse = factor.inverse();
        let weighted = &inverse * columns;
        let normal = columns.transpose() * &weighted;
        let covariance = normal.cholesky()?.inverse();
        let estimates = &covariance * weighted.transpose() * rates;
        let left = rates - columns * &estimates;
        let fit = Fit {
            twice_ln_likelihood: -ln_determinant - left.dot(&(&inverse * &left)),
            estimates,
            covariance,
            variances,
        };
        Some((fit, inverse))
    }
}

/// Variances to begin from: each part as large as the scatter of the residuals about their mean.
pub(super) fn first_variances(logs: &[Blocks], rates: &DVector<f64>) -> Variances {
    let mut first = 0;
    let (mut sum, mut block_s, mut duration_s) = (0.0, 0.0, 0.0);
    for log in logs {
        let own = rates.rows(first, log.len());
        sum += own.variance() * log.len() as f64;
        block_s += log.block_s * log.len() as f64;
        duration_s += log.block_s * (log.len() * log.len()) as f64;
        first += log.len();
    }
    let count = first as f64;
    let variance = 0.25 * (sum / count).max(1e-12);
    let [block_s, duration_s] = [block_s, duration_s].map(|sum| sum / count);
    [
        variance * block_s,
        variance * block_s * block_s,
        variance,
        variance / duration_s,
    ]
}

/// Covariance of the means over blocks `i` and `j` of `count`, for a coefficient of one.
fn covariance(part: usize, i: usize, j: usize, count: usize, block_s: f64) -> f64 {
    let lag = i.abs_diff(j);
    match part {
        0 => {
            if lag == 0 {
                1.0 / block_s
            } else {
                0.0
            }
        }
        1 => match lag {
            0 => 2.0 / (block_s * block_s),
            1 => -1.0 / (block_s * block_s),
            _ => 0.0,
        },
        // The density B² / (2 π f) begins at about the inverse of the length of the log: slower parts are bias.
        2 => ((count as f64).ln() + 1.0 + flicker(lag)) / PI,
        _ => {
            let before = i.min(j) as f64;
            block_s
                * if lag == 0 {
                    before + 1.0 / 3.0
                } else {
                    before + 0.5
                }
        }
    }
}

/// Mean of -ln of the distance of two points of two intervals of length one, `lag` apart.
fn flicker(lag: usize) -> f64 {
    let integral = |x: f64| match x {
        0.0 => 0.0,
        x => 0.5 * x * x * x.ln() - 0.75 * x * x,
    };
    let lag = lag as f64;
    2.0 * integral(lag) - integral(lag + 1.0) - integral((lag - 1.0).abs())
}

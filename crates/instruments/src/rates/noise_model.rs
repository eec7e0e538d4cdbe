//! Covariance of means over blocks by the parts of the noise, estimated with the law.
//!
//! The iteration is that of H. Zhou, L. Hu, J. Zhou and K. Lange, "MM algorithms for variance
//! components models", Journal of Computational and Graphical Statistics 28, 2019: each variance is
//! multiplied by the root of the ratio of its quadratic form to its expectation, which keeps it positive and
//! never lowers the likelihood.

use core::f64::consts::PI;
use core::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::blocks::Blocks;
use crate::interval_noise::{flicker, walk};

/// Parts of the noise, in the order of [`Variances`].
pub(super) const PARTS: usize = 5;

/// Squares of the coefficients: random walk N \[deg²/h² s\], quantisation Q \[deg²/h² s²\], bias
/// instability B \[deg²/h²\], rate random walk K \[deg²/h²/s\], change of the bias from log to log \[deg²/h²\].
pub(super) type Variances = [f64; PARTS];

/// The part that changes from log to log only: what of the bias a single log cannot show. Slow noise and
/// repeated turn-ons make it.
pub(super) const BETWEEN_LOGS: usize = 4;

/// Iterations; the likelihood changes by less than 0.05 after.
const ITERATIONS: usize = 40;

/// Information on the logarithm of a variance before any log: its standard deviation is ten.
const LEAST_INFORMATION: f64 = 1e-2;

/// Least variance of the bias from log to log over that of the mean of a log, of one free difference: few that are small by
/// chance do not show that it is nothing. With it intervals hold 93 % and more for any change of the bias.
const LEAST_BETWEEN_LOGS: f64 = 0.2;

/// Degrees of freedom from which Student's distribution is the normal one.
const MOST_FREEDOM: f64 = 1e6;

/// Covariances of one gyro's means over all logs.
pub(super) struct NoiseModel {
    parts: [DMatrix<f64>; PARTS],
    /// Covariance that is known: of heading and level.
    known: DMatrix<f64>,
    /// Squares of random walk and quantisation, if they are known from within blocks.
    fast: Option<[f64; 2]>,
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
    /// known, `level_sigma_rad` the standard deviation of the level, and `fast` what is known of random walk
    /// and quantisation.
    pub(super) fn of(
        logs: &[Blocks],
        gyro: usize,
        horizontal_deg_per_h: f64,
        level_sigma_rad: f64,
        fast: Option<[f64; 2]>,
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
                        * f64::from(u8::from(part != BETWEEN_LOGS || logs.len() > 1))
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
        Self { parts, known, fast }
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
        for (variance, known) in variances.iter_mut().zip(self.fast.into_iter().flatten()) {
            *variance = known;
        }
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
            let free = variances
                .iter_mut()
                .zip(&self.parts)
                .skip(self.known_parts());
            for (variance, part) in free {
                let found = left.dot(&(part * &left));
                let expected = weights.component_mul(part).sum();
                // A part that these logs do not have stays zero.
                *variance *= if expected > 0.0 {
                    (found / expected).max(0.0).sqrt()
                } else {
                    0.0
                };
            }
        }
        Some(self.solve(columns, rates, variances)?.0)
    }

    /// Degrees of freedom of the standard deviation of each coefficient, where these parts are uncertain, by
    /// Satterthwaite's approximation with the expected information on the variances: F. E. Satterthwaite, "An
    /// approximate distribution of estimates of variance components", Biometrics Bulletin 2, 1946; M. G. Kenward and
    /// J. H. Roger, "Small sample inference for fixed effects from restricted maximum likelihood", Biometrics 53, 1997.
    pub(super) fn degrees_of_freedom(
        &self,
        columns: &DMatrix<f64>,
        rates: &DVector<f64>,
        variances: Variances,
        uncertain: Range<usize>,
    ) -> Option<Vec<f64>> {
        let (fit, inverse) = self.solve(columns, rates, variances)?;
        let across = &inverse * columns;
        let projection = &inverse - &across * &fit.covariance * across.transpose();
        // In the logarithms of the variances: a part that vanishes takes no share.
        let parts = uncertain.map(|part| &self.parts[part] * variances[part]);
        let parts: Vec<DMatrix<f64>> = parts.collect();
        let weighted: Vec<DMatrix<f64>> = parts.iter().map(|part| &projection * part).collect();
        let count = parts.len();
        let mut information = DMatrix::from_fn(count, count, |i, j| {
            0.5 * weighted[i].dot(&weighted[j].transpose())
        });
        for part in 0..count {
            information[(part, part)] += LEAST_INFORMATION;
        }
        let of_variances = information.cholesky()?.inverse();
        let taken = &across * &fit.covariance;
        let slopes: Vec<DMatrix<f64>> = parts
            .iter()
            .map(|part| taken.transpose() * part * &taken)
            .collect();
        let of_coefficient = |index: usize| {
            let slope = DVector::from_fn(count, |part, _| slopes[part][(index, index)]);
            let variance = fit.covariance[(index, index)];
            let of_variance = slope.dot(&(&of_variances * &slope));
            (2.0 * variance * variance / of_variance).clamp(1.0, MOST_FREEDOM)
        };
        Some((0..columns.ncols()).map(of_coefficient).collect())
    }

    /// Parts whose variances are fitted.
    pub(super) fn fitted_parts(&self) -> Range<usize> {
        self.known_parts()..PARTS
    }

    /// Variances with no less change of the bias from log to log than so many free differences of the biases leave
    /// likely; none is known of no difference.
    pub(super) fn with_likely_change(
        &self,
        mut variances: Variances,
        free_differences: usize,
    ) -> Variances {
        if free_differences == 0 {
            return variances;
        }
        let within_logs = &self.parts[BETWEEN_LOGS];
        let others = self.parts[..BETWEEN_LOGS].iter().zip(variances);
        let others = others.map(|(part, variance)| variance * part.dot(within_logs));
        let of_means = (self.known.dot(within_logs) + others.sum::<f64>()) / within_logs.sum();
        let least = LEAST_BETWEEN_LOGS * of_means / (free_differences as f64).powi(2);
        variances[BETWEEN_LOGS] = variances[BETWEEN_LOGS].max(least);
        variances
    }

    /// Number of parts whose variances are not fitted; they are the first.
    fn known_parts(&self) -> usize {
        self.fast.map_or(0, |known| known.len())
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
        variance,
    ]
}

/// Covariance of the means over blocks `i` and `j` of `count`, for a coefficient of one.
fn covariance(part: usize, i: usize, j: usize, count: usize, block_s: f64) -> f64 {
    let lag = i.abs_diff(j);
    let [one, other] = [i, j].map(|block| [block as f64, block as f64 + 1.0]);
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
        2 => ((count as f64).ln() + 1.0 + flicker(one, other)) / PI,
        BETWEEN_LOGS => 1.0,
        _ => block_s * walk(one, other),
    }
}

//! Noise of gyros between stops: flicker, a walk, and a scatter of the stops.
//!
//! How large they are is told by what the law leaves of the stops and by the parts of each stop, and by no more than
//! that: estimates, their intervals and the significance of a term are integrated over the levels. A term of a few
//! stops is thereby held against the scatter that these stops may have, with the tails that few degrees of freedom
//! give it, and a ramp against walks.

use gyrocal_statistics::math::{exp, ln};
use gyrocal_statistics::{NORMAL_97_5, chi_square_tail, normal_probability, two_sided_p};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::level_fits::{FitAtLevel, Gram, all_levels};
use super::levels::{DIMENSIONS, Grid};
use super::positions::Positions;
use super::stop_parts::StopParts;
use super::terms::Term;

/// Probability of an interval of a coefficient.
const COVERAGE: f64 = 0.95;

/// Least weight of a level that counts for an interval: thousands of such are nothing.
const LEAST_WEIGHT: f64 = 1e-9;

/// Share of the levels of a kind, of the least and of the largest, that need not be looked at again where some of the
/// stops are held out: these tell little more.
const UNLIKELY: f64 = 1e-6;

/// Noise of one gyro between stops: median and largest level that the stops hold likely (97.5 %) of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseBetweenStops {
    /// Scatter of the stops beyond their standard errors: settling, turn-on of each log \[deg/h\].
    pub scatter_deg_per_h: [f64; 2],
    /// Flicker, as bias instability: B of IEEE Std 952 \[deg/h\].
    pub flicker_deg_per_h: [f64; 2],
    /// Walk from stop to stop, as the standard deviation of an increment \[deg/h\].
    pub walk_deg_per_h: [f64; 2],
}

/// The stops of three gyros at all levels of noise between them.
pub(super) struct BetweenStops {
    grid: Grid,
    parts: [StopParts; 3],
    /// Of each gyro, all levels in the order of the grid.
    gyros: [Vec<Gram>; 3],
    /// Biases of logs after the first that each law has.
    pub(super) biases: usize,
}

/// A law, integrated over the levels.
pub(super) struct LawEstimate {
    /// Its terms, and the biases of logs after the first.
    pub(super) estimates: DVector<f64>,
    /// Covariance; its intervals of two standard deviations hold 95 % of the distribution of each coefficient.
    pub(super) covariance: DMatrix<f64>,
    pub(super) noise: NoiseBetweenStops,
}

/// A term beside a law, integrated over the levels.
pub(super) struct TermEvidence {
    /// Probability of as large an estimate of a coefficient that is zero.
    pub(super) p_value: f64,
    /// Log-likelihood of the best coefficient, integrated over the levels.
    pub(super) log_likelihood: f64,
}

impl BetweenStops {
    /// Of stops whose gyros have these nominal laws.
    pub(super) fn of(positions: &Positions, laws: &[Vec<Term>]) -> Self {
        let parts = || core::array::from_fn(|gyro| StopParts::of(positions, gyro));
        let stops = positions.time_s.len();
        let biases = positions.logs().len().saturating_sub(1);
        let spare = |law: &Vec<Term>| law.len() + biases < stops;
        if biases > 0 && biases + 1 < stops && laws.iter().all(spare) {
            let each = Self::with_biases(parts(), laws, biases);
            if (0..3).all(|gyro| {
                each.gyros[gyro][0]
                    .fit(&each.columns(gyro, &laws[gyro]))
                    .is_some()
            }) {
                return each;
            }
        }
        Self::with_biases(parts(), laws, 0)
    }

    fn with_biases(parts: [StopParts; 3], laws: &[Vec<Term>], biases: usize) -> Self {
        let largest = parts.iter().zip(laws).map(|(part, law)| {
            let freedom = part.stops().saturating_sub(law.len() + biases);
            part.largest_level(law, biases, freedom)
        });
        let spare = |law: &Vec<Term>| parts[0].stops() > law.len() + biases;
        let grid = Grid::new(largest.fold(0.0, f64::max), laws.iter().any(spare));
        Self::at(parts, grid, biases)
    }

    fn at(parts: [StopParts; 3], grid: Grid, biases: usize) -> Self {
        Self {
            gyros: core::array::from_fn(|gyro| all_levels(&parts[gyro], &grid, biases)),
            grid,
            parts,
            biases,
        }
    }

    /// The levels that any of these laws of the gyros leave likely.
    pub(super) fn likely(&self, of_laws: &[&[Vec<Term>]]) -> Option<Grid> {
        let mut ranges = [[f64::INFINITY, 0.0]; DIMENSIONS];
        for laws in of_laws {
            for gyro in 0..3 {
                let weights = weights(&self.prior(gyro, laws)?, &self.fits(gyro, &laws[gyro])?);
                for (dimension, [least, largest]) in ranges.iter_mut().enumerate() {
                    let level = |share| self.grid.quantile(&weights, dimension, share);
                    *least = least.min(level(UNLIKELY));
                    *largest = largest.max(level(1.0 - UNLIKELY));
                }
            }
        }
        Some(self.grid.within(ranges))
    }

    /// The same without some stops, at some of the levels.
    pub(super) fn without(&self, held: &[usize], grid: &Grid) -> Self {
        let parts = core::array::from_fn(|gyro| self.parts[gyro].without(held));
        Self::at(parts, grid.clone(), self.biases)
    }

    /// Degrees of freedom of the noise between stops in all gyros, beside a term of each.
    pub(super) fn freedom(&self, stops: usize, laws: &[Vec<Term>]) -> usize {
        let left = |law: &Vec<Term>| stops.saturating_sub(law.len() + self.biases + 1);
        laws.iter().map(left).sum()
    }

    /// Columns of a law and of the biases of logs in the products of a gyro.
    fn columns(&self, gyro: usize, law: &[Term]) -> Vec<usize> {
        let own = &self.parts[gyro];
        let mut columns: Vec<usize> = law.iter().filter_map(|term| own.place(*term)).collect();
        columns.extend((0..self.biases).map(|bias| 1 + own.terms.len() + bias));
        columns
    }

    /// Fits of all levels of a gyro with a law; `None` where it is not determined.
    fn fits(&self, gyro: usize, law: &[Term]) -> Option<Vec<FitAtLevel>> {
        let columns = self.columns(gyro, law);
        let levels = self.gyros[gyro].iter();
        levels.map(|gram| gram.fit(&columns)).collect()
    }

    /// Likelihoods of the levels that are common to some gyros with their laws, as logarithms.
    fn common(&self, gyros: impl Iterator<Item = usize>, laws: &[Vec<Term>]) -> Option<Vec<f64>> {
        let mut ln_common = vec![0.0; self.grid.len()];
        for gyro in gyros {
            let fits = self.fits(gyro, &laws[gyro])?;
            let likelihoods: Vec<f64> = fits.iter().map(|fit| fit.log_likelihood).collect();
            for (sum, own) in ln_common.iter_mut().zip(self.grid.common(&likelihoods)) {
                *sum += own;
            }
        }
        Some(ln_common)
    }

    /// Log-likelihood of the laws of all gyros, integrated over coefficients and levels, but for a constant.
    pub(super) fn log_evidence(&self, laws: &[Vec<Term>]) -> Option<f64> {
        self.common(0..3, laws).map(|logs| ln_sum(&logs))
    }

    /// What the other gyros, with their laws, hold likely of the levels of one: logarithms of a prior.
    fn prior(&self, gyro: usize, laws: &[Vec<Term>]) -> Option<Vec<f64>> {
        let others = (0..3).filter(|other| *other != gyro);
        let ln_common = self.common(others, laws)?;
        Some(self.grid.of_gyro(&ln_common))
    }

    /// Each of these terms beside the law of a gyro; `None` of one that the stops do not determine.
    pub(super) fn terms(
        &self,
        gyro: usize,
        laws: &[Vec<Term>],
        terms: &[Term],
    ) -> Vec<Option<TermEvidence>> {
        let (Some(prior), Some(base)) = (self.prior(gyro, laws), self.fits(gyro, &laws[gyro]))
        else {
            return terms.iter().map(|_| None).collect();
        };
        let evidence = |term: &Term| {
            let at = self.parts[gyro].place(*term)?;
            let levels = base.iter().zip(&self.gyros[gyro]);
            let beside = levels.map(|(fit, gram)| fit.beside(gram, at));
            let beside: Vec<[f64; 2]> = beside.collect::<Option<_>>()?;
            let logs = prior.iter().zip(&beside);
            let weights = normalised(
                &logs
                    .map(|(prior, [_, own])| prior + own)
                    .collect::<Vec<_>>(),
            );
            let pairs = weights.iter().zip(&beside);
            let p_value = pairs.map(|(weight, [normal, _])| weight * two_sided_p(*normal));
            let best = prior.iter().zip(&base).zip(&beside);
            let best = best.map(|((prior, fit), [normal, _])| {
                prior + fit.log_likelihood + 0.5 * normal * normal
            });
            Some(TermEvidence {
                p_value: p_value.sum(),
                log_likelihood: ln_sum(&best.collect::<Vec<_>>()),
            })
        };
        terms.iter().map(evidence).collect()
    }

    /// Probability of biases of logs that are as different, of a gyro of one bias; `None` where laws have none.
    pub(super) fn one_bias(&self, gyro: usize, laws: &[Vec<Term>]) -> Option<f64> {
        let columns = self.columns(gyro, &laws[gyro]);
        let (law, _) = columns.split_at(columns.len() - self.biases);
        let (prior, fits) = (self.prior(gyro, laws)?, self.fits(gyro, &laws[gyro])?);
        let weights = weights(&prior, &fits);
        let mut p_value = 0.0;
        for ((weight, fit), gram) in weights.iter().zip(&fits).zip(&self.gyros[gyro]) {
            let explained = gram.fit(law)?.left() - fit.left();
            p_value += weight * chi_square_tail(explained.max(0.0), self.biases as f64)?;
        }
        Some(p_value)
    }

    /// The law of a gyro, integrated over the levels; `None` where the stops do not determine it.
    pub(super) fn law(&self, gyro: usize, laws: &[Vec<Term>]) -> Option<LawEstimate> {
        let columns = self.columns(gyro, &laws[gyro]);
        let (prior, fits) = (self.prior(gyro, laws)?, self.fits(gyro, &laws[gyro])?);
        let weights = weights(&prior, &fits);
        let count = columns.len();
        let levels = weights.iter().zip(&fits);
        let levels = levels.filter(|(weight, _)| **weight > LEAST_WEIGHT);
        let levels: Vec<_> = levels
            .map(|(weight, fit)| (*weight, fit.estimates(&columns), fit.covariance(&columns)))
            .collect();
        let mut estimates = DVector::zeros(count);
        for (weight, own, _) in &levels {
            estimates += *weight * own;
        }
        let mut covariance = DMatrix::zeros(count, count);
        for (weight, own, spread) in &levels {
            let off = own - &estimates;
            covariance += *weight * (spread + &off * off.transpose());
        }
        let scales = DVector::from_fn(count, |i, _| {
            let normals = levels.iter().map(|(weight, own, spread)| {
                [*weight, own[i] - estimates[i], spread[(i, i)].sqrt()]
            });
            half_width(&normals.collect::<Vec<_>>()) / NORMAL_97_5 / covariance[(i, i)].sqrt()
        });
        let covariance = DMatrix::from_fn(count, count, |i, j| {
            covariance[(i, j)] * scales[i] * scales[j]
        });
        let unit = self.parts[gyro].unit_deg_per_h;
        let [scatter_deg_per_h, flicker_deg_per_h, walk_deg_per_h] =
            core::array::from_fn::<_, DIMENSIONS, _>(|dimension| {
                [0.5, 0.975].map(|share| unit * self.grid.quantile(&weights, dimension, share))
            });
        Some(LawEstimate {
            estimates,
            covariance,
            noise: NoiseBetweenStops {
                scatter_deg_per_h,
                flicker_deg_per_h,
                walk_deg_per_h,
            },
        })
    }
}

/// Weights of levels, which sum to one.
fn weights(prior: &[f64], fits: &[FitAtLevel]) -> Vec<f64> {
    let pairs = prior.iter().zip(fits);
    let logs: Vec<f64> = pairs
        .map(|(prior, fit)| prior + fit.log_likelihood)
        .collect();
    normalised(&logs)
}

/// Shares of exponentials in their sum.
fn normalised(logs: &[f64]) -> Vec<f64> {
    let sum = ln_sum(logs);
    logs.iter().map(|one| exp(one - sum)).collect()
}

/// Half the width of the interval about zero that holds [`COVERAGE`] of a mixture of normal distributions, each with
/// its weight, mean and standard deviation.
fn half_width(normals: &[[f64; 3]]) -> f64 {
    /// Number of bisections, for a relative accuracy of 1e-9.
    const HALVINGS: usize = 30;
    let beyond = |half: f64| -> f64 {
        let tails = normals.iter().map(|[weight, mean, sigma]| {
            let upper = normal_probability((mean - half) / sigma);
            let lower = normal_probability((-mean - half) / sigma);
            weight * (upper + lower)
        });
        tails.sum()
    };
    let reach = |[_, mean, sigma]: &[f64; 3]| mean.abs() + 8.0 * sigma;
    let (mut low, mut high) = (0.0, normals.iter().map(reach).fold(0.0, f64::max));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if beyond(middle) > 1.0 - COVERAGE {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Logarithm of a sum of exponentials.
pub(super) fn ln_sum(logs: &[f64]) -> f64 {
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest + ln(logs.iter().map(|one| exp(one - largest)).sum::<f64>())
}

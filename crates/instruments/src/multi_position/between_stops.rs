//! Noise of gyros between stops: flicker, a walk, and a scatter of the stops.
//!
//! How large they are is told by what the law leaves of the stops and by the parts of each stop, and by no more than
//! that: estimates, their intervals and the significance of a term are integrated over the levels. A term of a few
//! stops is thereby held against the scatter that these stops may have, with the tails that few degrees of freedom
//! give it, and a ramp against walks.

use gyrocal_statistics::math::{exp, ln};
use gyrocal_statistics::{NORMAL_97_5, normal_probability, two_sided_p};
use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

use super::levels::{DIMENSIONS, Grid, Levels};
use super::positions::Positions;
use super::stop_parts::StopParts;
use super::terms::Term;

/// Probability of an interval of a coefficient.
const COVERAGE: f64 = 0.95;

/// Least share of a scaled column that others leave of it, where a fit has it.
const LEAST_SHARE: f64 = 1e-9;

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
    gyros: [GyroAtLevels; 3],
    /// Biases of logs after the first that each law has.
    pub(super) biases: usize,
}

/// One gyro at all levels.
struct GyroAtLevels {
    /// Terms whose columns are there.
    terms: Vec<Term>,
    /// Standard error that levels are multiples of \[deg/h\].
    unit_deg_per_h: f64,
    at: Vec<Gram>,
}

/// Products of rates, terms and biases of logs over the covariance of one level, in this order.
struct Gram {
    ln_determinant: f64,
    products: DMatrix<f64>,
}

/// A law fitted at one level.
struct FitAtLevel {
    /// Restricted log-likelihood: the coefficients are integrated out.
    log_likelihood: f64,
    estimates: DVector<f64>,
    covariance: DMatrix<f64>,
}

/// A law, integrated over the levels.
pub(super) struct LawEstimate {
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
        let parts: [StopParts; 3] = core::array::from_fn(|gyro| StopParts::of(positions, gyro));
        let biases = positions.logs().len().saturating_sub(1);
        let has_stops_to_spare = biases > 0 && biases + 1 < positions.time_s.len();
        if has_stops_to_spare {
            let each = Self::with_biases(&parts, laws, biases);
            let spare = |law: &Vec<Term>| law.len() + biases < positions.time_s.len();
            if laws.iter().all(spare) && each.all_determined(laws) {
                return each;
            }
        }
        Self::with_biases(&parts, laws, 0)
    }

    fn with_biases(parts: &[StopParts; 3], laws: &[Vec<Term>], biases: usize) -> Self {
        let largest = parts.iter().zip(laws).map(|(part, law)| {
            let freedom = part.stops().saturating_sub(law.len() + biases);
            part.largest_level(law, biases, freedom)
        });
        let spare = |law: &Vec<Term>| parts[0].stops() > law.len() + biases;
        let grid = Grid::new(largest.fold(0.0, f64::max), laws.iter().any(spare));
        let gyros = core::array::from_fn(|gyro| GyroAtLevels::of(&parts[gyro], &grid, biases));
        Self {
            grid,
            gyros,
            biases,
        }
    }

    fn all_determined(&self, laws: &[Vec<Term>]) -> bool {
        let mut pairs = self.gyros.iter().zip(laws);
        pairs.all(|(gyro, law)| gyro.at[0].fit(&self.columns(gyro, law, None)).is_some())
    }

    /// Degrees of freedom of the noise between stops in all gyros, beside a term of each.
    pub(super) fn freedom(&self, stops: usize, laws: &[Vec<Term>]) -> usize {
        let left = |law: &Vec<Term>| stops.saturating_sub(law.len() + self.biases + 1);
        laws.iter().map(left).sum()
    }

    /// Columns of a law, and of one term more, in the Gram matrices of a gyro.
    fn columns(&self, gyro: &GyroAtLevels, law: &[Term], with: Option<Term>) -> Vec<usize> {
        let place = |term: &Term| gyro.terms.iter().position(|one| one == term);
        let terms = gyro.terms.len();
        let mut columns: Vec<usize> = law.iter().filter_map(place).map(|at| at + 1).collect();
        columns.extend((0..self.biases).map(|bias| 1 + terms + bias));
        columns.extend(with.as_ref().and_then(place).map(|at| at + 1));
        columns
    }

    /// Log-likelihoods of all levels of a gyro with a law; no level where it is not determined.
    fn fits(&self, gyro: usize, law: &[Term], with: Option<Term>) -> Option<Vec<FitAtLevel>> {
        let own = &self.gyros[gyro];
        let columns = self.columns(own, law, with);
        own.at.iter().map(|gram| gram.fit(&columns)).collect()
    }

    /// What the other gyros, with their laws, hold likely of the levels of one: logarithms of a prior.
    fn prior(&self, gyro: usize, laws: &[Vec<Term>]) -> Option<Vec<f64>> {
        let mut ln_common = vec![0.0; self.grid.len()];
        for other in (0..3).filter(|other| *other != gyro) {
            let fits = self.fits(other, &laws[other], None)?;
            let likelihoods: Vec<f64> = fits.iter().map(|fit| fit.log_likelihood).collect();
            for (sum, own) in ln_common.iter_mut().zip(self.grid.common(&likelihoods)) {
                *sum += own;
            }
        }
        Some(self.grid.of_gyro(&ln_common))
    }

    /// Weights of the levels of a gyro, which sum to one.
    fn weights(&self, prior: &[f64], fits: &[FitAtLevel]) -> Vec<f64> {
        let pairs = prior.iter().zip(fits);
        let logs: Vec<f64> = pairs
            .map(|(prior, fit)| prior + fit.log_likelihood)
            .collect();
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = logs.iter().map(|one| exp(one - largest)).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|weight| weight / sum).collect()
    }

    /// Each of these terms beside the law of a gyro; `None` of one that the stops do not determine.
    pub(super) fn terms(
        &self,
        gyro: usize,
        laws: &[Vec<Term>],
        terms: &[Term],
    ) -> Vec<Option<TermEvidence>> {
        let (Some(prior), Some(base)) =
            (self.prior(gyro, laws), self.fits(gyro, &laws[gyro], None))
        else {
            return terms.iter().map(|_| None).collect();
        };
        let evidence = |term: &Term| {
            let fits = self.fits(gyro, &laws[gyro], Some(*term))?;
            let weights = self.weights(&prior, &fits);
            let normal = |fit: &FitAtLevel| {
                let last = fit.estimates.len() - 1;
                fit.estimates[last] / fit.covariance[(last, last)].sqrt()
            };
            let p_value = weights
                .iter()
                .zip(&fits)
                .map(|(weight, fit)| weight * two_sided_p(normal(fit)));
            let logs: Vec<f64> = (0..fits.len())
                .map(|at| prior[at] + base[at].log_likelihood + 0.5 * normal(&fits[at]).powi(2))
                .collect();
            Some(TermEvidence {
                p_value: p_value.sum(),
                log_likelihood: ln_sum(&logs),
            })
        };
        terms.iter().map(evidence).collect()
    }

    /// The law of a gyro, integrated over the levels; `None` where the stops do not determine it.
    pub(super) fn law(&self, gyro: usize, laws: &[Vec<Term>]) -> Option<LawEstimate> {
        let prior = self.prior(gyro, laws)?;
        let fits = self.fits(gyro, &laws[gyro], None)?;
        let weights = self.weights(&prior, &fits);
        let count = laws[gyro].len();
        let mut estimates = DVector::zeros(count);
        for (weight, fit) in weights.iter().zip(&fits) {
            estimates += *weight * fit.estimates.rows(0, count);
        }
        let mut covariance = DMatrix::zeros(count, count);
        for (weight, fit) in weights.iter().zip(&fits) {
            let off = fit.estimates.rows(0, count) - &estimates;
            covariance +=
                *weight * (fit.covariance.view((0, 0), (count, count)) + &off * off.transpose());
        }
        let scales = DVector::from_fn(count, |i, _| {
            let normals: Vec<[f64; 3]> = weights
                .iter()
                .zip(&fits)
                .map(|(weight, fit)| {
                    [
                        *weight,
                        fit.estimates[i] - estimates[i],
                        fit.covariance[(i, i)].sqrt(),
                    ]
                })
                .collect();
            half_width(&normals) / NORMAL_97_5 / covariance[(i, i)].sqrt()
        });
        let covariance = DMatrix::from_fn(count, count, |i, j| {
            covariance[(i, j)] * scales[i] * scales[j]
        });
        let unit = self.gyros[gyro].unit_deg_per_h;
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

impl GyroAtLevels {
    fn of(parts: &StopParts, grid: &Grid, biases: usize) -> Self {
        let columns = parts.columns(biases);
        let at = grid.levels().map(|levels: Levels| {
            // Fast noise, which each part has, keeps the covariance positive definite.
            let cholesky = Cholesky::new_unchecked(parts.covariance(levels));
            let factor = cholesky.l_dirty();
            let ln_determinant = (0..factor.nrows()).map(|i| 2.0 * ln(factor[(i, i)])).sum();
            let mut white = columns.clone();
            factor.solve_lower_triangular_unchecked_mut(&mut white);
            Gram {
                ln_determinant,
                products: white.tr_mul(&white),
            }
        });
        Self {
            terms: parts.terms.clone(),
            unit_deg_per_h: parts.unit_deg_per_h,
            at: at.collect(),
        }
    }
}

impl Gram {
    /// Fit of the rates by some columns; `None` where they are not determined.
    fn fit(&self, columns: &[usize]) -> Option<FitAtLevel> {
        let count = columns.len();
        let scales = DVector::from_fn(count, |i, _| {
            self.products[(columns[i], columns[i])].sqrt().recip()
        });
        let scaled = DMatrix::from_fn(count, count, |i, j| {
            scales[i] * self.products[(columns[i], columns[j])] * scales[j]
        });
        let cholesky = Cholesky::new(scaled)?;
        let factor = cholesky.l_dirty();
        let shares = (0..count).map(|i| factor[(i, i)] * factor[(i, i)]);
        if shares.clone().any(|share| share < LEAST_SHARE) {
            return None;
        }
        let by_rates = DVector::from_fn(count, |i, _| scales[i] * self.products[(columns[i], 0)]);
        let solution = cholesky.solve(&by_rates);
        let left = self.products[(0, 0)] - solution.dot(&by_rates);
        let ln_information: f64 =
            shares.map(ln).sum::<f64>() - 2.0 * scales.iter().map(|scale| ln(*scale)).sum::<f64>();
        let inverse = cholesky.inverse();
        Some(FitAtLevel {
            log_likelihood: -0.5 * (self.ln_determinant + ln_information + left),
            estimates: solution.component_mul(&scales),
            covariance: DMatrix::from_fn(count, count, |i, j| {
                scales[i] * inverse[(i, j)] * scales[j]
            }),
        })
    }
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

//! The restricted likelihood of the gyros' noise and its maximum.

mod eliminated;

use eliminated::Eliminated;
use gyrocal_hypothesis::RateNoiseFit;
use gyrocal_inference::{NoiseScore, Pass, Walk, Walks};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::steps::{bounded, moved, scale};
use super::{GYRO_NOISE_PRIOR_SIGMA, NO_WALK};
use crate::error::CalibrationError;
use crate::fitted_platform::several::add_score;
use crate::fitted_platform::{AXES, FittedPlatform, S_PER_H};
use crate::platform::PLATFORM;
use crate::solve::{add_gram, rows_of_unknowns};
use crate::work;

/// Most steps of Fisher's scoring. Where the noise is that of the model four suffice; one that is not shortens
/// each step by the same share, and after ten less than a unit of the log-likelihood is left.
const MAX_STEPS: usize = 10;

/// Most halvings of a step.
const MAX_HALVINGS: usize = 8;

/// Gain of the log-likelihood that a step expects below which it is not made: a likelihood ratio is
/// then good to some hundredths, and a logarithm to a fifth of its standard deviation.
const LEAST_GAIN: f64 = 0.02;

/// Precision of the logarithm of the variance of a walk that keeps a step finite where the record says
/// nothing of it.
const DAMPING: f64 = 1e-3;

/// Precision of the logarithm of the variance of a gyro's white noise before the record.
const PRIOR_PRECISION: f64 = 0.25 / (GYRO_NOISE_PRIOR_SIGMA * GYRO_NOISE_PRIOR_SIGMA);

/// Densities that an estimate starts from, over that of a walk that does over the record as much as
/// the declared white noise.
const STARTS: [f64; 3] = [3.0, 100.0, 3000.0];

/// The likelihood at one point.
pub(super) struct At {
    pub(super) value: f64,
    /// One, and the change of every unknown of the fit.
    solution: DVector<f64>,
    gradient: DVector<f64>,
    pub(super) information: DMatrix<f64>,
    /// The information that the unknowns of the fit leave: less its projection on them.
    left: DMatrix<f64>,
}

/// The unknown logarithms of variances: the white noise of each gyro over the fit's, then densities
/// of walks.
pub(super) struct Likelihood<'p, 'a> {
    pub(super) fitted: &'p FittedPlatform<'a>,
    /// Walks with the densities that factors are over.
    pub(super) walks: Vec<Walk>,
    /// Places of the walks that are unknown; the others stay.
    pub(super) free: Vec<usize>,
    /// Places of unknowns of the fit that are left out.
    pub(super) absent: &'p [usize],
    /// Gyros whose white noise is held at the declared one.
    pub(super) held: &'p [usize],
    /// Number of rows that tell of the noise, from the first.
    pub(super) rows: usize,
    /// Whether effects are integrated out as well, see [`FittedPlatform::restricted_noise`].
    pub(super) integrates_effects: bool,
}

impl Likelihood<'_, '_> {
    /// Chooses the densities that walks start from, if none are known: one for all.
    pub(super) fn start(&mut self, unit: f64) -> Result<(), CalibrationError> {
        let unknown: Vec<usize> = self
            .free
            .iter()
            .copied()
            .filter(|place| self.walks[*place].density <= NO_WALK * unit)
            .collect();
        if unknown.is_empty() {
            return Ok(());
        }
        let mut best = (f64::NEG_INFINITY, STARTS[0]);
        for start in STARTS {
            for place in &unknown {
                self.walks[*place].density = start * unit;
            }
            // From where the numbers do not suffice nothing starts.
            let Ok(value) = self.value(&vec![0.0; AXES + self.free.len()]) else {
                continue;
            };
            if value > best.0 {
                best = (value, start);
            }
        }
        for place in &unknown {
            self.walks[*place].density = best.1 * unit;
        }
        Ok(())
    }

    /// Fisher's scoring from the noise of the fit.
    pub(super) fn maximise(&self) -> Result<(DVector<f64>, At), CalibrationError> {
        self.maximise_to(LEAST_GAIN)
    }

    /// The same until a step expects less than a gain.
    pub(super) fn maximise_to(
        &self,
        least_gain: f64,
    ) -> Result<(DVector<f64>, At), CalibrationError> {
        let mut logarithms = DVector::zeros(AXES + self.free.len());
        for axis in self.held {
            logarithms[*axis] = -2.0 * self.fitted.noise.gyro_ratio[*axis].ln();
        }
        let mut at = self.at(&logarithms, None)?;
        for _ in 0..MAX_STEPS {
            let by = scale(&logarithms);
            let gradient = at.gradient.component_mul(&by);
            let information = at.left.component_mul(&(&by * by.transpose()));
            let Some(cholesky) = Cholesky::new(information) else {
                break;
            };
            let mut step = bounded(cholesky.solve(&gradient), &logarithms);
            if 0.5 * step.dot(&gradient) < least_gain {
                break;
            }
            let mut halvings = 0;
            loop {
                let next = moved(&logarithms, &step);
                // A step may lead to where the filter leaves the numbers: it was too long.
                if let Ok(found) = self.at(&next, Some(&at.solution))
                    && found.value >= at.value
                {
                    (logarithms, at) = (next, found);
                    break;
                }
                halvings += 1;
                if halvings > MAX_HALVINGS {
                    return Ok((logarithms, at));
                }
                step *= 0.5;
            }
        }
        Ok((logarithms, at))
    }

    pub(super) fn result(
        &self,
        logarithms: &DVector<f64>,
        at: &At,
    ) -> Result<RateNoiseFit, CalibrationError> {
        let sigma = Cholesky::new(at.information.clone())
            .ok_or(CalibrationError::NotPositiveDefinite)?
            .inverse()
            .diagonal()
            .map(|variance| 0.5 * variance.sqrt());
        let believed = self.fitted.rate_noise();
        let mut fit = RateNoiseFit {
            noise: believed.without_walks(),
            log_likelihood: at.value,
            white_sigma: sigma.iter().take(AXES).copied().collect(),
            walk_sigma: vec![f64::INFINITY; AXES],
        };
        for (white, logarithm) in fit.noise.white.iter_mut().zip(logarithms.iter()) {
            *white *= (0.5 * logarithm).exp();
        }
        for (index, place) in self.free.iter().enumerate() {
            let walk = self.walks[*place];
            let density = walk.density * logarithms[AXES + index].exp();
            let rates = PLATFORM.rates.iter();
            for (rate, _) in rates
                .enumerate()
                .filter(|(_, r)| r.constant == walk.parameter)
            {
                fit.noise.walk[rate] = (density * S_PER_H).sqrt();
                fit.walk_sigma[rate] = sigma[AXES + index];
            }
        }
        Ok(fit)
    }

    /// Factors of outputs, inputs and walks.
    fn factors(&self, logarithms: &[f64]) -> Vec<f64> {
        let mut factors = vec![1.0; AXES];
        factors.extend(logarithms[..AXES].iter().map(|logarithm| logarithm.exp()));
        let walks = (0..self.walks.len()).map(|place| {
            let unknown = self.free.iter().position(|free| *free == place);
            unknown.map_or(1.0, |unknown| logarithms[AXES + unknown].exp())
        });
        factors.extend(walks);
        factors
    }

    /// The score of the rows of all records, with Gram matrices of the unknowns of the fit. `first` is the
    /// first factor whose derivatives are wanted. The information is that at a `solution` of the unknowns.
    fn score(
        &self,
        factors: &[f64],
        first: usize,
        solution: Option<&DVector<f64>>,
    ) -> Result<NoiseScore, CalibrationError> {
        let problem = &self.fitted.problem;
        let mut total = None;
        for (run, rows) in self.fitted.record_rows().into_iter().enumerate() {
            let count = self.rows.clamp(rows.start, rows.end) - rows.start;
            if count == 0 && run > 0 {
                break;
            }
            let leg = &problem.runs[run];
            let changes = if self.walks.len() == leg.walks.len() {
                &leg.walk_changes[..]
            } else {
                &[]
            };
            let parameters = problem.parameters(run);
            let columns = leg.column_unknowns();
            let change: Vec<f64> = solution.map_or_else(Vec::new, |solution| {
                let of_column = |unknowns: &&[usize]| {
                    let unknowns = unknowns.iter();
                    unknowns.map(|unknown| solution[unknown + 1]).sum()
                };
                columns.iter().map(of_column).collect()
            });
            let mut score = problem
                .with_first_rows(run, &parameters, count, |linearised| {
                    work::differentiate((2 * AXES + self.walks.len()).saturating_sub(first));
                    Pass {
                        walks: Walks {
                            walks: &self.walks,
                            changes,
                        },
                        factors,
                        ..linearised.on(self.fitted.kept(run))
                    }
                    .noise_score_of_columns(first, &change)
                })
                .map_err(|error| CalibrationError::pass(run, error))?;
            score.with_rows = rows_of_unknowns(&score.with_rows, &columns, problem.unknowns.len());
            score.gram = self.gram(&score.gram, &columns);
            for own in &mut score.d_gram {
                *own = self.gram(own, &columns);
            }
            add_score(&mut total, score);
        }
        total.ok_or(CalibrationError::NoRecords)
    }

    pub(super) fn value(&self, logarithms: &[f64]) -> Result<f64, CalibrationError> {
        let score = self.score(&self.factors(logarithms), usize::MAX, None)?;
        Ok(self.restricted(&score, logarithms)?.value)
    }

    /// The likelihood and its derivatives, with the information at a `solution` of the unknowns.
    fn at(
        &self,
        logarithms: &DVector<f64>,
        solution: Option<&DVector<f64>>,
    ) -> Result<At, CalibrationError> {
        let score = self.score(&self.factors(logarithms.as_slice()), AXES, solution)?;
        let eliminated = self.restricted(&score, logarithms.as_slice())?;
        let left = self.left(&score, &eliminated);
        let Eliminated {
            value,
            solution,
            inverse,
            ..
        } = eliminated;
        let unknowns = self.unknowns();
        let integrated = self.integrated();
        let believed = self.fitted.noise.gyro_ratio;
        let mut gradient = DVector::zeros(unknowns.len());
        for (index, unknown) in unknowns.iter().enumerate() {
            let gram = &score.d_gram[*unknown];
            let squares = (gram * &solution).dot(&solution);
            let places: Vec<usize> = integrated.iter().map(|place| place + 1).collect();
            let determinant = gram
                .select_rows(&places)
                .select_columns(&places)
                .component_mul(&inverse)
                .sum();
            gradient[index] = -0.5 * (score.d_log_variance[*unknown] + squares + determinant);
            if index < AXES {
                let off = logarithms[index] + 2.0 * believed[index].ln();
                gradient[index] -= PRIOR_PRECISION * off;
            }
        }
        for axis in self.held {
            gradient[*axis] = 0.0;
        }
        Ok(At {
            value,
            solution,
            gradient,
            information: self.information(&score),
            left,
        })
    }

    /// Places of the unknowns in a score, after the noise of the outputs: inputs, walks.
    fn unknowns(&self) -> Vec<usize> {
        (AXES..2 * AXES)
            .chain(self.free.iter().map(|place| 2 * AXES + place))
            .collect()
    }

    /// Fisher's information on the unknowns, with the prior.
    fn information(&self, score: &NoiseScore) -> DMatrix<f64> {
        let unknowns = self.unknowns();
        let stride = score.d_log_variance.len();
        let mut information = DMatrix::from_fn(unknowns.len(), unknowns.len(), |i, j| {
            score.information[unknowns[i] * stride + unknowns[j]]
        });
        for index in 0..unknowns.len() {
            information[(index, index)] += if index < AXES {
                PRIOR_PRECISION
            } else {
                DAMPING
            };
        }
        for axis in self.held {
            information.row_mut(*axis).fill(0.0);
            information.column_mut(*axis).fill(0.0);
            information[(*axis, *axis)] = 1.0;
        }
        information
    }

    /// Information on the unknown noise at the noise of the fit, and the derivatives of the information on
    /// the unknowns of the fit by each of its logarithms.
    pub(super) fn at_fit(&self) -> Result<(DMatrix<f64>, Vec<DMatrix<f64>>), CalibrationError> {
        let factors = self.factors(&vec![0.0; AXES + self.free.len()]);
        let score = self.score(&factors, AXES, None)?;
        let count = self.fitted.problem.unknowns.len();
        let derivative = |unknown: &usize| {
            let gram = &score.d_gram[*unknown];
            gram.view((1, 1), (count, count)).into_owned()
        };
        let derivatives = self.unknowns().iter().map(derivative).collect();
        Ok((self.information(&score), derivatives))
    }

    /// Gram matrix of the unknowns of the fit from that of the columns of a pass.
    fn gram(&self, of_columns: &DMatrix<f64>, columns: &[&[usize]]) -> DMatrix<f64> {
        let count = self.fitted.problem.unknowns.len();
        let mut gram = DMatrix::zeros(count + 1, count + 1);
        add_gram(&mut gram, of_columns, columns);
        gram
    }
}

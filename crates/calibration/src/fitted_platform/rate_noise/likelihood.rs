//! The restricted likelihood of the gyros' noise and its maximum.

use gyrocal_hypothesis::RateNoiseFit;
use gyrocal_inference::{
    Asked, FurtherNoise, NoiseScore, Pass, Restricted, RestrictedAt, UnknownNoise, Walk, Walks,
};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::{GYRO_NOISE_PRIOR_SIGMA, NO_WALK};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fitted_platform::several::add_score;
use crate::fitted_platform::{AXES, FittedPlatform, S_PER_H};
use crate::platform::PLATFORM;
use crate::solve::{add_gram, rows_of_unknowns};
use crate::work;

/// Most steps of Fisher's scoring. Where the noise is that of the model four suffice; one that is not shortens
/// each step by the same share, and after ten less than a unit of the log-likelihood is left.
const MAX_STEPS: usize = 10;

/// Gain of the log-likelihood that a step expects below which it is not made: a likelihood ratio is
/// then good to some hundredths, and a logarithm to a fifth of its standard deviation.
const LEAST_GAIN: f64 = 0.02;

/// Precision of the logarithm of the variance of a gyro's white noise before the record.
const PRIOR_PRECISION: f64 = 0.25 / (GYRO_NOISE_PRIOR_SIGMA * GYRO_NOISE_PRIOR_SIGMA);

/// Densities that an estimate starts from, over that of a walk that does over the record as much as
/// the declared white noise.
const STARTS: [f64; 3] = [3.0, 100.0, 3000.0];

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
    pub(super) fn maximise(&self) -> Result<(DVector<f64>, RestrictedAt), CalibrationError> {
        self.maximise_to(LEAST_GAIN)
    }

    /// The same until a step expects less than a gain.
    pub(super) fn maximise_to(
        &self,
        least_gain: f64,
    ) -> Result<(DVector<f64>, RestrictedAt), CalibrationError> {
        let mut start = DVector::zeros(AXES + self.free.len());
        for axis in self.held {
            start[*axis] = -2.0 * self.fitted.noise.gyro_ratio[*axis].ln();
        }
        let mut score = |asked: Asked<'_>| self.score(asked);
        self.with_restricted(|restricted| {
            restricted.maximise(start, (least_gain, MAX_STEPS), &mut score)
        })
    }

    /// The unknowns of the fit and of the noise.
    fn with_restricted<R>(&self, of: impl FnOnce(&Restricted<'_>) -> R) -> R {
        let fitted = self.fitted;
        let unknowns = &fitted.problem.unknowns;
        let sigmas: Vec<f64> = unknowns.iter().map(|unknown| unknown.sigma).collect();
        let first = if self.integrates_effects {
            fitted.shared
        } else {
            PARAMETERS + fitted.nuisances()
        };
        let gyros = (0..AXES).map(|axis| {
            let believed = fitted.noise.gyro_ratio[axis];
            UnknownNoise {
                factor: AXES + axis,
                prior: Some((-2.0 * believed.ln(), PRIOR_PRECISION)),
                is_held: self.held.contains(&axis),
            }
        });
        let walks = self.free.iter().map(|place| UnknownNoise {
            factor: 2 * AXES + place,
            prior: None,
            is_held: false,
        });
        of(&Restricted {
            values: &fitted.problem.values,
            sigmas: &sigmas,
            // Coefficients, what the bench declares uncertain, and the offsets of each turn-on; all, if effects
            // are.
            integrated: (0..first).chain(fitted.shared..unknowns.len()).collect(),
            absent: self.absent,
            noises: gyros.chain(walks).collect(),
        })
    }

    pub(super) fn result(
        &self,
        logarithms: &DVector<f64>,
        at: &RestrictedAt,
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

    /// The score of the rows of all records, with Gram matrices of the unknowns of the fit.
    fn score(&self, asked: Asked<'_>) -> Result<NoiseScore, CalibrationError> {
        let factors = self.factors(asked.logarithms);
        let first = if asked.with_derivatives {
            AXES
        } else {
            usize::MAX
        };
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
            let change: Vec<f64> = asked.changes.map_or_else(Vec::new, |changes| {
                let of_column = |unknowns: &&[usize]| {
                    let unknowns = unknowns.iter();
                    unknowns.map(|unknown| changes[*unknown]).sum()
                };
                columns.iter().map(of_column).collect()
            });
            let mut score = problem
                .with_first_rows(run, &parameters, count, |linearised| {
                    work::differentiate((2 * AXES + self.walks.len()).saturating_sub(first));
                    Pass {
                        further: FurtherNoise {
                            walks: Walks {
                                walks: &self.walks,
                                changes,
                            },
                            ..FurtherNoise::default()
                        },
                        factors: &factors,
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
        let mut score = |asked: Asked<'_>| self.score(asked);
        self.with_restricted(|restricted| restricted.value(logarithms, &mut score))
    }

    /// Information on the unknown noise at the noise of the fit, and the derivatives of the information on
    /// the unknowns of the fit by each of its logarithms.
    pub(super) fn at_fit(&self) -> Result<(DMatrix<f64>, Vec<DMatrix<f64>>), CalibrationError> {
        let score = self.score(Asked {
            logarithms: &vec![0.0; AXES + self.free.len()],
            with_derivatives: true,
            changes: None,
        })?;
        let count = self.fitted.problem.unknowns.len();
        let derivative = |noise: &UnknownNoise| {
            let gram = &score.d_gram[noise.factor];
            gram.view((1, 1), (count, count)).into_owned()
        };
        self.with_restricted(|restricted| {
            let derivatives = restricted.noises.iter().map(derivative).collect();
            Ok((restricted.information(&score), derivatives))
        })
    }

    /// Gram matrix of the unknowns of the fit from that of the columns of a pass.
    fn gram(&self, of_columns: &DMatrix<f64>, columns: &[&[usize]]) -> DMatrix<f64> {
        let count = self.fitted.problem.unknowns.len();
        let mut gram = DMatrix::zeros(count + 1, count + 1);
        add_gram(&mut gram, of_columns, columns);
        gram
    }
}

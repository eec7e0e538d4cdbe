//! Noise at the largest restricted likelihood: initial states and nominal parameters integrated out, sizes of
//! effects at their best.

mod all;
mod needed;

pub(crate) use all::is_needed;

use gyrocal_inference::{Asked, Column, Maximum, NoiseScore, Reduced, Restricted, UnknownNoise};
use gyrocal_statistics::math::{exp, ln};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;
use crate::linearised::{Linearised, reduce};
use crate::problem::Problem;

/// Standard deviation of the logarithm of a noise over the declared one before a record.
pub(crate) const PRIOR_SIGMA: f64 = 1.0;

/// Precision of the logarithm of its variance.
const PRIOR_PRECISION: f64 = 0.25 / (PRIOR_SIGMA * PRIOR_SIGMA);

/// Most steps of Fisher's scoring.
const MAX_STEPS: usize = 20;

/// Gain of the log-likelihood that a step expects below which it is not made: a likelihood ratio is then
/// good to a thousandth.
const LEAST_GAIN: f64 = 5e-4;

/// Least variance of a noise that the plant does not declare, over that which the record could just show.
const ABSENT: f64 = 1e-3;

/// Noise of a fit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoiseFit {
    pub(crate) noise: FittedNoise,
    /// Standard deviations of the logarithms of the sizes of all noises.
    pub(crate) sigmas: Vec<f64>,
    pub(crate) log_likelihood: f64,
}

/// The largest likelihood by the sizes of noises.
struct Found {
    logarithms: DVector<f64>,
    /// Of their errors; `None` where the curvature is none of a maximum.
    covariance: Option<DMatrix<f64>>,
    value: f64,
}

/// A fit whose noise is unknown.
pub(crate) struct NoiseProblem<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) lin: &'a Linearised,
    pub(crate) lines: &'a [Column],
    pub(crate) sigmas: &'a [f64],
    pub(crate) values: &'a [f64],
    /// States along the trajectory, by rows.
    pub(crate) points: &'a [f64],
    /// Places of unknowns that the model shall not have.
    pub(crate) absent: &'a [usize],
}

impl NoiseProblem<'_> {
    /// The largest likelihood by the sizes, from these; noises in `held` stay.
    pub(crate) fn sizes(
        &self,
        start: &FittedNoise,
        held: &[usize],
    ) -> Result<NoiseFit, PlantError> {
        self.maximum(start, held, |found, _| {
            let sigma = |i: usize| {
                let own = found
                    .covariance
                    .as_ref()
                    .map(|own| 0.5 * own[(i, i)].sqrt());
                own.unwrap_or(PRIOR_SIGMA)
            };
            NoiseFit {
                noise: FittedNoise {
                    factors: factors(found.logarithms.as_slice(), start.declared()),
                    ..start.clone()
                },
                sigmas: (0..start.factors.len()).map(sigma).collect(),
                log_likelihood: found.value,
            }
        })
    }

    /// The sizes of the declared noises at the largest likelihood, each with its 95 % interval by the profile of that.
    pub(crate) fn intervals(&self, start: &FittedNoise) -> Result<Vec<[f64; 3]>, PlantError> {
        self.maximum(start, &[], |found, profile| {
            let level = |place: usize| {
                let ratio = exp(0.5 * found.logarithms[place]);
                let Some(covariance) = &found.covariance else {
                    return [ratio, 0.0, f64::MAX];
                };
                let maximum = Maximum {
                    logarithms: &found.logarithms,
                    covariance,
                    value: found.value,
                };
                let [low, high] = maximum.sizes(place, &mut |moved| profile(place, moved[place]));
                [ratio, low, high]
            };
            (0..start.declared()).map(level).collect()
        })
    }

    /// Goes to the largest likelihood by the sizes; `then` has it, and the largest where one logarithm is another.
    fn maximum<R>(
        &self,
        start: &FittedNoise,
        held: &[usize],
        then: impl FnOnce(&Found, &mut dyn FnMut(usize, f64) -> Option<f64>) -> R,
    ) -> Result<R, PlantError> {
        let problem = self.problem;
        let count = self.values.len();
        let nominal = problem.nominal().min(count);
        let later = count.saturating_sub(problem.later()).max(nominal);
        let (all, declared) = (start.factors.len(), start.declared());
        let noises = (0..all).map(|factor| UnknownNoise {
            factor,
            prior: (factor < declared).then_some((0.0, PRIOR_PRECISION)),
            is_held: held.contains(&factor),
        });
        let restricted = Restricted {
            values: self.values,
            sigmas: self.sigmas,
            integrated: (0..nominal).chain(later..count).collect(),
            absent: self.absent,
            noises: noises.collect(),
        };
        let first = DVector::from_iterator(all, start.factors.iter().map(|factor| ln(*factor)));
        let by_output = if start.is_declared() {
            self.by_output()?
        } else {
            None
        };
        let mut score = |asked: Asked<'_>| match &by_output {
            Some(outputs) => Ok(of_outputs(outputs, asked.logarithms)),
            None => self.score(start, asked),
        };
        let (logarithms, at) = restricted.maximise(first, (LEAST_GAIN, MAX_STEPS), &mut score)?;
        // Of white noise of one output twice the information is its degrees of freedom.
        let mut left = at.left;
        let outputs = self.lin.rows.layout.outputs;
        for (output, determinant) in at.determinants.iter().enumerate().take(outputs) {
            left[(output, output)] += 0.5 * determinant;
        }
        let found = Found {
            logarithms,
            covariance: Cholesky::new(left).map(|cholesky| cholesky.inverse()),
            value: at.value,
        };
        let mut profile = |place: usize, logarithm: f64| {
            let mut others = restricted.clone();
            others.noises[place].is_held = true;
            let mut start = found.logarithms.clone();
            start[place] = logarithm;
            let there = others.maximise(start, (LEAST_GAIN, MAX_STEPS), &mut score);
            there.ok().map(|(_, there)| there.value)
        };
        Ok(then(&found, &mut profile))
    }

    fn score(&self, start: &FittedNoise, asked: Asked<'_>) -> Result<NoiseScore, PlantError> {
        let noise = FittedNoise {
            factors: asked.logarithms.iter().map(|one| exp(*one)).collect(),
            ..start.clone()
        };
        let first = if asked.with_derivatives {
            0
        } else {
            usize::MAX
        };
        let pass = self.lin.pass(&noise, self.lines);
        Ok(pass.noise_score_of_columns(first, asked.changes.unwrap_or_default())?)
    }

    /// Without noise of the rates each output has a Gram matrix of its own, at the declared noise.
    fn by_output(&self) -> Result<Option<Vec<Reduced>>, PlantError> {
        if self.lin.rows.layout.noises > 0 {
            return Ok(None);
        }
        let outputs = self.lin.rows.layout.outputs;
        let noise = self.problem.declared_noise();
        let all = (0..outputs).map(|output| {
            let mut only = self.lin.clone();
            for (place, residual) in only.rows.residuals.iter_mut().enumerate() {
                if place % outputs != output {
                    *residual = f64::NAN;
                }
            }
            reduce(&only.pass(&noise, self.lines))
        });
        all.collect::<Result<_, _>>().map(Some)
    }
}

/// Factors of the variances. What the plant does not declare may be absent: it then stays at its least size, from
/// which it can come back.
fn factors(logarithms: &[f64], declared: usize) -> Vec<f64> {
    let all = logarithms.iter().enumerate();
    all.map(|(place, one)| match exp(*one) {
        factor if place < declared => factor,
        factor => factor.max(ABSENT),
    })
    .collect()
}

/// The score from the Gram matrices of all outputs.
fn of_outputs(outputs: &[Reduced], logarithms: &[f64]) -> NoiseScore {
    let count = outputs.len();
    let size = outputs.first().map_or(1, |one| one.gram.nrows());
    let mut score = NoiseScore {
        values: 0,
        log_variance: 0.0,
        d_log_variance: Vec::with_capacity(count),
        gram: DMatrix::zeros(size, size),
        d_gram: Vec::with_capacity(count),
        information: vec![0.0; count * count],
        with_rows: vec![0.0; count * size],
    };
    for (index, (own, logarithm)) in outputs.iter().zip(logarithms).enumerate() {
        let values = own.values as f64;
        let gram = &own.gram * exp(-logarithm);
        score.values += own.values;
        score.log_variance += own.log_variance + values * logarithm;
        score.d_log_variance.push(values);
        score.information[index * count + index] = 0.5 * values;
        score.gram += &gram;
        score.d_gram.push(-gram);
    }
    score
}

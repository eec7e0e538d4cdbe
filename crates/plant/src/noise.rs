//! Noise at the largest restricted likelihood (Patterson, Thompson, Biometrika 58, 545, 1971): initial
//! states and nominal parameters integrated out, sizes of effects at their best.

use gyrocal_inference::{Column, Reduced};
use gyrocal_statistics::math::{exp, ln};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::dynamics::{Linearised, reduce};
use crate::error::PlantError;
use crate::problem::Problem;

/// Standard deviation of the logarithm of a noise over the declared one before a record.
pub(crate) const PRIOR_SIGMA: f64 = 1.0;

/// Most Newton steps.
const MAX_STEPS: usize = 20;

/// Longest of them, in the logarithm of a standard deviation.
const LONGEST: f64 = 1.0;

/// Most halvings of one.
const MAX_HALVINGS: usize = 8;

/// Gain of the log-likelihood that a step expects below which it is the last: a likelihood ratio is then
/// good to a thousandth.
const LEAST_GAIN: f64 = 5e-4;

/// Distance of the points that derivatives are taken from, in the logarithm of a standard deviation.
const DISTANCE: f64 = 0.01;

/// Noise of a fit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoiseFit {
    /// Standard deviations over the declared ones: outputs, then noises of rates.
    pub(crate) ratios: Vec<f64>,
    /// Standard deviations of their logarithms.
    pub(crate) sigmas: Vec<f64>,
    pub(crate) log_likelihood: f64,
}

/// The restricted likelihood about a fit.
pub(crate) struct Restricted<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) lin: &'a Linearised,
    pub(crate) lines: &'a [Column],
    pub(crate) sigmas: &'a [f64],
    pub(crate) values: &'a [f64],
    /// Places of unknowns that the model shall not have.
    pub(crate) absent: &'a [usize],
    /// Without noise of the rates each output has a Gram matrix of its own, at the declared noise.
    by_output: Vec<Reduced>,
}

impl<'a> Restricted<'a> {
    pub(crate) fn new(
        problem: &'a Problem,
        lin: &'a Linearised,
        (lines, sigmas): (&'a [Column], &'a [f64]),
        (values, absent): (&'a [f64], &'a [usize]),
    ) -> Result<Self, PlantError> {
        let mut by_output = Vec::new();
        if problem.plant.description.noises.is_empty() {
            let noise = problem.noise(&vec![1.0; problem.noises()]);
            let outputs = lin.rows.layout.outputs;
            for output in 0..outputs {
                let mut only = lin.clone();
                for (place, residual) in only.rows.residuals.iter_mut().enumerate() {
                    if place % outputs != output {
                        *residual = f64::NAN;
                    }
                }
                by_output.push(reduce(&only.pass(&noise, lines))?);
            }
        }
        Ok(Self {
            problem,
            lin,
            lines,
            sigmas,
            values,
            absent,
            by_output,
        })
    }

    /// The largest likelihood, from these ratios.
    pub(crate) fn maximise(&self, ratios: &[f64]) -> Result<NoiseFit, PlantError> {
        let count = ratios.len();
        let mut at = DVector::from_iterator(count, ratios.iter().map(|ratio| ln(*ratio)));
        let mut value = self.value(&at)?;
        let mut information = DMatrix::identity(count, count);
        for _ in 0..MAX_STEPS {
            let (gradient, curvature) = self.derivatives(&at, value)?;
            information = curvature;
            let mut step = newton(&information, &gradient);
            let longest = step.amax();
            if longest > LONGEST {
                step *= LONGEST / longest;
            }
            let gain = 0.5 * step.dot(&gradient);
            let mut halvings = 0;
            loop {
                let next = &at + &step;
                if let Ok(moved) = self.value(&next)
                    && moved >= value
                {
                    (at, value) = (next, moved);
                    break;
                }
                halvings += 1;
                if halvings > MAX_HALVINGS {
                    break;
                }
                step *= 0.5;
            }
            if gain < LEAST_GAIN || halvings > MAX_HALVINGS {
                break;
            }
        }
        let inverse = Cholesky::new(information).map(|cholesky| cholesky.inverse());
        let sigma = |i: usize| {
            let own = inverse.as_ref().map(|inverse| inverse[(i, i)].sqrt());
            own.unwrap_or(PRIOR_SIGMA)
        };
        Ok(NoiseFit {
            ratios: at.iter().map(|logarithm| exp(*logarithm)).collect(),
            sigmas: (0..count).map(sigma).collect(),
            log_likelihood: value,
        })
    }

    /// Gradient, and minus the second derivatives.
    fn derivatives(
        &self,
        at: &DVector<f64>,
        value: f64,
    ) -> Result<(DVector<f64>, DMatrix<f64>), PlantError> {
        let count = at.len();
        let moved = |changes: &[(usize, f64)]| {
            let mut next = at.clone();
            for (index, change) in changes {
                next[*index] += change * DISTANCE;
            }
            self.value(&next)
        };
        let mut gradient = DVector::zeros(count);
        let mut above = vec![0.0; count];
        let mut information = DMatrix::zeros(count, count);
        for i in 0..count {
            above[i] = moved(&[(i, 1.0)])?;
            let below = moved(&[(i, -1.0)])?;
            gradient[i] = (above[i] - below) / (2.0 * DISTANCE);
            information[(i, i)] = (2.0 * value - above[i] - below) / (DISTANCE * DISTANCE);
        }
        for i in 0..count {
            for j in 0..i {
                let both = moved(&[(i, 1.0), (j, 1.0)])?;
                let own = -(both - above[i] - above[j] + value) / (DISTANCE * DISTANCE);
                information[(i, j)] = own;
                information[(j, i)] = own;
            }
        }
        Ok((gradient, information))
    }

    /// Logarithm of the likelihood at logarithms of ratios.
    fn value(&self, logarithms: &DVector<f64>) -> Result<f64, PlantError> {
        let ratios: Vec<f64> = logarithms.iter().map(|one| exp(*one)).collect();
        let (gram, log_variance) = self.gram(&ratios)?;
        let count = self.values.len();
        let mut solution = DVector::zeros(count + 1);
        solution[0] = 1.0;
        for place in self.absent {
            solution[place + 1] = -self.values[*place];
        }
        let present: Vec<usize> = (0..count)
            .filter(|place| !self.absent.contains(place))
            .collect();
        let weight = |place: usize| self.sigmas[place].powi(-2);
        let pull = &gram * &solution;
        let mut cost = solution.dot(&pull);
        let gradient = DVector::from_fn(present.len(), |i, _| {
            let place = present[i];
            -pull[place + 1] - weight(place) * self.values[place]
        });
        let mut inner = DMatrix::from_fn(present.len(), present.len(), |i, j| {
            gram[(present[i] + 1, present[j] + 1)]
        });
        for (i, place) in present.iter().enumerate() {
            inner[(i, i)] += weight(*place);
            cost += weight(*place) * self.values[*place].powi(2);
        }
        let nominal = self.problem.nominal().min(present.len());
        let later = present.len().saturating_sub(self.problem.later());
        let integrated: Vec<usize> = (0..nominal)
            .chain(later.max(nominal)..present.len())
            .collect();
        let own = inner.select_rows(&integrated).select_columns(&integrated);
        let cholesky = Cholesky::new(inner).ok_or(PlantError::Singular)?;
        cost -= cholesky.solve(&gradient).dot(&gradient);
        let own = Cholesky::new(own).ok_or(PlantError::Singular)?;
        let determinant: f64 = own.l().diagonal().iter().map(|x| 2.0 * ln(*x)).sum();
        let of_noise: f64 = logarithms
            .iter()
            .map(|one| (one / PRIOR_SIGMA).powi(2))
            .sum();
        Ok(-0.5 * (log_variance + determinant + cost + of_noise))
    }

    /// Gram matrix, and the sum of the logarithms of the variances of the innovations.
    fn gram(&self, ratios: &[f64]) -> Result<(DMatrix<f64>, f64), PlantError> {
        if self.by_output.is_empty() {
            let noise = self.problem.noise(ratios);
            let reduced = reduce(&self.lin.pass(&noise, self.lines))?;
            return Ok((reduced.gram, reduced.log_variance));
        }
        let size = self.lines.len() + 1;
        let (mut gram, mut log_variance) = (DMatrix::zeros(size, size), 0.0);
        for (own, ratio) in self.by_output.iter().zip(ratios) {
            gram += &own.gram / (ratio * ratio);
            log_variance += own.log_variance + 2.0 * own.values as f64 * ln(*ratio);
        }
        Ok((gram, log_variance))
    }
}

/// A Newton step, or one along the gradient where the likelihood is not concave.
fn newton(information: &DMatrix<f64>, gradient: &DVector<f64>) -> DVector<f64> {
    match Cholesky::new(information.clone()) {
        Some(cholesky) => cholesky.solve(gradient),
        None => gradient / gradient.amax().max(1.0),
    }
}

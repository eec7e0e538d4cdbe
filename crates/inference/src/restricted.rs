//! The restricted likelihood of noise about a fit (Patterson, Thompson, Biometrika 58, 545, 1971): some unknowns
//! of the fit integrated out, the others at their best.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::error::Singular;
use crate::noise::NoiseScore;

/// Most halvings of a step.
const MAX_HALVINGS: usize = 8;

/// Precision of the logarithm of a variance without a prior that keeps a step finite where the record says
/// nothing of it.
const DAMPING: f64 = 1e-3;

/// Largest step in the logarithm of one variance.
const LARGEST_STEP: f64 = 2.5;

/// Smallest share of the size of a noise that may be absent that a step leaves: a hundredth of its variance.
const SMALLEST_SHARE: f64 = 0.1;

/// An unknown noise. Its unknown is the logarithm of a factor of its declared variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnknownNoise {
    /// Place among the factors of a pass.
    pub factor: usize,
    /// Logarithm before the record and the precision of that; `None` if nothing is known. The likelihood is even in
    /// the size of such a noise, so that one that is not there is found where its size is zero, and not at the end
    /// of a long way down in its logarithm: steps are in the size.
    pub prior: Option<(f64, f64)>,
    /// Whether it stays where the search starts.
    pub is_held: bool,
}

/// The unknowns of a fit, and which noises are unknown.
#[derive(Clone, Debug)]
pub struct Restricted<'a> {
    /// Value of each unknown of the fit.
    pub values: &'a [f64],
    /// Its standard deviation before the record, about zero.
    pub sigmas: &'a [f64],
    /// Places of those that are integrated out.
    pub integrated: Vec<usize>,
    /// Places of those that the model shall not have.
    pub absent: &'a [usize],
    /// The noises.
    pub noises: Vec<UnknownNoise>,
}

/// The likelihood at one noise.
#[derive(Clone, Debug)]
pub struct RestrictedAt {
    /// Logarithm of the likelihood, with the priors of the noise.
    pub value: f64,
    /// One, and the change of every unknown of the fit.
    solution: DVector<f64>,
    gradient: DVector<f64>,
    /// Information on the logarithms with the unknowns of the fit known, and with their priors.
    pub information: DMatrix<f64>,
    /// What of it the unknowns of the fit leave.
    pub left: DMatrix<f64>,
    /// For each noise the derivative of the logarithm of the determinant of the information on what is integrated
    /// out: of the noise of an output minus the degrees of freedom that this takes.
    pub determinants: Vec<f64>,
}

/// What a score is asked for: the factors' logarithms of the unknown noises, whether derivatives are wanted, and
/// the solution of the unknowns where the information is taken.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// Logarithms of the factors of the unknown noises.
    pub logarithms: &'a [f64],
    /// Whether derivatives are wanted.
    pub with_derivatives: bool,
    /// Changes of the unknowns of the fit, if they are known.
    pub changes: Option<&'a [f64]>,
}

/// The unknowns of the fit at one noise.
struct Eliminated {
    value: f64,
    solution: DVector<f64>,
    /// The unknowns that the model has, and the factor of their information.
    present: Vec<usize>,
    cholesky: Cholesky<f64, Dyn>,
    /// The inverse information of those that are integrated out, and their places.
    inverse: DMatrix<f64>,
    integrated: Vec<usize>,
}

impl Restricted<'_> {
    /// Fisher's scoring from some logarithms, until a step expects less than a gain. `score` has columns of the
    /// unknowns of the fit.
    ///
    /// # Errors
    /// Those of `score`, and [`Singular`] at the start.
    pub fn maximise<E: From<Singular>>(
        &self,
        start: DVector<f64>,
        (least_gain, most_steps): (f64, usize),
        score: &mut dyn FnMut(Asked<'_>) -> Result<NoiseScore, E>,
    ) -> Result<(DVector<f64>, RestrictedAt), E> {
        let mut logarithms = start;
        let mut at = self.at(&logarithms, None, score)?;
        for _ in 0..most_steps {
            let by = self.scale(&logarithms);
            let gradient = at.gradient.component_mul(&by);
            let information = at.left.component_mul(&(&by * by.transpose()));
            let Some(cholesky) = Cholesky::new(information) else {
                break;
            };
            let mut step = self.bounded(cholesky.solve(&gradient), &logarithms);
            if 0.5 * step.dot(&gradient) < least_gain {
                break;
            }
            let mut halvings = 0;
            loop {
                let next = self.moved(&logarithms, &step);
                // A step may lead to where the filter leaves the numbers: it was too long.
                if let Ok(found) = self.at(&next, Some(&at.solution.as_slice()[1..]), score)
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

    /// The logarithm of the likelihood.
    ///
    /// # Errors
    /// Those of `score`, and [`Singular`].
    pub fn value<E: From<Singular>>(
        &self,
        logarithms: &[f64],
        score: &mut dyn FnMut(Asked<'_>) -> Result<NoiseScore, E>,
    ) -> Result<f64, E> {
        let score = score(Asked {
            logarithms,
            with_derivatives: false,
            changes: None,
        })?;
        Ok(self.eliminated(&score, logarithms)?.value)
    }

    fn at<E: From<Singular>>(
        &self,
        logarithms: &DVector<f64>,
        changes: Option<&[f64]>,
        score: &mut dyn FnMut(Asked<'_>) -> Result<NoiseScore, E>,
    ) -> Result<RestrictedAt, E> {
        let score = score(Asked {
            logarithms: logarithms.as_slice(),
            with_derivatives: true,
            changes,
        })?;
        let eliminated = self.eliminated(&score, logarithms.as_slice())?;
        let determinant = |noise: &UnknownNoise| {
            let gram = &score.d_gram[noise.factor];
            let mut sum = 0.0;
            for (i, one) in eliminated.integrated.iter().enumerate() {
                for (j, other) in eliminated.integrated.iter().enumerate() {
                    sum += gram[(one + 1, other + 1)] * eliminated.inverse[(i, j)];
                }
            }
            sum
        };
        let determinants: Vec<f64> = self.noises.iter().map(determinant).collect();
        let gradient = DVector::from_fn(self.noises.len(), |index, _| {
            let noise = &self.noises[index];
            if noise.is_held {
                return 0.0;
            }
            let gram = &score.d_gram[noise.factor];
            let squares = (gram * &eliminated.solution).dot(&eliminated.solution);
            let of_prior = noise.prior.map_or(0.0, |(mean, precision)| {
                precision * (logarithms[index] - mean)
            });
            let sums = score.d_log_variance[noise.factor] + squares + determinants[index];
            -0.5 * sums - of_prior
        });
        let information = self.information(&score);
        Ok(RestrictedAt {
            value: eliminated.value,
            determinants,
            gradient,
            left: &information - self.along(&score, &eliminated),
            solution: eliminated.solution,
            information,
        })
    }

    /// Fisher's information on the logarithms of the unknown noises, the unknowns of the fit known, with priors.
    #[must_use]
    pub fn information(&self, score: &NoiseScore) -> DMatrix<f64> {
        let stride = score.d_log_variance.len();
        let noises = &self.noises;
        DMatrix::from_fn(noises.len(), noises.len(), |i, j| {
            if noises[i].is_held || noises[j].is_held {
                return f64::from(u8::from(i == j));
            }
            let own = score.information[noises[i].factor * stride + noises[j].factor];
            let prior = noises[i].prior.map_or(DAMPING, |(_, precision)| precision);
            own + if i == j { prior } else { 0.0 }
        })
    }

    /// The information that the unknowns of the fit take.
    fn along(&self, score: &NoiseScore, eliminated: &Eliminated) -> DMatrix<f64> {
        let stride = self.values.len() + 1;
        let present = &eliminated.present;
        let mut along = DMatrix::from_fn(present.len(), self.noises.len(), |i, index| {
            let noise = &self.noises[index];
            if noise.is_held {
                return 0.0;
            }
            score.with_rows[noise.factor * stride + present[i] + 1]
        });
        eliminated
            .cholesky
            .l_dirty()
            .solve_lower_triangular_mut(&mut along);
        along.tr_mul(&along)
    }

    /// The logarithm of the restricted likelihood with the priors, and the unknowns of the fit there.
    fn eliminated(&self, score: &NoiseScore, logarithms: &[f64]) -> Result<Eliminated, Singular> {
        let gram = &score.gram;
        let count = self.values.len();
        let weight = |place: usize| self.sigmas[place].powi(-2);
        let is_integrated = |place: &usize| self.integrated.contains(place);
        // The rows may end before the onset of an effect.
        let is_told = |place: usize| gram[(place + 1, place + 1)] + weight(place) > 0.0;
        let present: Vec<usize> = (0..count)
            .filter(|place| !self.absent.contains(place))
            .filter(|place| is_integrated(place) || is_told(*place))
            .collect();
        let mut solution = DVector::zeros(count + 1);
        solution[0] = 1.0;
        for place in self.absent {
            solution[place + 1] = -self.values[*place];
        }
        let pull = gram * &solution;
        let gradient = DVector::from_fn(present.len(), |i, _| {
            let place = present[i];
            -pull[place + 1] - weight(place) * self.values[place]
        });
        let mut inner = DMatrix::from_fn(present.len(), present.len(), |i, j| {
            gram[(present[i] + 1, present[j] + 1)]
        });
        for (i, place) in present.iter().enumerate() {
            inner[(i, i)] += weight(*place);
        }
        let places: Vec<usize> = (0..present.len())
            .filter(|at| is_integrated(&present[*at]))
            .collect();
        let own = inner.select_rows(&places).select_columns(&places);
        let cholesky = Cholesky::new(inner).ok_or(Singular)?;
        let change = cholesky.solve(&gradient);
        for (place, change) in present.iter().zip(change.iter()) {
            solution[place + 1] = *change;
        }
        let own = Cholesky::new(own).ok_or(Singular)?;
        let determinant = 2.0 * own.l().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let prior: f64 = present
            .iter()
            .map(|place| weight(*place) * (self.values[*place] + solution[place + 1]).powi(2))
            .sum();
        let squares = (gram * &solution).dot(&solution);
        let of_noise: f64 = self
            .noises
            .iter()
            .zip(logarithms)
            .filter_map(|(noise, logarithm)| {
                let (mean, precision) = noise.prior?;
                Some(precision * (logarithm - mean).powi(2))
            })
            .sum();
        Ok(Eliminated {
            value: -0.5 * (score.log_variance + determinant + squares + prior + of_noise),
            solution,
            integrated: places.iter().map(|at| present[*at]).collect(),
            present,
            cholesky,
            inverse: own.inverse(),
        })
    }

    /// Derivatives of the logarithms by what is stepped.
    fn scale(&self, logarithms: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(logarithms.len(), |index, _| {
            match self.noises[index].prior {
                Some(_) => 1.0,
                None => 2.0 / size(logarithms[index]),
            }
        })
    }

    /// A step of bounded length.
    fn bounded(&self, step: DVector<f64>, logarithms: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(step.len(), |index, _| {
            if self.noises[index].prior.is_some() {
                return step[index].clamp(-LARGEST_STEP, LARGEST_STEP);
            }
            let size = size(logarithms[index]);
            let most = (0.5 * LARGEST_STEP).exp();
            step[index].clamp((SMALLEST_SHARE - 1.0) * size, (most - 1.0) * size)
        })
    }

    /// The logarithms after a step.
    fn moved(&self, logarithms: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(step.len(), |index, _| match self.noises[index].prior {
            Some(_) => logarithms[index] + step[index],
            None => 2.0 * (size(logarithms[index]) + step[index]).ln(),
        })
    }
}

/// Size of a noise over that where the logarithm of its variance is zero.
fn size(logarithm: f64) -> f64 {
    (0.5 * logarithm).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One Newton step of a likelihood that falls with the square of a size ends at the bound.
    #[test]
    fn a_noise_that_is_not_there_vanishes_in_one_step() {
        let noise = UnknownNoise {
            factor: 0,
            prior: None,
            is_held: false,
        };
        let restricted = Restricted {
            values: &[],
            sigmas: &[],
            integrated: Vec::new(),
            absent: &[],
            noises: vec![noise],
        };
        let logarithms = DVector::from_row_slice(&[1.0]);
        let own = (0.5_f64).exp();
        // l = -c σ²: the derivative by the logarithm of σ² is -c σ², the curvature by σ is 2 c.
        let gradient = -own * own * restricted.scale(&logarithms)[0];
        let step = DVector::from_row_slice(&[gradient / 2.0]);
        let next = restricted.moved(&logarithms, &restricted.bounded(step, &logarithms));
        let fallen = logarithms[0] - next[0];
        assert!((fallen - 100.0_f64.ln()).abs() < 1e-12, "{fallen}");
    }
}

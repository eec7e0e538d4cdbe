//! The unknowns of the fit at one noise: eliminated from its likelihood, or integrated out of it.

use gyrocal_inference::NoiseScore;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::{GYRO_NOISE_PRIOR_SIGMA, Likelihood};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fitted_platform::AXES;

/// The unknowns of the fit at one noise.
pub(super) struct Eliminated {
    pub(super) value: f64,
    pub(super) solution: DVector<f64>,
    /// The unknowns that the model has, and the factor of their information.
    present: Vec<usize>,
    cholesky: Cholesky<f64, Dyn>,
    /// The inverse information of those that are integrated out.
    pub(super) inverse: DMatrix<f64>,
}

impl Likelihood<'_, '_> {
    /// Places of the unknowns that are integrated out: coefficients, what the bench declares uncertain, and
    /// the offsets of each turn-on; all, if effects are.
    pub(super) fn integrated(&self) -> Vec<usize> {
        let fitted = self.fitted;
        let first = if self.integrates_effects {
            fitted.shared
        } else {
            PARAMETERS + fitted.nuisances()
        };
        (0..first)
            .chain(fitted.shared..fitted.problem.unknowns.len())
            .filter(|place| !self.absent.contains(place))
            .collect()
    }

    /// The information that the unknowns of the fit leave.
    pub(super) fn left(&self, score: &NoiseScore, eliminated: &Eliminated) -> DMatrix<f64> {
        let unknowns = self.unknowns();
        let stride = self.fitted.problem.unknowns.len() + 1;
        let present = &eliminated.present;
        let mut along = DMatrix::from_fn(present.len(), unknowns.len(), |i, index| {
            score.with_rows[unknowns[index] * stride + present[i] + 1]
        });
        for axis in self.held {
            along.column_mut(*axis).fill(0.0);
        }
        eliminated
            .cholesky
            .l_dirty()
            .solve_lower_triangular_mut(&mut along);
        self.information(score) - along.tr_mul(&along)
    }

    /// The logarithm of the restricted likelihood with the prior, and the unknowns of the fit there.
    pub(super) fn restricted(
        &self,
        score: &NoiseScore,
        logarithms: &[f64],
    ) -> Result<Eliminated, CalibrationError> {
        let problem = &self.fitted.problem;
        let gram = &score.gram;
        let count = problem.unknowns.len();
        let integrated = self.integrated();
        let mut solution = DVector::zeros(count + 1);
        solution[0] = 1.0;
        let weight = |place: usize| problem.unknowns[place].sigma.powi(-2);
        // The rows may end before the onset of an effect.
        let is_told = |place: usize| gram[(place + 1, place + 1)] + weight(place) > 0.0;
        let present: Vec<usize> = (0..count)
            .filter(|at| !self.absent.contains(at) && (integrated.contains(at) || is_told(*at)))
            .collect();
        for place in self.absent {
            solution[place + 1] = -problem.values[*place];
        }
        let pull = gram * &solution;
        let gradient = DVector::from_fn(present.len(), |i, _| {
            let place = present[i];
            -pull[place + 1] - weight(place) * problem.values[place]
        });
        let mut inner = DMatrix::from_fn(present.len(), present.len(), |i, j| {
            gram[(present[i] + 1, present[j] + 1)]
        });
        for (i, place) in present.iter().enumerate() {
            inner[(i, i)] += weight(*place);
        }
        let places: Vec<usize> = (0..present.len())
            .filter(|at| integrated.contains(&present[*at]))
            .collect();
        let own = inner.select_rows(&places).select_columns(&places);
        let not_definite = || CalibrationError::NotPositiveDefinite;
        let cholesky = Cholesky::new(inner).ok_or_else(not_definite)?;
        let change = cholesky.solve(&gradient);
        for (place, change) in present.iter().zip(change.iter()) {
            solution[place + 1] = *change;
        }
        let own = Cholesky::new(own).ok_or_else(not_definite)?;
        let determinant = 2.0 * own.l().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let prior: f64 = present
            .iter()
            .map(|place| weight(*place) * (problem.values[*place] + solution[place + 1]).powi(2))
            .sum();
        let squares = (gram * &solution).dot(&solution);
        let believed = self.fitted.noise.gyro_ratio;
        let of_noise: f64 = (0..AXES)
            .map(|axis| {
                let off = 0.5 * logarithms[axis] + believed[axis].ln();
                (off / GYRO_NOISE_PRIOR_SIGMA).powi(2)
            })
            .sum();
        let value = -0.5 * (score.log_variance + determinant + squares + prior + of_noise);
        Ok(Eliminated {
            value,
            solution,
            present,
            cholesky,
            inverse: own.inverse(),
        })
    }
}

//! Nonlinear least squares for a handful of unknowns.

use nalgebra::{DMatrix, DVector};

/// Minimum of a sum of squares.
pub(crate) struct Minimum {
    /// The unknowns at the minimum.
    pub(crate) unknowns: Vec<f64>,
    /// The residuals at the minimum.
    pub(crate) residuals: Vec<f64>,
    /// Inverse of the normal matrix at the minimum; `None` if it is singular.
    pub(crate) cofactors: Option<DMatrix<f64>>,
}

impl Minimum {
    /// Sum of squares.
    pub(crate) fn cost(&self) -> f64 {
        self.residuals
            .iter()
            .map(|residual| residual * residual)
            .sum()
    }
}

/// Minimises a sum of squares by the method of Levenberg and Marquardt, with derivatives by differences
/// of `steps`.
pub(crate) fn minimise(
    start: &[f64],
    steps: &[f64],
    residuals: impl Fn(&[f64]) -> Vec<f64>,
) -> Minimum {
    const MOST_ITERATIONS: usize = 60;
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mut unknowns = start.to_vec();
    let mut here = residuals(&unknowns);
    let mut cost = square(&here);
    let mut damping = 1e-3;
    for _ in 0..MOST_ITERATIONS {
        let jacobian = jacobian(&unknowns, steps, &residuals);
        let normal = jacobian.transpose() * &jacobian;
        let gradient = jacobian.transpose() * DVector::from_column_slice(&here);
        let mut damped = normal.clone();
        for i in 0..unknowns.len() {
            damped[(i, i)] *= 1.0 + damping;
        }
        let Some(step) = damped.cholesky().map(|factor| factor.solve(&gradient)) else {
            break;
        };
        let trial: Vec<f64> = unknowns
            .iter()
            .zip(step.iter())
            .map(|(u, s)| u - s)
            .collect();
        let there = residuals(&trial);
        let trial_cost = square(&there);
        if trial_cost < cost {
            let gain = cost - trial_cost;
            (unknowns, here, cost) = (trial, there, trial_cost);
            damping = (damping / 10.0_f64).max(1e-12);
            if gain < 1e-12 * cost {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e9 {
                break;
            }
        }
    }
    let jacobian = jacobian(&unknowns, steps, &residuals);
    let cofactors = (jacobian.transpose() * &jacobian)
        .cholesky()
        .map(|factor| factor.inverse());
    Minimum {
        unknowns,
        residuals: here,
        cofactors,
    }
}

fn jacobian(
    unknowns: &[f64],
    steps: &[f64],
    residuals: impl Fn(&[f64]) -> Vec<f64>,
) -> DMatrix<f64> {
    let columns: Vec<DVector<f64>> = (0..unknowns.len())
        .map(|i| {
            let moved = |sign: f64| {
                let mut moved = unknowns.to_vec();
                moved[i] += sign * steps[i];
                DVector::from_vec(residuals(&moved))
            };
            (moved(1.0) - moved(-1.0)) / (2.0 * steps[i])
        })
        .collect();
    DMatrix::from_columns(&columns)
}

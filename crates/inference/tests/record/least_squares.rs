//! The same record as one dense problem: all points, parameters and disturbances.

use gyrocal_scalar::Model;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use crate::chain::{
    Chain, KNOCKED, PRIOR, PRIOR_COVARIANCE, PRIOR_POINT, SHIFTED, SIGMA, VARIANCE,
};
use crate::common::Pendulum;

/// Of unknowns in units of their sigmas; the rule of differences is exact to the fourth power.
const STEP: f64 = 0.02;

/// Unit of a point among the unknowns.
const POINT: f64 = 0.01;

pub(crate) struct LeastSquares<'a> {
    chain: &'a Chain,
    /// Prior sigmas of the disturbances, if there are some.
    disturbances: &'a [f64],
}

pub(crate) struct Solution {
    pub(crate) parameters: Vec<f64>,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) cost: f64,
}

impl<'a> LeastSquares<'a> {
    pub(crate) fn new(chain: &'a Chain, disturbances: &'a [f64]) -> Self {
        Self {
            chain,
            disturbances,
        }
    }

    /// Parameters and disturbances.
    fn columns(&self) -> usize {
        4 + self.disturbances.len()
    }

    fn sigma(&self, column: usize) -> f64 {
        *SIGMA.iter().chain(self.disturbances).nth(column).unwrap()
    }

    /// From unknowns in units of their sigmas.
    fn parameters(&self, unknowns: &DVector<f64>) -> Vec<f64> {
        (0..self.columns())
            .map(|i| PRIOR.get(i).unwrap_or(&0.0) + self.sigma(i) * unknowns[i])
            .collect()
    }

    fn points(&self, unknowns: &DVector<f64>) -> Vec<[f64; 2]> {
        let first = self.columns();
        (0..self.chain.times_s.len())
            .map(|row| [0, 1].map(|i| POINT * unknowns[first + 2 * row + i]))
            .collect()
    }

    /// Residuals over the roots of their covariances: priors, outputs, and the noise between the
    /// rows.
    fn residuals(&self, unknowns: &DVector<f64>, noise: &[Matrix2<f64>]) -> DVector<f64> {
        let parameters = self.parameters(unknowns);
        let points = self.points(unknowns);
        let disturbance = |i: usize| parameters.get(4 + i).copied().unwrap_or(0.0);
        let mut residuals: Vec<f64> = unknowns.iter().take(self.columns()).copied().collect();
        let mut add = |covariance: &Matrix2<f64>, off: Vector2<f64>| {
            let root = covariance.cholesky().unwrap().l();
            residuals.extend(root.solve_lower_triangular(&off).unwrap().iter());
        };
        let start = Vector2::new(PRIOR_POINT[0], PRIOR_POINT[1] + disturbance(0));
        add(&PRIOR_COVARIANCE.into(), Vector2::from(points[0]) - start);
        for (row, noise) in noise.iter().enumerate() {
            let still = vec![0.0; self.chain.parts(row).0];
            let mut predicted = self.chain.over(row, points[row], &parameters[..4], &still);
            if row == KNOCKED {
                predicted[1] += disturbance(1);
            }
            add(
                noise,
                Vector2::from(points[row + 1]) - Vector2::from(predicted),
            );
        }
        for (row, output) in self.chain.present() {
            let predicted: [f64; 2] = Pendulum.output(&points[row], &parameters[..4], &());
            let shifted = row >= SHIFTED && output == 0;
            let shift = if shifted { disturbance(2) } else { 0.0 };
            let off = predicted[output] + shift - self.chain.measured[row][output];
            residuals.push(off / VARIANCE[output].sqrt());
        }
        DVector::from_vec(residuals)
    }

    /// Gauss-Newton on everything.
    pub(crate) fn solve(&self) -> Solution {
        let columns = self.columns();
        let start = self.chain.trajectory();
        let count = columns + 2 * start.len();
        let mut unknowns = DVector::zeros(count);
        for (i, value) in start.as_flattened().iter().enumerate() {
            unknowns[columns + i] = value / POINT;
        }
        loop {
            let (points, parameters) = (self.points(&unknowns), self.parameters(&unknowns));
            let noise: Vec<Matrix2<f64>> = (0..points.len() - 1)
                .map(|row| self.chain.step_noise(row, &points, &parameters[..4]))
                .collect();
            let jacobian: Vec<DVector<f64>> = (0..count)
                .map(|column| {
                    let at = |steps: f64| {
                        let mut moved = unknowns.clone();
                        moved[column] += steps * STEP;
                        self.residuals(&moved, &noise)
                    };
                    ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * STEP)
                })
                .collect();
            let residuals = self.residuals(&unknowns, &noise);
            let cost = residuals.norm_squared();
            let qr = DMatrix::from_columns(&jacobian).qr();
            let root = qr.r();
            let step = root
                .solve_upper_triangular(&-(qr.q().transpose() * residuals))
                .unwrap();
            unknowns += &step;
            if step.amax() > 1e-10 {
                continue;
            }
            let inverse = root
                .solve_upper_triangular(&DMatrix::identity(count, count))
                .unwrap();
            let covariance = &inverse * inverse.transpose();
            return Solution {
                parameters: self.parameters(&unknowns),
                covariance: DMatrix::from_fn(columns, columns, |i, j| {
                    covariance[(i, j)] * self.sigma(i) * self.sigma(j)
                }),
                points: self.points(&unknowns),
                cost,
            };
        }
    }
}

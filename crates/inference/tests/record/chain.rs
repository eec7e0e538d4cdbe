//! A short record of a pendulum with gaps, and Gauss-Newton steps on it.

use chacha20::ChaCha12Rng;
use gyrocal_estimation::{Integration, Manifold};
use gyrocal_inference::{
    Column, ExtraColumns, FurtherNoise, NoiseScore, Pass, PassError, Reduced, Series, Smoothed,
    Trajectory, Walks,
};
use gyrocal_scalar::Model;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix2, Vector2};
use rand::{RngExt, SeedableRng};

use crate::common::Pendulum;

/// Longest part of an interval; two parts at least, since noise of the torque alone moves angle
/// and rate along one line in one part.
pub(crate) const PARTS_S: f64 = 0.025;
pub(crate) const VARIANCE: [f64; 2] = [1e-4, 4e-4];
pub(crate) const DENSITY: f64 = 1e-3;
pub(crate) const PRIOR_POINT: [f64; 2] = [0.5, 0.0];
pub(crate) const PRIOR_COVARIANCE: [[f64; 2]; 2] = [[0.01, 0.006], [0.006, 0.04]];
pub(crate) const PRIOR: [f64; 4] = [0.0, 0.0, 4.0, 0.1];
pub(crate) const SIGMA: [f64; 4] = [0.05, 0.02, 0.5, 0.05];

/// Row after which [`disturbances`] knock, and first row whose angle they shift.
pub(crate) const KNOCKED: usize = 11;
pub(crate) const SHIFTED: usize = 17;

impl Manifold<2, 2> for Pendulum {
    type Point = [f64; 2];

    fn point(&self, moving: &[f64; 2], (): &()) -> [f64; 2] {
        *moving
    }

    fn place(&self, point: &[f64; 2], moving: &mut [f64; 2], (): &mut ()) {
        *moving = *point;
    }

    fn difference(&self, from: &[f64; 2], to: &[f64; 2]) -> [f64; 2] {
        [to[0] - from[0], to[1] - from[1]]
    }
}

/// The record.
pub(crate) struct Chain {
    pub(crate) times_s: Vec<f64>,
    pub(crate) measured: Vec<[f64; 2]>,
    pub(crate) variance: [f64; 2],
}

impl Series<(), 2> for Chain {
    fn rows(&self) -> usize {
        self.times_s.len()
    }

    fn time_s(&self, row: usize) -> f64 {
        self.times_s[row]
    }

    fn measured(&self, row: usize) -> [f64; 2] {
        self.measured[row]
    }

    fn noise_variance(&self, _row: usize) -> [f64; 2] {
        self.variance
    }
}

/// One Runge-Kutta step with a torque.
fn step(moving: [f64; 2], parameters: &[f64], torque: f64, dt: f64) -> [f64; 2] {
    let rates = |at: [f64; 2]| {
        let [angle, rate] = Pendulum.rates(&at, parameters, &());
        [angle, rate + torque]
    };
    let ahead = |rates: [f64; 2], dt: f64| [moving[0] + dt * rates[0], moving[1] + dt * rates[1]];
    let k1 = rates(moving);
    let k2 = rates(ahead(k1, 0.5 * dt));
    let k3 = rates(ahead(k2, 0.5 * dt));
    let k4 = rates(ahead(k3, dt));
    core::array::from_fn(|i| moving[i] + dt / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}

impl Chain {
    /// Thirty rows of a disturbed pendulum with other parameters than the prior's: irregular
    /// intervals, one of them long, missing outputs, and a row without any.
    pub(crate) fn measured(seed: u64) -> Self {
        let mut rng = ChaCha12Rng::seed_from_u64(seed);
        let mut uniform = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let parameters = [0.03, 0.01, 4.4, 0.07];
        let mut moving = [0.55, 0.1];
        let mut chain = Self {
            times_s: Vec::new(),
            measured: Vec::new(),
            variance: VARIANCE,
        };
        let mut time_s = 3.0;
        for row in 0..30 {
            let output: [f64; 2] = Pendulum.output(&moving, &parameters, &());
            let mut measured = [output[0] + uniform(0.017), output[1] + uniform(0.035)];
            if row % 5 == 3 {
                measured[row % 2] = f64::NAN;
            }
            if row == 8 {
                measured = [f64::NAN; 2];
            }
            chain.times_s.push(time_s);
            chain.measured.push(measured);
            let interval_s = if row == 14 {
                0.43
            } else {
                0.05 + uniform(0.01)
            };
            let torque = uniform(0.2);
            for _ in 0..10 {
                moving = step(moving, &parameters, torque, interval_s / 10.0);
            }
            time_s += interval_s;
        }
        chain
    }

    /// Prior means.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        PRIOR.to_vec()
    }

    /// Parts of the step after a row, and their length.
    pub(crate) fn parts(&self, row: usize) -> (usize, f64) {
        let interval_s = self.times_s[row + 1] - self.times_s[row];
        let parts = (interval_s / PARTS_S).ceil();
        (parts as usize, interval_s / parts)
    }

    /// Over the step after a row, with a torque in each part.
    pub(crate) fn over(
        &self,
        row: usize,
        mut moving: [f64; 2],
        parameters: &[f64],
        torques: &[f64],
    ) -> [f64; 2] {
        let (_, part_s) = self.parts(row);
        for torque in torques {
            moving = step(moving, parameters, *torque, part_s);
        }
        moving
    }

    /// From the prior's mean, without noise.
    pub(crate) fn trajectory(&self) -> Vec<[f64; 2]> {
        let mut moving = PRIOR_POINT;
        let mut points = vec![moving];
        for row in 0..self.times_s.len() - 1 {
            moving = self.over(row, moving, &PRIOR, &vec![0.0; self.parts(row).0]);
            points.push(moving);
        }
        points
    }

    /// Rows and outputs that have a value.
    pub(crate) fn present(&self) -> Vec<(usize, usize)> {
        (0..self.times_s.len())
            .flat_map(|row| [(row, 0), (row, 1)])
            .filter(|(row, output)| !self.measured[*row][*output].is_nan())
            .collect()
    }

    /// Squares of the outputs' residuals over their variances, for the prior's parameters.
    pub(crate) fn output_squares(&self, points: &[[f64; 2]]) -> Vec<f64> {
        let residual = |(row, output): (usize, usize)| {
            let predicted: [f64; 2] = Pendulum.output(&points[row], &PRIOR, &());
            self.measured[row][output] - predicted[output]
        };
        self.present()
            .into_iter()
            .map(|at| residual(at).powi(2) / VARIANCE[at.1])
            .collect()
    }

    /// Makes the residuals at these points equal to the given ones.
    pub(crate) fn set_residuals(&mut self, points: &[[f64; 2]], residuals: &DVector<f64>) {
        for ((row, output), residual) in self.present().into_iter().zip(residuals.iter()) {
            let predicted: [f64; 2] = Pendulum.output(&points[row], &PRIOR, &());
            self.measured[row][output] = predicted[output] + residual;
        }
    }

    /// Covariance that noise adds over the step after a row, by differences.
    pub(crate) fn step_noise(
        &self,
        row: usize,
        points: &[[f64; 2]],
        parameters: &[f64],
    ) -> Matrix2<f64> {
        let (parts, part_s) = self.parts(row);
        let mut sum = Matrix2::zeros();
        for part in 0..parts {
            let at = |torque: f64| {
                let mut torques = vec![0.0; parts];
                torques[part] = torque;
                Vector2::from(self.over(row, points[row], parameters, &torques))
            };
            let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
            sum += slope * slope.transpose() * (DENSITY / part_s);
        }
        sum
    }

    pub(crate) fn linearised<'a>(
        &'a self,
        points: &'a [[f64; 2]],
        parameters: &'a [f64],
        active: &'a [usize],
        further: &'a ExtraColumns,
    ) -> Case<'a> {
        let own = active.iter().map(|parameter| Column::Parameter {
            parameter: *parameter,
        });
        Case {
            columns: own.chain(further.columns().iter().cloned()).collect(),
            trajectory: Trajectory {
                model: &Pendulum,
                inputs: (),
                series: self,
                integration: Integration::RK4,
                longest_step_s: PARTS_S,
                noise_density: [DENSITY, 0.0],
                prior: PRIOR_POINT,
                prior_covariance: PRIOR_COVARIANCE,
                points,
                walks: Walks::default(),
                parameters,
                wanted: active,
                further,
            },
        }
    }
}

/// A linearised record with its columns.
#[derive(Clone)]
pub(crate) struct Case<'a> {
    pub(crate) trajectory: Trajectory<'a, Pendulum, Chain, 2, 2>,
    pub(crate) columns: Vec<Column>,
}

impl<'a> Case<'a> {
    /// With parameters that walk.
    pub(crate) fn walking(mut self, walks: Walks<'a>) -> Self {
        self.trajectory.walks = walks;
        self
    }

    pub(crate) fn pass(&self) -> Pass<'_> {
        Pass {
            further: FurtherNoise {
                walks: self.trajectory.walks,
                ..FurtherNoise::default()
            },
            ..Pass::new(&self.trajectory, &self.columns)
        }
    }

    pub(crate) fn reduce(&self) -> Result<Reduced, PassError> {
        self.pass().reduce_with_cost(|_| ())
    }

    pub(crate) fn smooth(&self, change: &[f64]) -> Result<Smoothed, PassError> {
        self.pass().smooth(change)
    }

    pub(crate) fn noise_score(&self, factors: &[f64]) -> Result<NoiseScore, PassError> {
        Pass {
            factors,
            ..self.pass()
        }
        .noise_score()
    }

    pub(crate) fn noise_score_of_columns(
        &self,
        factors: &[f64],
        first: usize,
        change: &[f64],
    ) -> Result<NoiseScore, PassError> {
        Pass {
            factors,
            ..self.pass()
        }
        .noise_score_of_columns(first, change)
    }
}

/// No further columns.
pub(crate) fn none() -> ExtraColumns {
    ExtraColumns::default()
}

/// A first rate that is off, a knock to the rate, and a shift of the measured angle, with these sizes.
pub(crate) fn disturbances(sizes: &[f64]) -> ExtraColumns {
    let change = (0..30).map(|row| f64::from(u8::from(row >= SHIFTED)));
    let mut columns = ExtraColumns::new(vec![
        Column::InitialState { row: 0, state: 1 },
        Column::StateJump {
            row: KNOCKED,
            state: 1,
        },
        Column::Output {
            output: 0,
            change: change.collect(),
        },
    ]);
    columns.set_amplitudes(sizes.iter().copied());
    columns
}

/// Result of Gauss-Newton steps.
pub(crate) struct Found {
    /// Parameters of the model, then amplitudes of the further columns.
    pub(crate) parameters: Vec<f64>,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) cost: f64,
}

/// Steps on all parameters and on further columns with these prior sigmas about zero.
pub(crate) fn solve(
    chain: &Chain,
    columns: impl Fn(&[f64]) -> ExtraColumns,
    sigma: &[f64],
) -> Found {
    let active = [0, 1, 2, 3];
    let prior: Vec<f64> = PRIOR.into_iter().chain(sigma.iter().map(|_| 0.0)).collect();
    let sigma: Vec<f64> = SIGMA.iter().chain(sigma).copied().collect();
    let count = prior.len();
    let mut values = prior.clone();
    let mut points = chain.trajectory();
    for _ in 0..30 {
        let columns = columns(&values[4..]);
        let parameters = values[..4].to_vec();
        let pass = chain.linearised(&points, &parameters, &active, &columns);
        let reduced = pass.reduce().unwrap();
        let information = DMatrix::from_fn(count, count, |i, j| {
            let own = if i == j { sigma[i].powi(-2) } else { 0.0 };
            reduced.gram[(i + 1, j + 1)] + own
        });
        let gradient = DVector::from_fn(count, |i, _| {
            (prior[i] - values[i]) / sigma[i].powi(2) - reduced.gram[(i + 1, 0)]
        });
        let cholesky = Cholesky::new(information).unwrap();
        let change = cholesky.solve(&gradient);
        let smoothed = pass.smooth(change.as_slice()).unwrap();
        let next = points
            .iter()
            .zip(smoothed.corrections.chunks_exact(2))
            .map(|(point, correction)| [point[0] + correction[0], point[1] + correction[1]])
            .collect();
        let own: f64 = (0..count)
            .map(|i| ((values[i] - prior[i]) / sigma[i]).powi(2))
            .sum();
        let cost = reduced.trajectory_cost + own;
        for (value, change) in values.iter_mut().zip(change.iter()) {
            *value += change;
        }
        let small = change.iter().zip(&sigma).all(|(c, s)| c.abs() < 1e-12 * s);
        points = next;
        if small {
            return Found {
                parameters: values,
                covariance: cholesky.inverse(),
                points,
                cost,
            };
        }
    }
    panic!("no convergence");
}

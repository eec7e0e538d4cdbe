//! What is expected of an open-loop simulation of a right model: noise, and sensitivity to the site.

use gyrocal::generated::catalogue;
use gyrocal::trajectory::{Orientation, turned};
use gyrocal_inference::Trajectory;
use nalgebra::{Cholesky, DMatrix, DVector};

use super::{AXES, FittedPlatform, S_PER_H};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::layout::SiteQuantity;

/// Stretches of the record whose means stand for its rows in the covariance.
const STRETCHES: usize = 120;

/// A turn of the first attitude for a difference quotient, rad: some hundred times the noise of a
/// sample, and far below one.
const TURN_RAD: f64 = 1e-4;

/// Relative weight that keeps directions of which the record says nothing from being singular.
const RIDGE: f64 = 1e-12;

/// Least variance of a residual over that of the accelerometers: a fit of a few rows absorbs all.
const LEAST: f64 = 0.01;

/// 1 deg/h in rad/s.
const RAD_PER_S: f64 = core::f64::consts::PI / (180.0 * S_PER_H);

/// Bias of the coefficients by an error of a quantity of the site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteBias {
    /// The quantity.
    pub quantity: SiteQuantity,
    /// Its error: the declared standard deviation, else a usual one.
    pub error: f64,
    /// Whether that standard deviation is declared, and so counts in those of the coefficients.
    pub is_declared: bool,
    /// Bias of each coefficient, in its unit.
    pub biases: [f64; PARAMETERS],
    /// The same in standard deviations of the estimate.
    pub in_sigmas: [f64; PARAMETERS],
}

impl FittedPlatform<'_> {
    /// Standard deviation of measured less freely simulated specific force at each row, g, if model and
    /// noise are right: the noise of the accelerometers, and the attitude that the noise of the gyros has
    /// turned since the first row, less what first attitude and parameters of the fit absorb of both.
    ///
    /// With y = C β + n, n of covariance Σ, the residual of the least-squares fit has the covariance
    /// Σ − C (Cᵀ Σ⁻¹ C)⁻¹ Cᵀ. It is computed of means over stretches of the record and interpolated.
    /// Further columns of the extension (jumps, curves) count as known. `simulated_g` is
    /// [`Self::free_run_g`].
    ///
    /// # Errors
    /// [`CalibrationError::Pass`] and [`CalibrationError::NotPositiveDefinite`].
    pub fn free_run_sigma_g(
        &self,
        simulated_g: &[[f64; 3]],
    ) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let knots = Knots::new(self.problem.runs[0].rows.times_s());
        let noise = self.noise_of(&knots, simulated_g);
        let columns = self.sensitivities(&knots, simulated_g)?;
        let absorbed = absorbed(&noise, &columns, &self.prior_weights())
            .ok_or(CalibrationError::NotPositiveDefinite)?;
        let accel_g = self.problem.runs[0].rows.declared_noise_g();
        let sigmas: Vec<[f64; 3]> = (0..knots.rows.len())
            .map(|knot| {
                core::array::from_fn(|axis| {
                    let place = AXES * knot + axis;
                    let variance = accel_g[axis] * accel_g[axis];
                    let of_mean = variance / knots.rows_of_each;
                    let turned = noise[(place, place)] - of_mean - absorbed[(place, place)];
                    (variance + turned).max(LEAST * variance).sqrt()
                })
            })
            .collect();
        Ok(knots.interpolated(&sigmas))
    }

    /// Covariance of the means over the stretches.
    fn noise_of(&self, knots: &Knots<'_>, simulated_g: &[[f64; 3]]) -> DMatrix<f64> {
        let leg = &self.problem.runs[0];
        let accel_g = leg.rows.declared_noise_g();
        let square = |rate: f64| rate * RAD_PER_S * RAD_PER_S;
        let mut white = leg.noise_density.map(square);
        let mut walk = [0.0; AXES];
        for (axis, size) in self.noise.gyro_walk_deg_per_h_per_sqrt_h.iter().enumerate() {
            walk[axis] = square(size * size / S_PER_H);
        }
        if self.is_strapdown() {
            // The axes of the gyros turn in the platform.
            let mean = |of: [f64; AXES]| [of.iter().sum::<f64>() / AXES as f64; AXES];
            (white, walk) = (mean(white), mean(walk));
        }
        let turns: Vec<DMatrix<f64>> = knots
            .rows
            .iter()
            .map(|row| by_turn(&simulated_g[*row]))
            .collect();
        let count = AXES * knots.rows.len();
        let mut noise = DMatrix::zeros(count, count);
        for (i, of_i) in turns.iter().enumerate() {
            for (j, of_j) in turns.iter().enumerate().take(i + 1) {
                let (early, late) = (knots.time_s(j), knots.time_s(i));
                let shared = DVector::from_fn(AXES, |axis, _| {
                    // Integrals of white noise and of a walk up to two times.
                    white[axis] * early + walk[axis] * early * early * (late / 2.0 - early / 6.0)
                });
                let block = of_i * DMatrix::from_diagonal(&shared) * of_j.transpose();
                noise
                    .view_mut((AXES * i, AXES * j), (AXES, AXES))
                    .copy_from(&block);
                noise
                    .view_mut((AXES * j, AXES * i), (AXES, AXES))
                    .copy_from(&block.transpose());
            }
            for (axis, accel_g) in accel_g.iter().enumerate() {
                let place = AXES * i + axis;
                noise[(place, place)] += accel_g * accel_g / knots.rows_of_each;
            }
        }
        noise
    }

    /// Changes of the simulation at the knots by a turn of the first attitude and by each unknown, over
    /// the size of that change.
    fn sensitivities(
        &self,
        knots: &Knots<'_>,
        simulated_g: &[[f64; 3]],
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let places: Vec<usize> = (0..PARAMETERS)
            .chain(self.extension.parameters.iter().map(|(place, _)| *place))
            .collect();
        let parameters = self.parameters();
        let mut columns = DMatrix::zeros(AXES * knots.rows.len(), AXES + places.len());
        let mut set = |column: usize, changed_g: &[[f64; 3]], size: f64| {
            for (knot, row) in knots.rows.iter().enumerate() {
                for axis in 0..AXES {
                    let change = changed_g[*row][axis] - simulated_g[*row][axis];
                    columns[(AXES * knot + axis, column)] = change / size;
                }
            }
        };
        for axis in 0..AXES {
            let mut turn = [0.0; AXES];
            turn[axis] = TURN_RAD;
            let mut points = self.points().to_vec();
            if let Some(first) = points.first_mut() {
                *first = turned(first, &turn);
            }
            set(axis, &self.simulated(&points, &parameters)?, TURN_RAD);
        }
        for (unknown, place) in places.iter().enumerate() {
            let size = self.uncertainty.total[(unknown, unknown)].sqrt();
            let mut changed = parameters.clone();
            changed[*place] += size;
            set(
                AXES + unknown,
                &self.simulated(self.points(), &changed)?,
                size,
            );
        }
        Ok(columns)
    }

    /// Specific force of a free run from the first of the points with some parameters, g.
    fn simulated(
        &self,
        points: &[Orientation],
        parameters: &[f64],
    ) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let further = &self.problem.runs[0].further;
        let trajectory = self.problem.trajectory(0, parameters, &[], further);
        let points = Trajectory {
            points,
            ..trajectory
        }
        .free_run()
        .map_err(|error| CalibrationError::pass(0, error))?;
        Ok(self.problem.outputs(0, &points, parameters))
    }

    /// Weights of what was known before the record, in the order of the columns of `sensitivities`.
    fn prior_weights(&self) -> Vec<f64> {
        let unknowns = self.problem.unknowns.iter();
        let known = PARAMETERS + self.extension.parameters.len();
        let weights = unknowns.take(known).map(|unknown| unknown.sigma.powi(-2));
        core::iter::repeat_n(0.0, AXES).chain(weights).collect()
    }

    /// Biases of the coefficients by errors of latitude, Earth rate and gravity.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn site_biases(&self) -> Result<Vec<SiteBias>, CalibrationError> {
        let gram = self.signatures(&[], |_| ())?.gram;
        let own: Vec<usize> = (0..PARAMETERS)
            .chain(self.extension.parameters.iter().map(|(place, _)| *place))
            .collect();
        let quantities = SiteQuantity::ALL.into_iter().filter_map(|quantity| {
            let all = &catalogue::PARAMETERS;
            let place = all.iter().position(|element| element.id == quantity.id())?;
            Some((quantity, place))
        });
        let covariance = &self.uncertainty.total;
        let sigma = |i: usize| covariance[(i, i)].sqrt();
        Ok(quantities
            .map(|(quantity, place)| {
                let fitted = own.iter().position(|other| *other == place);
                let (error, is_declared) = match fitted {
                    Some(fitted) => (self.problem.unknowns[fitted].sigma, true),
                    None => (quantity.reference_error(), false),
                };
                let per_unit = |i: usize| match fitted {
                    // The prior holds the quantity at a value that is wrong by a unit.
                    Some(fitted) => -covariance[(i, fitted)] * error.powi(-2),
                    None => {
                        let terms = own.iter().enumerate();
                        let cross = |other: &usize| gram[(other + 1, place + 1)];
                        terms
                            .map(|(j, other)| covariance[(i, j)] * cross(other))
                            .sum()
                    }
                };
                let biases: [f64; PARAMETERS] = core::array::from_fn(|i| error * per_unit(i));
                SiteBias {
                    quantity,
                    error,
                    is_declared,
                    biases,
                    in_sigmas: core::array::from_fn(|i| biases[i] / sigma(i)),
                }
            })
            .collect())
    }
}

/// Middles of stretches of a record.
struct Knots<'a> {
    times_s: &'a [f64],
    rows: Vec<usize>,
    rows_of_each: f64,
}

impl<'a> Knots<'a> {
    fn new(times_s: &'a [f64]) -> Self {
        let count = times_s.len();
        let stretches = count.clamp(1, STRETCHES);
        let rows = (0..stretches).map(|one| (2 * one + 1) * count / (2 * stretches));
        Self {
            times_s,
            rows: rows.filter(|row| *row < count).collect(),
            rows_of_each: count as f64 / stretches as f64,
        }
    }

    /// Time of a knot since the first row, s.
    fn time_s(&self, knot: usize) -> f64 {
        self.times_s[self.rows[knot]] - self.times_s[0]
    }

    /// Values at the knots, at every row: linear between knots, constant beyond them.
    fn interpolated(&self, values: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut after = 0;
        let rows = 0..self.times_s.len();
        rows.map(|row| {
            while after + 1 < self.rows.len() && self.rows[after] < row {
                after += 1;
            }
            let before = after.saturating_sub(1);
            let (from, to) = (self.rows[before], self.rows[after]);
            let length = self.times_s[to] - self.times_s[from];
            let part = if length > 0.0 {
                ((self.times_s[row] - self.times_s[from]) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            core::array::from_fn(|axis| {
                values[before][axis] + part * (values[after][axis] - values[before][axis])
            })
        })
        .collect()
    }
}

/// Derivative of specific force by a turn of the platform: the matrix of a cross product.
fn by_turn(&[x, y, z]: &[f64; 3]) -> DMatrix<f64> {
    DMatrix::from_row_slice(AXES, AXES, &[0.0, -z, y, z, 0.0, -x, -y, x, 0.0])
}

/// C (Cᵀ Σ⁻¹ C + Λ)⁻¹ Cᵀ.
fn absorbed(
    noise: &DMatrix<f64>,
    columns: &DMatrix<f64>,
    prior_weights: &[f64],
) -> Option<DMatrix<f64>> {
    let weighted = Cholesky::new(noise.clone())?.solve(columns);
    let mut information = columns.transpose() * weighted;
    for (place, weight) in prior_weights.iter().enumerate() {
        information[(place, place)] = information[(place, place)] * (1.0 + RIDGE) + weight;
    }
    // Unknowns of unlike units: each in the unit of its own information.
    let scale = information.diagonal().map(|own| own.sqrt().recip());
    let unit = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
        information[(i, j)] * scale[i] * scale[j]
    });
    let columns = columns * DMatrix::from_diagonal(&scale);
    let covariance = Cholesky::new(unit)?.inverse();
    Some(&columns * covariance * columns.transpose())
}

//! Dense least squares over all rows of a short record: the reference of the batch estimator.
//!
//! The two share no code. Unknowns are the attitude at every row and the coefficients; residuals
//! are those of the samples, of the gyro noise between rows, and of the priors. Attitudes are
//! direction cosines, derivatives are differences of fourth order, and the normal equations are
//! never formed.

use gyrocal_calibration::Run;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Coefficients.
const COEFFICIENTS: usize = 9;
/// Unit of a rotation among the unknowns, rad: the size of the noise of a sample.
const ROTATION_RAD: f64 = 1e-5;
/// Sub-steps of a Runge-Kutta rule in a part.
const SUBSTEPS: u32 = 2;
const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;
/// rad/s in a deg/h.
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// The solution.
pub struct DenseSolution {
    /// The coefficients.
    pub drift: [f64; COEFFICIENTS],
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Platform from East, North, Up at the first row and the last.
    pub ends: [Matrix3<f64>; 2],
    /// Least sum of squares, priors included.
    pub cost: f64,
}

/// A short record as one least-squares problem.
pub struct DenseProblem<'a> {
    run: Run<'a>,
    longest_step_s: f64,
    /// Initial attitude that the bench declares.
    first: Matrix3<f64>,
    /// Root of the covariance of the rotation from there, in platform axes.
    first_root: Matrix3<f64>,
    drift_sigma: [f64; COEFFICIENTS],
}

impl<'a> DenseProblem<'a> {
    /// The problem of a run; steps longer than `longest_step_s` are divided. The bench has to declare the
    /// initial angles.
    pub fn new(run: Run<'a>, longest_step_s: f64) -> Self {
        let bench = run.bench;
        let angles =
            Vector3::from(bench.initial_angles_deg.expect("initial angles")).map(f64::to_radians);
        let sigma = Vector3::from(bench.initial_angles_sigma_deg).map(f64::to_radians);
        // Equation (6) of the model: the rates of the angles as a rotation in platform axes.
        let ((sy, cy), (sz, cz)) = (angles.y.sin_cos(), angles.z.sin_cos());
        let map = Matrix3::new(cy * cz, sz, 0.0, -cy * sz, cz, 0.0, sy, 0.0, 1.0);
        // About no axis better known than the best known angle.
        let mut parts = (map * Matrix3::from_diagonal(&sigma)).svd(true, false);
        parts
            .singular_values
            .apply(|value| *value = value.max(sigma.min()));
        let root = parts.u.expect("asked for") * Matrix3::from_diagonal(&parts.singular_values);
        let prior = &bench.prior;
        let drift_sigma = core::array::from_fn(|i| match i % 3 {
            0 => prior.bias_sigma_deg_per_h[i / 3],
            1 => prior.g_sigma_deg_per_h_per_g[i / 3],
            _ => prior.gg_sigma_deg_per_h_per_g2[i / 3],
        });
        Self {
            run,
            longest_step_s,
            first: about(2, angles.z) * about(1, angles.y) * about(0, angles.x),
            first_root: root,
            drift_sigma,
        }
    }

    /// Gauss-Newton steps to convergence.
    pub fn solve(&self) -> DenseSolution {
        let mut drift = [0.0; COEFFICIENTS];
        let mut attitudes = vec![self.first];
        for row in 0..self.run.record.len() - 1 {
            attitudes.push(self.ahead(row, &attitudes[row], &drift, &[]));
        }
        let count = COEFFICIENTS + 3 * attitudes.len();
        loop {
            let here = Linearised {
                noise_roots: (0..attitudes.len() - 1)
                    .map(|row| self.noise_root(row, &attitudes[row], &drift))
                    .collect(),
                problem: self,
                attitudes: &attitudes,
                drift: &drift,
            };
            let residuals = here.residuals(&DVector::zeros(count));
            let cost = residuals.norm_squared();
            let qr = here.jacobian(count).qr();
            let root = qr.r();
            let step = root
                .solve_upper_triangular(&-(qr.q().transpose() * residuals))
                .expect("priors make every unknown determined");
            (attitudes, drift) = here.moved(&step);
            // In sigmas of priors and samples; quadratic convergence leaves less.
            if step.amax() > 1e-8 {
                continue;
            }
            let inverse = root
                .solve_upper_triangular(&DMatrix::identity(count, count))
                .expect("priors make every unknown determined");
            let covariance = &inverse * inverse.transpose();
            return DenseSolution {
                drift,
                covariance: DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| {
                    covariance[(i, j)] * self.drift_sigma[i] * self.drift_sigma[j]
                }),
                ends: [attitudes[0], attitudes[attitudes.len() - 1]],
                cost,
            };
        }
    }

    /// Number and length of the parts of the step after a row.
    fn parts(&self, row: usize) -> (usize, f64) {
        let times_s = &self.run.record.time_s;
        let interval_s = times_s[row + 1] - times_s[row];
        let parts = (interval_s / self.longest_step_s).ceil().max(1.0);
        (parts as usize, interval_s / parts)
    }

    /// Attitude at the next row; `noise`, if given, is that of each part, deg/h.
    fn ahead(
        &self,
        row: usize,
        from: &Matrix3<f64>,
        drift: &[f64; COEFFICIENTS],
        noise: &[Vector3<f64>],
    ) -> Matrix3<f64> {
        let bench = self.run.bench;
        let (sine, cosine) = bench.latitude_deg.to_radians().sin_cos();
        let earth_rate = Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
        let gravity_g = bench.specific_force_at_rest();
        let (parts, part_s) = self.parts(row);
        let step_s = part_s / f64::from(SUBSTEPS);
        let mut attitude = *from;
        for part in 0..parts {
            let noise = noise.get(part).copied().unwrap_or_default();
            let rate = |attitude: &Matrix3<f64>| {
                let own = Vector3::from_fn(|axis, _| {
                    let a = gravity_g * attitude[(axis, 2)];
                    let [bias, first, second] = core::array::from_fn(|k| drift[3 * axis + k]);
                    (bias + first * a + second * a * a + noise[axis]) * DEG_PER_H
                });
                -(own - attitude * earth_rate).cross_matrix() * attitude
            };
            for _ in 0..SUBSTEPS {
                let k1 = rate(&attitude);
                let k2 = rate(&(attitude + k1 * (0.5 * step_s)));
                let k3 = rate(&(attitude + k2 * (0.5 * step_s)));
                let k4 = rate(&(attitude + k3 * step_s));
                attitude += (k1 + (k2 + k3) * 2.0 + k4) * (step_s / 6.0);
            }
        }
        attitude
    }

    /// Root of the covariance of the rotation by the noise over the step after a row. The noise is
    /// held over each part, as white as the declared noise, which is held over a minute.
    fn noise_root(
        &self,
        row: usize,
        from: &Matrix3<f64>,
        drift: &[f64; COEFFICIENTS],
    ) -> Matrix3<f64> {
        let (parts, part_s) = self.parts(row);
        let sigma = self.run.bench.gyro_noise_deg_per_h * (60.0 / part_s).sqrt();
        let without = self.ahead(row, from, drift, &[]);
        let mut covariance = Matrix3::zeros();
        for part in 0..parts {
            for axis in 0..3 {
                // A hundredth of a deg/h: differences of 1e-6 rad, exact to its square.
                let at = |size: f64| {
                    let mut noise = vec![Vector3::zeros(); parts];
                    noise[part][axis] = size;
                    rotation(&without, &self.ahead(row, from, drift, &noise))
                };
                let slope = (at(0.01) - at(-0.01)) / 0.02 * sigma;
                covariance += slope * slope.transpose();
            }
        }
        covariance.cholesky().expect("noise on every axis").l()
    }
}

/// The problem about the current estimate. Unknowns are changes from there: coefficients in units of
/// their prior sigmas, then rotations.
struct Linearised<'a> {
    problem: &'a DenseProblem<'a>,
    attitudes: &'a [Matrix3<f64>],
    drift: &'a [f64; COEFFICIENTS],
    noise_roots: Vec<Matrix3<f64>>,
}

impl Linearised<'_> {
    fn moved(&self, unknowns: &DVector<f64>) -> (Vec<Matrix3<f64>>, [f64; COEFFICIENTS]) {
        let of = self.problem;
        let drift = core::array::from_fn(|i| self.drift[i] + of.drift_sigma[i] * unknowns[i]);
        let attitudes = self.attitudes.iter().enumerate();
        let attitudes = attitudes
            .map(|(row, attitude)| {
                let first = COEFFICIENTS + 3 * row;
                let rotation = unknowns.fixed_rows::<3>(first) * ROTATION_RAD;
                turn(&rotation) * attitude
            })
            .collect();
        (attitudes, drift)
    }

    fn residuals(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let of = self.problem;
        let bench = of.run.bench;
        let (attitudes, drift) = self.moved(unknowns);
        let mut residuals: Vec<f64> = (0..COEFFICIENTS)
            .map(|i| drift[i] / of.drift_sigma[i])
            .collect();
        let whitened = |root: &Matrix3<f64>, rotation: Vector3<f64>| {
            root.lu().solve(&rotation).expect("a root of a covariance")
        };
        let first = whitened(&of.first_root, rotation(&of.first, &attitudes[0]));
        residuals.extend(first.iter());
        for (row, sample) in of.run.record.accel_g.iter().enumerate() {
            for axis in 0..3 {
                if !sample[axis].is_nan() {
                    let predicted = bench.specific_force_at_rest() * attitudes[row][(axis, 2)];
                    residuals.push((predicted - sample[axis]) / bench.accel_noise_g);
                }
            }
        }
        for (row, root) in self.noise_roots.iter().enumerate() {
            let predicted = of.ahead(row, &attitudes[row], &drift, &[]);
            residuals.extend(whitened(root, rotation(&predicted, &attitudes[row + 1])).iter());
        }
        DVector::from_vec(residuals)
    }

    fn jacobian(&self, count: usize) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..count)
            .map(|column| {
                // A coefficient of a fiftieth of a deg/h, or 1e-5 rad: small enough for a rule
                // that is exact to the fourth power, and far above rounding.
                let step = if column < COEFFICIENTS {
                    0.02 / self.problem.drift_sigma[column]
                } else {
                    1.0
                };
                let at = |steps: f64| {
                    let mut moved = DVector::zeros(count);
                    moved[column] = steps * step;
                    self.residuals(&moved)
                };
                ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step)
            })
            .collect();
        DMatrix::from_columns(&columns)
    }
}

/// The passive rotation about an axis.
fn about(axis: usize, angle: f64) -> Matrix3<f64> {
    let mut vector = Vector3::zeros();
    vector[axis] = angle;
    turn(&vector)
}

/// Components in axes that are turned by a rotation vector.
fn turn(rotation: &Vector3<f64>) -> Matrix3<f64> {
    nalgebra::Rotation3::from_scaled_axis(-rotation).into_inner()
}

/// The small rotation vector from one attitude to another, in platform axes.
fn rotation(from: &Matrix3<f64>, to: &Matrix3<f64>) -> Vector3<f64> {
    let m = to * from.transpose();
    // sin|φ| φ / |φ|; asin(s) / s = 1 + s² / 6 to 1e-12 for angles below 1e-3.
    let sine = 0.5
        * Vector3::new(
            m[(1, 2)] - m[(2, 1)],
            m[(2, 0)] - m[(0, 2)],
            m[(0, 1)] - m[(1, 0)],
        );
    sine * (1.0 + sine.norm_squared() / 6.0)
}

//! Least squares on all of a short record at once, on dense matrices: what the batch estimator
//! must agree with.
//!
//! It shares nothing with it. Unknown are the first attitude, the coefficients and the noise of
//! the gyros over every part of every interval; attitudes follow from them by integrating the
//! direction cosines, derivatives are central differences of fourth order, and the normal
//! equations are never formed.

use gyrocal_calibration::Run;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Coefficients.
const COEFFICIENTS: usize = 9;
/// Unknowns before the noise: a rotation and the coefficients.
const FIRST_NOISE: usize = 3 + COEFFICIENTS;
/// Sub-steps of a Runge-Kutta rule in a part.
const SUBSTEPS: u32 = 2;
const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;
/// rad/s in a deg/h.
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// What is found.
pub(crate) struct DenseSolution {
    /// The coefficients.
    pub(crate) drift: [f64; COEFFICIENTS],
    /// Their covariance.
    pub(crate) covariance: DMatrix<f64>,
    /// Platform from East, North, Up at the first row and the last.
    pub(crate) ends: [Matrix3<f64>; 2],
    /// Least sum of squares, priors included.
    pub(crate) cost: f64,
}

/// A short record as one problem.
pub(crate) struct Dense<'a> {
    run: Run<'a>,
    longest_step_s: f64,
    /// As the bench declares.
    first: Matrix3<f64>,
    /// Root of the covariance of the rotation from there, in platform axes.
    first_root: Matrix3<f64>,
    drift_sigma: [f64; COEFFICIENTS],
}

impl<'a> Dense<'a> {
    /// The bench has to declare the initial angles.
    pub(crate) fn new(run: Run<'a>, longest_step_s: f64) -> Self {
        let bench = run.bench;
        let angles = Vector3::from(bench.initial_angles_deg.expect("initial angles"))
            .map(f64::to_radians);
        let sigma = Vector3::from(bench.initial_angles_sigma_deg).map(f64::to_radians);
        // Equation (6) of the model: the rates of the angles as a rotation in platform axes.
        let ((sy, cy), (sz, cz)) = (angles.y.sin_cos(), angles.z.sin_cos());
        let map = Matrix3::new(cy * cz, sz, 0.0, -cy * sz, cz, 0.0, sy, 0.0, 1.0);
        let root = map * Matrix3::from_diagonal(&sigma);
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
    pub(crate) fn solve(&self) -> DenseSolution {
        let count = FIRST_NOISE + 3 * self.parts().iter().sum::<usize>();
        let mut unknowns = DVector::<f64>::zeros(count);
        let mut factor = None;
        for _ in 0..15 {
            let residuals = self.residuals(&unknowns);
            let qr = self.jacobian(&unknowns).qr();
            let right = -(qr.q().transpose() * residuals);
            let root = qr.r();
            let step = root
                .solve_upper_triangular(&right)
                .expect("priors make every unknown determined");
            unknowns += &step;
            factor = Some(root);
            // In sigmas of the priors; quadratic convergence leaves less.
            if step.amax() < 1e-11 {
                break;
            }
        }
        let inverse = factor
            .and_then(|root| root.solve_upper_triangular(&DMatrix::identity(count, count)))
            .expect("priors make every unknown determined");
        let covariance = &inverse * inverse.transpose();
        let attitudes = self.attitudes(&unknowns);
        DenseSolution {
            drift: self.drift(&unknowns),
            covariance: DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| {
                covariance[(3 + i, 3 + j)] * self.drift_sigma[i] * self.drift_sigma[j]
            }),
            ends: [attitudes[0], attitudes[attitudes.len() - 1]],
            cost: self.residuals(&unknowns).norm_squared(),
        }
    }

    /// Number of parts of each interval.
    fn parts(&self) -> Vec<usize> {
        let times = self.run.record.time_s.windows(2);
        times
            .map(|pair| ((pair[1] - pair[0]) / self.longest_step_s).ceil().max(1.0) as usize)
            .collect()
    }

    fn drift(&self, unknowns: &DVector<f64>) -> [f64; COEFFICIENTS] {
        core::array::from_fn(|i| self.drift_sigma[i] * unknowns[3 + i])
    }

    /// Outputs over their noise, then the unknowns themselves, which are in units of their
    /// sigmas.
    fn residuals(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let bench = self.run.bench;
        let gravity_g = bench.specific_force_at_rest();
        let mut residuals = Vec::new();
        for (attitude, sample) in self.attitudes(unknowns).iter().zip(&self.run.record.accel_g) {
            for axis in 0..3 {
                if !sample[axis].is_nan() {
                    let predicted = gravity_g * attitude[(axis, 2)];
                    residuals.push((predicted - sample[axis]) / bench.accel_noise_g);
                }
            }
        }
        residuals.extend(unknowns.iter());
        DVector::from_vec(residuals)
    }

    fn jacobian(&self, unknowns: &DVector<f64>) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..unknowns.len())
            .map(|column| {
                // A coefficient of a fiftieth of a deg/h bends a record of an hour by 3e-4; of
                // the rest a whole sigma is tiny. The rule is exact to the fourth power.
                let step = if (3..FIRST_NOISE).contains(&column) {
                    0.02 / self.drift_sigma[column - 3]
                } else {
                    1.0
                };
                let at = |steps: f64| {
                    let mut moved = unknowns.clone();
                    moved[column] += steps * step;
                    self.residuals(&moved)
                };
                ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step)
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Platform from East, North, Up at each row.
    fn attitudes(&self, unknowns: &DVector<f64>) -> Vec<Matrix3<f64>> {
        let bench = self.run.bench;
        let (sine, cosine) = bench.latitude_deg.to_radians().sin_cos();
        let earth_rate = Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
        let gravity_g = bench.specific_force_at_rest();
        let drift = self.drift(unknowns);
        let rotation = self.first_root * Vector3::new(unknowns[0], unknowns[1], unknowns[2]);
        let mut attitude = turn(&rotation) * self.first;
        let mut attitudes = vec![attitude];
        let mut next = FIRST_NOISE;
        for (pair, parts) in self.run.record.time_s.windows(2).zip(self.parts()) {
            let part_s = (pair[1] - pair[0]) / parts as f64;
            // Held over the part, as white as the noise that is declared as held over a minute.
            let sigma = bench.gyro_noise_deg_per_h * (60.0 / part_s).sqrt();
            for _ in 0..parts {
                let noise: [f64; 3] = core::array::from_fn(|axis| sigma * unknowns[next + axis]);
                next += 3;
                let rate = |attitude: &Matrix3<f64>| {
                    let own = Vector3::from_fn(|axis, _| {
                        let a = gravity_g * attitude[(axis, 2)];
                        let [bias, first, second] = [0, 1, 2].map(|k| drift[3 * axis + k]);
                        (bias + first * a + second * a * a + noise[axis]) * DEG_PER_H
                    });
                    -(own - attitude * earth_rate).cross_matrix() * attitude
                };
                let step_s = part_s / f64::from(SUBSTEPS);
                for _ in 0..SUBSTEPS {
                    let k1 = rate(&attitude);
                    let k2 = rate(&(attitude + k1 * (0.5 * step_s)));
                    let k3 = rate(&(attitude + k2 * (0.5 * step_s)));
                    let k4 = rate(&(attitude + k3 * step_s));
                    attitude += (k1 + (k2 + k3) * 2.0 + k4) * (step_s / 6.0);
                }
            }
            attitudes.push(attitude);
        }
        attitudes
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

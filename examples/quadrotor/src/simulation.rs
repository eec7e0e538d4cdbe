//! A quadrotor of its own making: its body turns as a matrix, and nothing of the generated code or
//! of Euler angles takes part.

use crate::random::Random;
use crate::{GYROS, PRIOR, SENSORS};

/// Interval between samples, s.
pub const STEP_S: f64 = 0.02;
/// Inclination of the magnetic field, rad below the horizon.
const DIP_RAD: f64 = 1.1;

type Matrix = [[f64; 3]; 3];

/// A simulated quadrotor in hover, which sways about all axes.
pub struct Hover {
    /// Body axes as rows, in north, east and down.
    body_c_ned: Matrix,
    /// Biases of the gyros, rad/s.
    pub bias: [f64; 3],
    random: Random,
    time_s: f64,
}

impl Hover {
    /// A quadrotor whose attitude and biases are drawn about those that the filter starts from.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let [roll, pitch, yaw, x, y, z] = PRIOR.map(|sigma| sigma * random.normal());
        let mut body_c_ned = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for turn in [[0.0, 0.0, yaw], [0.0, pitch, 0.0], [roll, 0.0, 0.0]] {
            body_c_ned = turned(&body_c_ned, turn);
        }
        Self {
            body_c_ned,
            bias: [x, y, z],
            random,
            time_s: 0.0,
        }
    }

    /// Moves on by an interval; returns the readings of the gyros over it, and of accelerometers and
    /// magnetometer at its end.
    pub fn step(&mut self) -> ([f64; 3], [f64; 6]) {
        let t = self.time_s + 0.5 * STEP_S;
        let omega = [
            0.4 * (1.1 * t).cos(),
            0.3 * (0.7 * t).cos(),
            0.5 * (0.3 * t).cos(),
        ];
        self.body_c_ned = turned(&self.body_c_ned, omega.map(|rate| rate * STEP_S));
        self.time_s += STEP_S;
        let gyros = core::array::from_fn(|i| {
            omega[i] + self.bias[i] + (GYROS[i] / STEP_S).sqrt() * self.random.normal()
        });
        let (dip_sine, dip_cosine) = DIP_RAD.sin_cos();
        let read = core::array::from_fn(|i| {
            let axis = self.body_c_ned[i % 3];
            let truth = match i {
                0..3 => -axis[2],
                _ => axis[0] * dip_cosine + axis[2] * dip_sine,
            };
            truth + SENSORS[i].sqrt() * self.random.normal()
        });
        (gyros, read)
    }

    /// Roll, pitch and yaw, rad.
    #[must_use]
    pub fn angles_rad(&self) -> [f64; 3] {
        let [x, y, z] = self.body_c_ned;
        [y[2].atan2(z[2]), (-x[2]).asin(), x[1].atan2(x[0])]
    }
}

/// Body axes after a rotation by a vector in body axes, rad (Rodrigues).
fn turned(axes: &Matrix, turn: [f64; 3]) -> Matrix {
    let angle = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
    if angle == 0.0 {
        return *axes;
    }
    let n = turn.map(|x| x / angle);
    let (sine, cosine) = angle.sin_cos();
    let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
    // Components of a fixed vector turn the other way.
    core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            (0..3)
                .map(|k| {
                    let unit = if i == k { cosine } else { 0.0 };
                    (unit + (1.0 - cosine) * n[i] * n[k] - sine * cross[i][k]) * axes[k][j]
                })
                .sum()
        })
    })
}

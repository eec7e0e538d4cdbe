//! The rate at which gravity turns against the platform, from accelerometers alone.
//!
//! The vertical e in platform axes obeys de/dt = w × e, with w the rate of the Earth less the drift
//! of the platform, in platform axes. Over a window w is nearly constant, and the integral of e is
//! known from the rows: the change of e is w × ∫ e dt, linear in w.

use nalgebra::{Matrix3, Vector3};

use crate::samples::Complete;
use crate::vector::{Vector, cross, dot, minus, plus};

/// Length of a window. A gyro drifts by degrees in it; the Earth turns by a right angle.
pub(crate) const WINDOW_S: f64 = 6.0 * 3600.0;

/// Length of a part of a window, over which the change of e is measured: seven degrees.
const PART_S: f64 = 1800.0;

/// A gap across which ∫ e dt is not known well enough: the chord of 15 degrees is short by 0.3 %.
const LONGEST_INTERVAL_S: f64 = 3600.0;

/// Fewest parts of a window.
const LEAST_PARTS: usize = 3;

/// Least ratio of the smallest to the largest eigenvalue of the normal matrix: below it the
/// component along a vertical that hardly moves is not known.
const LEAST_CONDITION: f64 = 1e-5;

/// The rate over a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rate {
    /// The rate w, in platform axes, rad/s.
    pub(crate) rate_rad_per_s: Vector,
    /// Its component along the vertical, mean over the window, rad/s.
    pub(crate) vertical_rad_per_s: f64,
    /// Size of its horizontal part, rad/s.
    pub(crate) horizontal_rad_per_s: f64,
}

/// The rate over some complete rows; `None` if they do not determine it.
pub(crate) fn rate(rows: &[Complete]) -> Option<Rate> {
    let mut matrix = Matrix3::zeros();
    let mut right = Vector3::zeros();
    let mut parts = 0;
    let mut start = 0;
    let mut integral = [0.0; 3];
    for at in 1..rows.len() {
        let interval_s = rows[at].time_s - rows[at - 1].time_s;
        if interval_s > LONGEST_INTERVAL_S {
            start = at;
            integral = [0.0; 3];
            continue;
        }
        integral = plus(integral, 0.5 * interval_s, plus(rows[at - 1].up, 1.0, rows[at].up));
        if rows[at].time_s - rows[start].time_s < PART_S && at + 1 < rows.len() {
            continue;
        }
        let change = minus(rows[at].up, rows[start].up);
        let i = Vector3::from(integral);
        matrix += Matrix3::identity() * dot(integral, integral) - i * i.transpose();
        right += Vector3::from(cross(integral, change));
        parts += 1;
        start = at;
        integral = [0.0; 3];
    }
    if parts < LEAST_PARTS {
        return None;
    }
    let eigen = matrix.symmetric_eigenvalues();
    if eigen.min() < LEAST_CONDITION * eigen.max() || !eigen.max().is_finite() {
        return None;
    }
    let solved = matrix.cholesky()?.solve(&right);
    let rate_rad_per_s = [solved[0], solved[1], solved[2]];
    let along = rows.iter().map(|row| dot(row.up, rate_rad_per_s));
    let vertical_rad_per_s = along.sum::<f64>() / rows.len() as f64;
    let square = dot(rate_rad_per_s, rate_rad_per_s) - vertical_rad_per_s.powi(2);
    Some(Rate {
        rate_rad_per_s,
        vertical_rad_per_s,
        horizontal_rad_per_s: square.max(0.0).sqrt(),
    })
}

/// The rates over windows of some length, which follow each other.
pub(crate) fn rates(rows: &[Complete], window_s: f64) -> Vec<Rate> {
    let Some(first_s) = rows.first().map(|row| row.time_s) else {
        return Vec::new();
    };
    let window = |row: &Complete| ((row.time_s - first_s) / window_s).floor();
    rows.chunk_by(|a, b| window(a) == window(b))
        .filter_map(rate)
        .collect()
}

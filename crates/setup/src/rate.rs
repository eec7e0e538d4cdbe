//! The rate at which gravity turns against the platform, from accelerometers alone.
//!
//! The vertical e in platform axes obeys de/dt = w × e, with w the rate of the Earth less the drift
//! of the platform, in platform axes. Over a window w changes slowly, as the platform drifts, and the
//! integral of e is known from the rows: the change of e is ∫ w × e dt, linear in w and its change.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::samples::Complete;
use crate::vector::{Vector, across, dot, minus, norm, plus};

/// Length of a window. A gyro drifts by degrees in it; the Earth turns by a right angle.
pub(crate) const WINDOW_S: f64 = 6.0 * 3600.0;

/// Length of a part of a window, over which the change of e is measured: seven degrees.
const PART_S: f64 = 1800.0;

/// Shortest record that tells how gravity turns, and with it axes, signs, latitude and clock \[s\].
pub const LEAST_TURN_S: f64 = LEAST_PARTS as f64 * PART_S;

/// A gap across which ∫ e dt is not known well enough: the chord of 15 degrees is short by 0.3 %.
const LONGEST_INTERVAL_S: f64 = 3600.0;

/// Fewest parts of a window.
const LEAST_PARTS: usize = 3;

/// Least ratio of the smallest to the largest eigenvalue of the normal matrix: below it the
/// component along a vertical that hardly moves is not known.
const LEAST_CONDITION: f64 = 1e-5;

/// Weight of a change of the rate of zero against one part of the window: a drift of some deg/h
/// changes the rate by as much in hours, and the fit of a part is good to a tenth of that.
const CHANGE_RIDGE: f64 = 0.1;

/// The rate over a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rate {
    /// The rate w, in platform axes, rad/s.
    pub(crate) rate_rad_per_s: Vector,
    /// The same at the first row of the window.
    pub(crate) first_rad_per_s: Vector,
    /// Its component along the vertical, mean over the window, rad/s.
    pub(crate) vertical_rad_per_s: f64,
    /// Size of its horizontal part, rad/s.
    pub(crate) horizontal_rad_per_s: f64,
}

/// The rate over some complete rows; `None` if they do not determine it.
pub(crate) fn rate(rows: &[Complete]) -> Option<Rate> {
    let (first, last) = (rows.first()?, rows.last()?);
    let middle_s = 0.5 * (first.time_s + last.time_s);
    let half_s = 0.5 * (last.time_s - first.time_s);
    let parts = parts(rows, middle_s, half_s);
    if parts.len() < LEAST_PARTS {
        return None;
    }
    // Unknowns: the rate in the middle, and its change over half the window.
    let mut matrix = SMatrix::<f64, 6, 6>::zeros();
    let mut right = SVector::<f64, 6>::zeros();
    for part in &parts {
        // w × i is a matrix of i times w.
        let [of_rate, of_change] = part
            .integrals
            .map(|i| Matrix3::new(0.0, i[2], -i[1], -i[2], 0.0, i[0], i[1], -i[0], 0.0));
        let mut row = SMatrix::<f64, 3, 6>::zeros();
        row.fixed_columns_mut::<3>(0).copy_from(&of_rate);
        row.fixed_columns_mut::<3>(3).copy_from(&of_change);
        matrix += row.transpose() * row;
        right += row.transpose() * Vector3::from(part.change);
    }
    let rate_block = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let eigen = rate_block.symmetric_eigenvalues();
    if eigen.min() < LEAST_CONDITION * eigen.max() || !eigen.max().is_finite() {
        return None;
    }
    let part_s = 2.0 * half_s / parts.len() as f64;
    for change in 3..6 {
        matrix[(change, change)] += (CHANGE_RIDGE * part_s).powi(2);
    }
    let solved = matrix.cholesky()?.solve(&right);
    let at = |share: f64| core::array::from_fn(|i| solved[i] + share * solved[3 + i]);
    let vertical = |row: &Complete| dot(row.up, at((row.time_s - middle_s) / half_s));
    let size = |row: &Complete| norm(across(at((row.time_s - middle_s) / half_s), row.up));
    let count = rows.len() as f64;
    Some(Rate {
        rate_rad_per_s: at(0.0),
        first_rad_per_s: at(-1.0),
        vertical_rad_per_s: rows.iter().map(vertical).sum::<f64>() / count,
        horizontal_rad_per_s: rows.iter().map(size).sum::<f64>() / count,
    })
}

/// A part of a window.
struct Part {
    /// Change of the vertical.
    change: Vector,
    /// ∫ e dt, and the same with the time about the middle over half the window.
    integrals: [Vector; 2],
}

fn parts(rows: &[Complete], middle_s: f64, half_s: f64) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut integrals = [[0.0; 3]; 2];
    for at in 1..rows.len() {
        let (before, now) = (&rows[at - 1], &rows[at]);
        let interval_s = now.time_s - before.time_s;
        if interval_s > LONGEST_INTERVAL_S {
            start = at;
            integrals = [[0.0; 3]; 2];
            continue;
        }
        let shares = [before, now].map(|row| (row.time_s - middle_s) / half_s);
        let scaled = |of_before: f64, of_now: f64| {
            plus(before.up.map(|x| of_before * x), of_now, now.up).map(|x| 0.5 * interval_s * x)
        };
        integrals[0] = plus(integrals[0], 1.0, scaled(1.0, 1.0));
        integrals[1] = plus(integrals[1], 1.0, scaled(shares[0], shares[1]));
        if now.time_s - rows[start].time_s < PART_S && at + 1 < rows.len() {
            continue;
        }
        parts.push(Part {
            change: minus(now.up, rows[start].up),
            integrals,
        });
        start = at;
        integrals = [[0.0; 3]; 2];
    }
    parts
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

//! Calibration of gyros by the turns between stops: the integrated rate of a turn must rotate gravity
//! from one stop to the next.

use gyrocal_record::AXES;
use gyrocal_statistics::root_mean_square;
use nalgebra::{DMatrix, Matrix3, UnitQuaternion, Vector3};

use crate::error::{InstrumentError, Unfit};
use crate::least_squares::minimise;
use crate::log::Log;
use crate::stop_means::StopMeans;

/// Calibration of three gyros: body rate \[rad/s\] is `matrix` times (output - zero), in the axes of the
/// accelerometers.
#[derive(Debug, Clone, PartialEq)]
pub struct GyroCalibration {
    /// Rate from output.
    pub matrix: [[f64; 3]; 3],
    /// Standard deviations of its elements.
    pub sigma: [[f64; 3]; 3],
    /// Outputs per rad/s about the input axis of the gyro.
    pub outputs_per_rad_per_s: [f64; 3],
    /// Angles between input axes and the axes of the accelerometers.
    pub misalignment_rad: [f64; 3],
    /// Rms difference, per component, between rotated and measured gravity \[g\].
    pub gravity_rms_g: f64,
    /// Number of turns.
    pub turns: usize,
}

const UNKNOWNS: usize = 9;

/// Smaller turns are not used: they hardly determine a scale.
const SMALLEST_TURN_RAD: f64 = 0.2;

/// Fewer turns, with two numbers each, leave nearly no degrees of freedom for nine unknowns.
const FEWEST_TURNS: usize = 8;

struct Turn {
    before_g: Vector3<f64>,
    after_g: Vector3<f64>,
    /// Output above zero times the interval, sample by sample.
    increments: Vec<Vector3<f64>>,
}

/// Estimates scales and alignment of the gyros from the turns between stops, with specific force
/// `forces_g` at each stop. The zero of a turn is that of the stops around it. A turn in which a gyro is at the end of its
/// range is left out.
///
/// # Errors
///
/// [`Unfit::TooShort`] with too few turns; [`Unfit::Axes`] if the axes are left-handed or
/// differ between gyros and accelerometers; [`Unfit::Undetermined`] if the
/// turns are all about like axes; [`Unfit::GyroScale`] if the gyros do not explain the turns.
pub fn gyro_from_turns(
    log: &Log,
    stops: &[StopMeans],
    forces_g: &[[f64; 3]],
) -> Result<GyroCalibration, InstrumentError> {
    let turns = turns(log, stops, forces_g);
    if turns.len() < FEWEST_TURNS {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} turns between stops", turns.len()),
            format!("at least {FEWEST_TURNS} of {SMALLEST_TURN_RAD} rad or more"),
            "stop in more attitudes, or give the scale of the gyros",
        ));
    }
    let unit = first_scale(&turns);
    let cost = |matrix: &Matrix3<f64>| residuals(&turns, matrix).iter().map(|r| r * r).sum::<f64>();
    let starts = starts(unit);
    let mut ranked: Vec<(f64, Matrix3<f64>)> = starts
        .into_iter()
        .map(|start| (cost(&start), start))
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = ranked
        .iter()
        .take(3)
        .map(|(_, start)| {
            let start: Vec<f64> = (start / unit).iter().copied().collect();
            minimise(&start, &[1e-5; UNKNOWNS], |unknowns| {
                residuals(&turns, &(Matrix3::from_column_slice(unknowns) * unit))
            })
        })
        .min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let Some(best) = best else {
        return Err(undetermined());
    };
    let matrix = Matrix3::from_column_slice(&best.unknowns) * unit;
    // Two of the three components of a direction are free.
    let freedom = (2 * turns.len() - UNKNOWNS) as f64;
    let variance = best.cost() / freedom;
    let gravity_rms_g = (best.cost() / (3 * turns.len()) as f64).sqrt();
    let cofactors = best.cofactors.ok_or_else(undetermined)?;
    let sigma = sigmas(&cofactors, variance, unit);
    refuse_bad_fit(gravity_rms_g)?;
    let inverse = matrix.try_inverse().ok_or_else(undetermined)?;
    refuse_axes(&matrix, &inverse)?;
    let input_axes: [Vector3<f64>; 3] = core::array::from_fn(|gyro| inverse.row(gyro).transpose());
    Ok(GyroCalibration {
        matrix: rows(&matrix),
        sigma: rows(&sigma),
        outputs_per_rad_per_s: core::array::from_fn(|gyro| input_axes[gyro].norm()),
        misalignment_rad: core::array::from_fn(|gyro| {
            (input_axes[gyro][gyro] / input_axes[gyro].norm())
                .clamp(-1.0, 1.0)
                .acos()
        }),
        gravity_rms_g,
        turns: turns.len(),
    })
}

/// Refuses axes and signs that too few turns for a calibration contradict: with the given scale they leave gravity
/// unexplained, which axes in another order or of another sign explain.
///
/// # Errors
///
/// [`Unfit::Axes`].
pub(crate) fn refuse_axes_of_few_turns(
    log: &Log,
    stops: &[StopMeans],
    forces_g: &[[f64; 3]],
) -> Result<(), InstrumentError> {
    /// Gravity left unexplained, rms of a component, by axes that are wrong, and by right ones: a turn by a right
    /// angle the wrong way leaves 0.8.
    const WRONG_G: f64 = 0.3;
    const RIGHT_G: f64 = 0.05;
    let turns = turns(log, stops, forces_g);
    let rms_g = |matrix: &Matrix3<f64>| root_mean_square(residuals(&turns, matrix));
    if turns.is_empty() || rms_g(&Matrix3::identity()) < WRONG_G {
        return Ok(());
    }
    let axes = orders_and_signs().map(|axes| (rms_g(&axes), axes));
    match axes.min_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((rms_g, axes)) if rms_g < RIGHT_G => refuse_axes(&axes, &axes.transpose()),
        _ => Ok(()),
    }
}

fn turns(log: &Log, stops: &[StopMeans], forces_g: &[[f64; 3]]) -> Vec<Turn> {
    let pairs = stops.windows(2).zip(forces_g.windows(2));
    let is_within_range = |stops: &[StopMeans]| {
        let (from, to) = (stops[0].samples.end, stops[1].samples.start);
        let mut stretches = log.saturated.iter().map(|one| &one.samples);
        stretches.all(|samples| samples.end <= from || to <= samples.start)
    };
    pairs
        .filter(|(stops, _)| is_within_range(stops))
        .map(|(stops, forces_g)| {
            let (from, to) = (&stops[0], &stops[1]);
            let samples = from.samples.end..to.samples.start;
            let [first, last] = [from, to].map(|stop| Vector3::from(stop.gyro));
            let count = samples.len() as f64;
            let increment = |(step, sample): (usize, usize)| {
                let share = (step as f64 + 0.5) / count;
                let interval_s = log.time_s[sample] - log.time_s[sample - 1];
                (Vector3::from(log.gyro[sample]) - first.lerp(&last, share)) * interval_s
            };
            Turn {
                before_g: Vector3::from(forces_g[0]).normalize(),
                after_g: Vector3::from(forces_g[1]).normalize(),
                increments: samples.enumerate().map(increment).collect(),
            }
        })
        .filter(|turn| turn.before_g.angle(&turn.after_g) > SMALLEST_TURN_RAD)
        .collect()
}

/// Gravity rotated by the gyros, less measured gravity.
fn residuals(turns: &[Turn], matrix: &Matrix3<f64>) -> Vec<f64> {
    let residual = |turn: &Turn| {
        let mut attitude = UnitQuaternion::identity();
        for increment in &turn.increments {
            attitude *= UnitQuaternion::from_scaled_axis(matrix * increment);
        }
        let residual = attitude.inverse() * turn.before_g - turn.after_g;
        [residual.x, residual.y, residual.z]
    };
    turns.iter().flat_map(residual).collect()
}

/// The scale with which the integrated angles are as large as those between gravity before and after
/// the turns; the true one is larger by a factor of order one.
fn first_scale(turns: &[Turn]) -> f64 {
    let angles = turns.iter().map(|turn| turn.before_g.angle(&turn.after_g));
    let passed = turns
        .iter()
        .map(|turn| turn.increments.iter().sum::<Vector3<f64>>().norm());
    angles.sum::<f64>() / passed.sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Start values: axes in any order and of any sign, and scales around the first guess.
fn starts(unit: f64) -> Vec<Matrix3<f64>> {
    const SCALES: [f64; 5] = [0.6, 0.8, 1.0, 1.3, 1.7];
    let each = |axes: Matrix3<f64>| SCALES.map(|scale| axes * (scale * unit));
    orders_and_signs().flat_map(each).collect()
}

/// Axes in any order and of any sign.
fn orders_and_signs() -> impl Iterator<Item = Matrix3<f64>> {
    const ORDERS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [1, 0, 2],
        [0, 2, 1],
        [2, 1, 0],
    ];
    let signed = |order: [usize; 3]| {
        (0..8_u8).map(move |signs| {
            Matrix3::from_fn(|row, column| match order[row] == column {
                true if signs >> row & 1 == 1 => -1.0,
                true => 1.0,
                false => 0.0,
            })
        })
    };
    ORDERS.into_iter().flat_map(signed)
}

fn refuse_bad_fit(gravity_rms_g: f64) -> Result<(), InstrumentError> {
    const LARGEST_RMS_G: f64 = 0.1;
    if gravity_rms_g <= LARGEST_RMS_G {
        return Ok(());
    }
    Err(InstrumentError::unfit(
        Unfit::GyroScale,
        format!("turns that leave {gravity_rms_g:.2} g of gravity unexplained by any scale"),
        format!("at most {LARGEST_RMS_G} g"),
        "check that the columns are those of the gyros, that none is clipped, and that gyros and \
         accelerometers were sampled together",
    ))
}

fn refuse_axes(matrix: &Matrix3<f64>, inverse: &Matrix3<f64>) -> Result<(), InstrumentError> {
    let axes_of = |gyro: usize| {
        let row = inverse.row(gyro);
        let larger = |a: &usize, b: &usize| row[*a].abs().total_cmp(&row[*b].abs());
        let axis = (0..3).max_by(larger).unwrap_or(0);
        let sign = if row[axis] < 0.0 { "-" } else { "" };
        format!("{sign}{}", AXES[axis])
    };
    let found: Vec<String> = (0..3).map(axes_of).collect();
    if found == AXES {
        return Ok(());
    }
    let hand = if matrix.determinant() < 0.0 {
        "left-handed axes"
    } else {
        "other axes of the gyros than of the accelerometers"
    };
    Err(InstrumentError::unfit(
        Unfit::Axes,
        format!(
            "{hand}: by the turns, gyros x, y, z turn about {}",
            found.join(", ")
        ),
        "right-handed axes, the same for gyros and accelerometers, specific force up positive",
        "put the columns in order with `axes` in `[gyro]` or `[accel]`; if each sign is reversed, \
         the accelerometers may be down positive",
    ))
}

fn undetermined() -> InstrumentError {
    InstrumentError::unfit(
        Unfit::Undetermined,
        "turns that leave a scale or an angle of the gyros undetermined",
        "turns about each axis",
        "turn about more axes, or give the scale of the gyros",
    )
}

fn sigmas(cofactors: &DMatrix<f64>, variance: f64, unit: f64) -> Matrix3<f64> {
    let sigma = (0..UNKNOWNS).map(|i| (cofactors[(i, i)] * variance).sqrt() * unit);
    Matrix3::from_iterator(sigma)
}

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    core::array::from_fn(|row| core::array::from_fn(|column| matrix[(row, column)]))
}

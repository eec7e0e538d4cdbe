//! Calibration of accelerometers by the norm of specific force at rest, which is 1 g in any attitude.

use gyrocal_record::AXES;
use gyrocal_statistics::upper_median;

use crate::error::{InstrumentError, Unfit};
use crate::least_squares::{Minimum, minimise};
use crate::stop_means::StopMeans;

/// Calibration of three accelerometers: specific force \[g\] is `matrix` times (output - `zero`), in axes
/// defined by body x and the plane of body x and y.
#[derive(Debug, Clone, PartialEq)]
pub struct AccelCalibration {
    /// Output at zero specific force.
    pub zero: [f64; 3],
    /// Upper triangular: scales on the diagonal, misalignments above it.
    pub matrix: [[f64; 3]; 3],
    /// Rms residual of the norm over the stops, for the degrees of freedom left \[g\].
    pub norm_rms_g: f64,
}

impl AccelCalibration {
    /// Specific force of an output \[g\].
    #[must_use]
    pub fn force_g(&self, output: [f64; 3]) -> [f64; 3] {
        let above: [f64; 3] = core::array::from_fn(|axis| output[axis] - self.zero[axis]);
        self.matrix.map(|row| {
            row.iter()
                .zip(above)
                .map(|(factor, above)| factor * above)
                .sum()
        })
    }
}

const UNKNOWNS: usize = 9;

/// Estimates scales, zeros and misalignments from stops in many attitudes.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer than three stops more than unknowns, [`Unfit::Undetermined`] if
/// their attitudes do not determine the unknowns, [`Unfit::Norm`] if the norms do not fit.
pub fn accel_from_norm(stops: &[StopMeans]) -> Result<AccelCalibration, InstrumentError> {
    if stops.len() < UNKNOWNS + 3 {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} static stops", stops.len()),
            format!("at least {} for scales from the stops", UNKNOWNS + 3),
            "stop in more attitudes, or give the scale of the accelerometers",
        ));
    }
    let ranges = ranges(stops)?;
    let minimum = fit(stops, &ranges);
    let freedom = (stops.len() - UNKNOWNS) as f64;
    let norm_rms_g = (minimum.cost() / freedom).sqrt();
    let largest_sigma = minimum
        .cofactors
        .map_or(f64::INFINITY, |cofactors| cofactors.diagonal().max().sqrt());
    // Ten times the sigma of one stop along each axis.
    if largest_sigma > 10.0 {
        return Err(undetermined("attitudes too much alike".to_owned()));
    }
    const LARGEST_RMS_G: f64 = 0.02;
    if norm_rms_g > LARGEST_RMS_G {
        return Err(InstrumentError::unfit(
            Unfit::Norm,
            format!("norms of specific force that scatter by {norm_rms_g:.3} g at the stops"),
            format!("1 g in each attitude within {LARGEST_RMS_G} g"),
            "check that the three columns are the accelerometers, that none is clipped and that \
             the stops are at rest",
        ));
    }
    let (zero, matrix) = unpack(&minimum.unknowns);
    Ok(AccelCalibration {
        zero: core::array::from_fn(|axis| ranges[axis].middle + zero[axis] * ranges[axis].half),
        matrix: matrix.map(|row| core::array::from_fn(|axis| row[axis] / ranges[axis].half)),
        norm_rms_g,
    })
}

/// Range of the outputs of one accelerometer over the stops.
struct OutputRange {
    middle: f64,
    /// Half its width.
    half: f64,
}

/// The ranges of the three accelerometers, none of which may be much narrower than the widest.
fn ranges(stops: &[StopMeans]) -> Result<[OutputRange; 3], InstrumentError> {
    let ranges = core::array::from_fn(|axis| {
        let outputs = stops.iter().map(|stop| stop.accel[axis]);
        let low = outputs.clone().fold(f64::INFINITY, f64::min);
        let high = outputs.fold(f64::NEG_INFINITY, f64::max);
        OutputRange {
            middle: 0.5 * (low + high),
            half: 0.5 * (high - low),
        }
    });
    let widest = ranges.iter().map(|range| range.half).fold(0.0, f64::max);
    match (0..3).find(|axis| ranges[*axis].half < 0.3 * widest) {
        None => Ok(ranges),
        Some(axis) => {
            let name = AXES[axis];
            Err(undetermined(format!(
                "accelerometer {name} in few attitudes"
            )))
        }
    }
}

/// Least squares of the norms. Outputs are scaled by their ranges, so that all unknowns are of order
/// one.
fn fit(stops: &[StopMeans], ranges: &[OutputRange; 3]) -> Minimum {
    let scaled: Vec<[f64; 3]> = stops
        .iter()
        .map(|stop| {
            core::array::from_fn(|axis| {
                (stop.accel[axis] - ranges[axis].middle) / ranges[axis].half
            })
        })
        .collect();
    let residuals = |unknowns: &[f64]| {
        let (zero, matrix) = unpack(unknowns);
        let residual = |output: &[f64; 3]| {
            let force = matrix.map(|row| {
                (0..3)
                    .map(|axis| row[axis] * (output[axis] - zero[axis]))
                    .sum::<f64>()
            });
            force
                .iter()
                .map(|component| component * component)
                .sum::<f64>()
                .sqrt()
                - 1.0
        };
        scaled.iter().map(residual).collect()
    };
    let start = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    minimise(&start, &[1e-5; UNKNOWNS], residuals)
}

fn undetermined(found: String) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::Undetermined,
        found,
        "stops with each axis up and down and in between",
        "stop in more attitudes, or give the scale of the accelerometers",
    )
}

/// Zero and matrix of the unknowns.
fn unpack(unknowns: &[f64]) -> ([f64; 3], [[f64; 3]; 3]) {
    let u = unknowns;
    let matrix = [[u[3], u[6], u[7]], [0.0, u[4], u[8]], [0.0, 0.0, u[5]]];
    ([u[0], u[1], u[2]], matrix)
}

/// Refuses stops at which the norm of specific force is not gravity, and suggests the unit.
///
/// # Errors
///
/// [`Unfit::Norm`].
pub fn refuse_wrong_norm(norms_g: impl Iterator<Item = f64>) -> Result<(), InstrumentError> {
    let mut norms: Vec<f64> = norms_g.collect();
    let median = upper_median(&mut norms).unwrap_or(f64::NAN);
    if (0.9..=1.1).contains(&median) {
        return Ok(());
    }
    let near = |expected: f64| (0.9..=1.1).contains(&(median / expected));
    let advice = if near(9.81) {
        "the columns seem to be in m/s^2: say `unit = \"m/s2\"`"
    } else if near(1.0 / 9.81) {
        "the columns seem to be in g: say `unit = \"g\"`"
    } else if near(1e3) || near(1e3 / 9.81) {
        "the columns seem to be in milli-g: divide them by 1000"
    } else if median < 0.1 {
        "gravity seems to have been removed, or the unit is larger than it says"
    } else {
        "check unit, scale and zero of the accelerometers"
    };
    Err(InstrumentError::unfit(
        Unfit::Norm,
        format!("a norm of specific force at rest of {median:.4} g"),
        "1 g within a tenth",
        advice,
    ))
}

//! Accelerometers calibrated by the norm of specific force at rest, which is 1 g in any attitude.

use gyrocal_statistics::upper_median;

use crate::average::Stop;
use crate::error::{MeasuredError, Unfit};
use crate::least_squares::minimise;

/// Specific force \[g\] is `matrix` times (output - `zero`), in axes that body x and the plane of
/// body x and y define.
#[derive(Debug, Clone, PartialEq)]
pub struct AccelCalibration {
    /// Output at zero specific force.
    pub zero: [f64; 3],
    /// Upper triangular: scales on the diagonal, misalignments beside it.
    pub matrix: [[f64; 3]; 3],
    /// What is left of the norm, rms over the stops, with the unknowns taken off \[g\].
    pub norm_rms_g: f64,
}

impl AccelCalibration {
    /// Specific force from an output.
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

/// Finds scales, zeros and misalignments from stops in many attitudes.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer stops than unknowns and three more, [`Unfit::Undetermined`] if
/// their attitudes do not determine the unknowns, [`Unfit::Norm`] if the norms do not fit.
pub fn calibrate_by_norm(stops: &[Stop]) -> Result<AccelCalibration, MeasuredError> {
    if stops.len() < UNKNOWNS + 3 {
        return Err(MeasuredError::unfit(
            Unfit::TooShort,
            format!("{} static stops", stops.len()),
            format!("at least {} for scales from the stops", UNKNOWNS + 3),
            "stop in more attitudes, or give the scale of the accelerometers",
        ));
    }
    let range = |axis: usize| {
        let outputs = stops.iter().map(|stop| stop.accel[axis]);
        let low = outputs.clone().fold(f64::INFINITY, f64::min);
        let high = outputs.fold(f64::NEG_INFINITY, f64::max);
        (0.5 * (low + high), 0.5 * (high - low))
    };
    let ranges = [range(0), range(1), range(2)];
    let undetermined = |found: String| {
        MeasuredError::unfit(
            Unfit::Undetermined,
            found,
            "stops with each axis up and down and in between",
            "stop in more attitudes, or give the scale of the accelerometers",
        )
    };
    let widest = ranges.iter().map(|(_, half)| *half).fold(0.0, f64::max);
    if let Some(axis) = (0..3).find(|axis| ranges[*axis].1 < 0.3 * widest) {
        let name = ["x", "y", "z"][axis];
        return Err(undetermined(format!(
            "accelerometer {name} in few attitudes"
        )));
    }
    // In the unit of the first guess, so that all unknowns are of order one.
    let scaled: Vec<[f64; 3]> = stops
        .iter()
        .map(|stop| {
            core::array::from_fn(|axis| (stop.accel[axis] - ranges[axis].0) / ranges[axis].1)
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
    let minimum = minimise(&start, &[1e-5; UNKNOWNS], residuals);
    let freedom = (stops.len() - UNKNOWNS) as f64;
    let norm_rms_g = (minimum.cost() / freedom).sqrt();
    let largest_sigma = minimum
        .cofactors
        .map_or(f64::INFINITY, |cofactors| cofactors.diagonal().max().sqrt());
    // Ten times the sigma that one stop along each axis would give.
    if largest_sigma > 10.0 {
        return Err(undetermined("attitudes too much alike".to_owned()));
    }
    const LARGEST_RMS_G: f64 = 0.02;
    if norm_rms_g > LARGEST_RMS_G {
        return Err(MeasuredError::unfit(
            Unfit::Norm,
            format!("norms of specific force that scatter by {norm_rms_g:.3} g at the stops"),
            format!("1 g in each attitude within {LARGEST_RMS_G} g"),
            "check that the three columns are the accelerometers, that none is clipped and that \
             the stops are at rest",
        ));
    }
    let (zero, matrix) = unpack(&minimum.unknowns);
    Ok(AccelCalibration {
        zero: core::array::from_fn(|axis| ranges[axis].0 + zero[axis] * ranges[axis].1),
        matrix: matrix.map(|row| core::array::from_fn(|axis| row[axis] / ranges[axis].1)),
        norm_rms_g,
    })
}

fn unpack(unknowns: &[f64]) -> ([f64; 3], [[f64; 3]; 3]) {
    let u = unknowns;
    let matrix = [[u[3], u[6], u[7]], [0.0, u[4], u[8]], [0.0, 0.0, u[5]]];
    ([u[0], u[1], u[2]], matrix)
}

/// Refuses stops whose norm is not gravity, and says what the unit seems to be.
///
/// # Errors
///
/// [`Unfit::Norm`].
pub fn refuse_wrong_norm(norms_g: impl Iterator<Item = f64>) -> Result<(), MeasuredError> {
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
    Err(MeasuredError::unfit(
        Unfit::Norm,
        format!("a norm of specific force at rest of {median:.4} g"),
        "1 g within a tenth",
        advice,
    ))
}

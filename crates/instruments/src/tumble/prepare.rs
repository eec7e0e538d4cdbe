//! From a log to what the drift law is fitted to.

use core::ops::Range;

use serde::Serialize;

use super::{Instrument, Positions};
use crate::average::{Stop, average};
use crate::description::Description;
use crate::error::{MeasuredError, Unfit};
use crate::log::Log;
use crate::norms::{calibrate_by_norm, refuse_wrong_norm};
use crate::turns::{GyroCalibration, calibrate_by_turns};

/// A log reduced to its stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// The means of the stops, in the unit of the log.
    pub stops: Vec<Stop>,
    /// What is known of the sensors and the site.
    pub instrument: Instrument,
    /// Gyros by the turns between stops; `None` if their scale was given and the turns are too
    /// few to check it.
    pub turns: Option<GyroCalibration>,
    /// Rates and specific force at the stops.
    pub positions: Positions,
}

/// What the sensors were found to be, for programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensorReport {
    /// Zero of the accelerometers, if it was estimated.
    pub accel_zero: Option<[f64; 3]>,
    /// Outputs of the accelerometers in 1 g, if they were estimated.
    pub accel_outputs_per_g: Option<[f64; 3]>,
    /// Norm of specific force less 1 g, rms over the stops \[g\].
    pub norm_rms_g: f64,
    /// Outputs of the gyros in 1 rad/s by the turns.
    pub gyro_outputs_per_rad_per_s: Option<[f64; 3]>,
    /// Angles of the gyros' input axes from the axes of the accelerometers, by the turns.
    pub gyro_misalignment_rad: Option<[f64; 3]>,
    /// Gravity carried over by the turns against gravity measured, rms a component \[g\].
    pub turn_rms_g: Option<f64>,
}

/// A scale by the turns that differs from the one that was given by more than this share
/// contradicts it.
const LARGEST_SCALE_ERROR: f64 = 0.1;

/// Averages stops and takes them to physical units.
///
/// # Errors
///
/// What [`calibrate_by_norm`] and [`calibrate_by_turns`] say where scales are estimated;
/// [`Unfit::Norm`], [`Unfit::GyroScale`] and [`Unfit::Axes`] where given scales and axes
/// contradict the stops and the turns between them.
pub fn prepare(
    log: &Log,
    description: &Description,
    stops: &[Range<usize>],
) -> Result<Prepared, MeasuredError> {
    let stops = average(log, stops);
    let accel = match log.accel_in_counts {
        true => Some(calibrate_by_norm(&stops)?),
        false => None,
    };
    let forces_g: Vec<[f64; 3]> = stops
        .iter()
        .map(|stop| match &accel {
            Some(calibration) => calibration.force_g(stop.accel),
            None => stop.accel,
        })
        .collect();
    refuse_wrong_norm(forces_g.iter().map(norm))?;
    let turns = match calibrate_by_turns(log, &stops, &forces_g) {
        Ok(turns) => Some(turns),
        // A scale that was given needs no turns.
        Err(error) if !log.gyro_in_counts && is_for_want_of_turns(&error) => None,
        Err(error) => return Err(error),
    };
    let outputs_per_rad_per_s = match &turns {
        Some(turns) if log.gyro_in_counts => turns.outputs_per_rad_per_s,
        Some(turns) => {
            refuse_wrong_scale(turns)?;
            [1.0; 3]
        }
        None => [1.0; 3],
    };
    let instrument = Instrument {
        accel,
        outputs_per_rad_per_s,
        latitude_deg: description.site.latitude_deg,
    };
    Ok(Prepared {
        positions: Positions::new(&stops, &instrument),
        stops,
        instrument,
        turns,
    })
}

impl Prepared {
    /// What the sensors were found to be.
    #[must_use]
    pub fn sensors(&self) -> SensorReport {
        let accel = self.instrument.accel.as_ref();
        let forces = &self.positions.force_g;
        let squares = forces.iter().map(|force| (norm(force) - 1.0).powi(2));
        let turns = self.turns.as_ref();
        SensorReport {
            accel_zero: accel.map(|accel| accel.zero),
            accel_outputs_per_g: accel
                .map(|accel| core::array::from_fn(|axis| 1.0 / accel.matrix[axis][axis])),
            norm_rms_g: match accel {
                Some(accel) => accel.norm_rms_g,
                None => (squares.sum::<f64>() / forces.len() as f64).sqrt(),
            },
            gyro_outputs_per_rad_per_s: turns.map(|turns| turns.outputs_per_rad_per_s),
            gyro_misalignment_rad: turns.map(|turns| turns.misalignment_rad),
            turn_rms_g: turns.map(|turns| turns.gravity_rms_g),
        }
    }
}

fn norm(force_g: &[f64; 3]) -> f64 {
    force_g
        .iter()
        .map(|component| component * component)
        .sum::<f64>()
        .sqrt()
}

fn is_for_want_of_turns(error: &MeasuredError) -> bool {
    matches!(error.kind(), Some(Unfit::TooShort | Unfit::Undetermined))
}

fn refuse_wrong_scale(turns: &GyroCalibration) -> Result<(), MeasuredError> {
    let wrong = |outputs: &&f64| (**outputs - 1.0).abs() > LARGEST_SCALE_ERROR;
    let Some(outputs) = turns.outputs_per_rad_per_s.iter().find(wrong) else {
        return Ok(());
    };
    let near = |expected: f64| (0.9..=1.1).contains(&(outputs / expected));
    let degrees = 1.0_f64.to_degrees();
    let advice = if near(degrees) {
        "the columns seem to be in deg/s where rad/s were expected: change `unit`"
    } else if near(1.0 / degrees) {
        "the columns seem to be in rad/s where deg/s were expected: change `unit`"
    } else if near(3600.0) || near(degrees * 3600.0) {
        "the columns seem to be in deg/h: change `unit`"
    } else if near(1.0 / 3600.0) || near(1.0 / (degrees * 3600.0)) {
        "the columns seem not to be in deg/h: change `unit`"
    } else {
        "check unit and scale of the gyros; in counts, `counts_per_rad_per_s = \"from-turns\"` \
         estimates it"
    };
    Err(MeasuredError::unfit(
        Unfit::GyroScale,
        format!("gyros that read {outputs:.4} where the turns between stops are 1 rad"),
        "1 within a tenth",
        advice,
    ))
}

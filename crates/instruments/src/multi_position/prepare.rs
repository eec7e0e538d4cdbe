//! Reduction of a log to rates and specific force at its stops.

use core::ops::Range;

use serde::Serialize;

use super::positions::{Instrument, Positions};
use super::saturated_turns::{SaturatedTurn, refuse_saturated_stops, saturated_turns};
use crate::accel_from_norm::{accel_from_norm, refuse_wrong_norm};
use crate::accel_from_positions::{AccelErrors, accel_from_positions};
use crate::description::Description;
use crate::error::{InstrumentError, Unfit};
use crate::gyro_from_turns::{GyroCalibration, gyro_from_turns, refuse_axes_of_few_turns};
use crate::log::{BadSamples, Log, of_logs, refuse_still_at_stops};
use crate::stop_means::{StopMeans, stop_means};

/// A log reduced to its stops.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedTest {
    /// Means of the stops, in the unit of the log.
    pub stops: Vec<StopMeans>,
    /// Calibration constants of the sensors, and the site.
    pub instrument: Instrument,
    /// Errors of accelerometers in physical units; `None` for those in raw counts, and for one stop.
    pub accel_errors: Option<AccelErrors>,
    /// Calibration of the gyros from the turns between stops; `None` if their scale is given and the
    /// turns are too few to check it.
    pub turns: Option<GyroCalibration>,
    /// Turns that are left out of it, since a gyro is at the end of its range.
    pub saturated_turns: Vec<SaturatedTurn>,
    /// Samples of the logs that no noise explains.
    pub bad_samples: Vec<BadSamples>,
    /// Rates and specific force at the stops.
    pub positions: Positions,
}

/// A stop, as it is serialised.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StopReport {
    /// Time of its first sample.
    pub from_s: f64,
    /// Time of its last sample.
    pub to_s: f64,
    /// Number of samples.
    pub samples: usize,
    /// Mean specific force.
    pub force_g: [f64; 3],
    /// Mean rates, less the vertical part of Earth rate if the latitude is given.
    pub rate_deg_per_h: [f64; 3],
    /// Their standard errors.
    pub sigma_deg_per_h: [f64; 3],
}

/// Calibration of the sensors, as it is serialised.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SensorReport {
    /// The stops, in the order of time.
    pub stops: Vec<StopReport>,
    /// Errors of accelerometers in physical units with their covariance.
    pub accel_errors: Option<AccelErrors>,
    /// Zero of the accelerometers in raw counts, if estimated.
    pub accel_zero: Option<[f64; 3]>,
    /// Outputs of accelerometers in raw counts per g, if estimated.
    pub accel_outputs_per_g: Option<[f64; 3]>,
    /// Norm of specific force less 1 g, rms over the stops \[g\].
    pub norm_rms_g: f64,
    /// Outputs of the gyros per rad/s, from the turns.
    pub gyro_outputs_per_rad_per_s: Option<[f64; 3]>,
    /// Rate \[rad/s\] from gyro outputs, in the axes of the accelerometers, from the turns.
    pub gyro_matrix: Option<[[f64; 3]; 3]>,
    /// Standard deviations of its elements.
    pub gyro_matrix_sigma: Option<[[f64; 3]; 3]>,
    /// Angles between the input axes of the gyros and the axes of the accelerometers, from the turns.
    pub gyro_misalignment_rad: Option<[f64; 3]>,
    /// Rms difference, per component, between gravity rotated by the turns and measured gravity \[g\].
    pub turn_rms_g: Option<f64>,
    /// Turns that these leave out, since a gyro is at the end of its range.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub saturated_turns: Vec<SaturatedTurn>,
    /// Samples that no noise explains, each with the median of those about it in its place.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bad_samples: Vec<BadSamples>,
}

/// Largest relative difference between the scale from the turns and the given one.
const LARGEST_SCALE_ERROR: f64 = 0.1;

/// Averages a log over stops and converts the means to physical units.
///
/// # Errors
///
/// As [`accel_from_norm`] and [`gyro_from_turns`] where scales are estimated; [`Unfit::Norm`],
/// [`Unfit::GyroScale`] and [`Unfit::Axes`] where given scales and axes contradict the stops and
/// the turns between them; [`Unfit::NoAccelerometers`]; [`Unfit::Saturated`] where a gyro is at the end of its range
/// at a stop; [`Unfit::Stuck`] where it repeats a value there and scatters at the others. A turn in which it is there is left out.
pub fn prepare(
    log: &Log,
    description: &Description,
    stops: &[Range<usize>],
) -> Result<PreparedTest, InstrumentError> {
    refuse_saturated_stops(log, stops)?;
    refuse_still_at_stops(log, stops)?;
    let stops = stop_means(log, stops)?;
    prepare_means(log, description, stops, true)
}

/// The same for several logs of one unit, one or more positions each. Nothing is known of the turns
/// from one log to the next. Where the clocks of the logs start anew they are joined.
///
/// # Errors
///
/// As [`prepare`]; [`Unfit::TooShort`] without a log; [`Unfit::NoScale`] if the scale of the gyros is to
/// come from turns.
pub fn prepare_logs(
    logs: &[(Log, Vec<Range<usize>>)],
    description: &Description,
) -> Result<PreparedTest, InstrumentError> {
    let Some((first, stops)) = logs.first() else {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            "no log",
            "one or more",
            "give the logs of the positions",
        ));
    };
    if logs.len() == 1 {
        return prepare(first, description, stops);
    }
    if first.gyro_in_counts {
        return Err(InstrumentError::unfit(
            Unfit::NoScale,
            "gyros in counts in several logs without the turns between them",
            "their scale",
            "give `counts_per_rad_per_s` as numbers",
        ));
    }
    let mut means: Vec<StopMeans> = Vec::new();
    let mut numbers: Vec<usize> = Vec::new();
    let mut end_s = f64::NEG_INFINITY;
    for (number, (log, stops)) in logs.iter().enumerate() {
        refuse_saturated_stops(log, stops)?;
        refuse_still_at_stops(log, stops)?;
        let (Some(from_s), Some(to_s)) = (log.time_s.first(), log.time_s.last()) else {
            continue;
        };
        let later_s = match *from_s > end_s {
            true => 0.0,
            false => end_s - from_s + log.interval_s,
        };
        means.extend(stop_means(log, stops)?.into_iter().map(|stop| StopMeans {
            from_s: stop.from_s + later_s,
            to_s: stop.to_s + later_s,
            time_s: stop.time_s + later_s,
            ..stop
        }));
        numbers.resize(means.len(), number);
        end_s = to_s + later_s;
    }
    let prepared = prepare_means(first, description, means, false)?;
    Ok(PreparedTest {
        positions: prepared.positions.of_logs(numbers),
        bad_samples: of_logs(logs.iter().map(|(log, _)| log)),
        ..prepared
    })
}

/// Converts means of stops. `has_turns` if they are all of this log, with the turns between them.
fn prepare_means(
    log: &Log,
    description: &Description,
    stops: Vec<StopMeans>,
    has_turns: bool,
) -> Result<PreparedTest, InstrumentError> {
    let (accel, accel_errors) = match log.accel_in_counts {
        true => (Some(accel_from_norm(&stops)?), None),
        false => {
            refuse_wrong_norm(stops.iter().map(|stop| norm(&stop.accel)))?;
            let errors = accel_from_positions(&stops).ok();
            (
                errors.as_ref().map(|errors| errors.calibration.clone()),
                errors,
            )
        }
    };
    let forces_g: Vec<[f64; 3]> = stops
        .iter()
        .map(|stop| match &accel {
            Some(calibration) => calibration.force_g(stop.accel),
            None => stop.accel,
        })
        .collect();
    refuse_wrong_norm(forces_g.iter().map(norm))?;
    let from_turns = match has_turns {
        true => Some(gyro_from_turns(log, &stops, &forces_g)),
        false => None,
    };
    let turns = match from_turns.transpose() {
        Ok(turns) => turns,
        // A given scale needs no turns.
        Err(error) if !log.gyro_in_counts && has_too_few_turns(&error) => {
            refuse_axes_of_few_turns(log, &stops, &forces_g)?;
            None
        }
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
    Ok(PreparedTest {
        positions: Positions::new(&stops, &instrument),
        saturated_turns: match has_turns {
            true => saturated_turns(log, &stops),
            false => Vec::new(),
        },
        bad_samples: of_logs([log]),
        stops,
        instrument,
        accel_errors,
        turns,
    })
}

impl PreparedTest {
    /// Calibration of the sensors.
    #[must_use]
    pub fn sensors(&self) -> SensorReport {
        let accel = self.instrument.accel.as_ref();
        let in_counts = accel.filter(|_| self.accel_errors.is_none());
        let forces = &self.positions.force_g;
        let squares = forces.iter().map(|force| (norm(force) - 1.0).powi(2));
        let turns = self.turns.as_ref();
        SensorReport {
            stops: self
                .stops
                .iter()
                .enumerate()
                .map(|stop| self.stop_report(stop))
                .collect(),
            accel_errors: self.accel_errors.clone(),
            accel_zero: in_counts.map(|accel| accel.zero),
            accel_outputs_per_g: in_counts
                .map(|accel| core::array::from_fn(|axis| 1.0 / accel.matrix[axis][axis])),
            norm_rms_g: match accel {
                Some(accel) => accel.norm_rms_g,
                None => (squares.sum::<f64>() / forces.len() as f64).sqrt(),
            },
            gyro_outputs_per_rad_per_s: turns.map(|turns| turns.outputs_per_rad_per_s),
            gyro_matrix: turns.map(|turns| turns.matrix),
            gyro_matrix_sigma: turns.map(|turns| turns.sigma),
            gyro_misalignment_rad: turns.map(|turns| turns.misalignment_rad),
            turn_rms_g: turns.map(|turns| turns.gravity_rms_g),
            saturated_turns: self.saturated_turns.clone(),
            bad_samples: self.bad_samples.clone(),
        }
    }
}

impl PreparedTest {
    fn stop_report(&self, (number, stop): (usize, &StopMeans)) -> StopReport {
        StopReport {
            from_s: stop.from_s,
            to_s: stop.to_s,
            samples: stop.samples.len(),
            force_g: self.positions.force_g[number],
            rate_deg_per_h: self.positions.rate_deg_per_h[number],
            sigma_deg_per_h: self.positions.sigma_deg_per_h[number],
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

fn has_too_few_turns(error: &InstrumentError) -> bool {
    matches!(error.kind(), Some(Unfit::TooShort | Unfit::Undetermined))
}

fn refuse_wrong_scale(turns: &GyroCalibration) -> Result<(), InstrumentError> {
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
    Err(InstrumentError::unfit(
        Unfit::GyroScale,
        format!("gyros that read {outputs:.4} where the turns between stops are 1 rad"),
        "1 within a tenth",
        advice,
    ))
}

//! Factors from the numbers of a log to rad/s and g, by its description.

use crate::description::{Accel, CountScale, Gyro, GyroUnit, Site};
use crate::error::{InstrumentError, Unfit};

/// Factor from counts above zero to rad/s; `None` if turns are to determine it.
pub(crate) fn gyro_scale(gyro: &Gyro) -> Result<Option<[f64; 3]>, InstrumentError> {
    let per_hour = 1.0_f64.to_radians() / 3600.0;
    match (gyro.unit, gyro.counts_per_rad_per_s) {
        (GyroUnit::RadPerS, _) => Ok(Some([1.0; 3])),
        (GyroUnit::DegPerS, _) => Ok(Some([1.0_f64.to_radians(); 3])),
        (GyroUnit::DegPerH, _) => Ok(Some([per_hour; 3])),
        (GyroUnit::Counts, Some(scale)) => Ok(per_unit(scale)),
        (GyroUnit::Counts, None) => Err(no_scale("gyro", "counts_per_rad_per_s", "from-turns")),
    }
}

/// Factor from counts above zero to g; `None` if stops are to determine it.
pub(crate) fn accel_scale(accel: &Accel, site: &Site) -> Result<Option<[f64; 3]>, InstrumentError> {
    let gravity = site.gravity_m_per_s2.unwrap_or(f64::NAN);
    match (accel.unit.in_g(gravity), accel.counts_per_g) {
        (Some(factor), _) => Ok(Some([factor; 3])),
        (None, Some(scale)) => Ok(per_unit(scale)),
        (None, None) => Err(no_scale("accel", "counts_per_g", "from-stops")),
    }
}

fn per_unit(scale: CountScale) -> Option<[f64; 3]> {
    match scale {
        CountScale::Same(counts) => Some([1.0 / counts; 3]),
        CountScale::Each(counts) => Some(counts.map(|counts| 1.0 / counts)),
        CountScale::Estimate(_) => None,
    }
}

fn no_scale(table: &str, key: &str, estimate: &str) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::NoScale,
        format!("`[{table}]` in counts without `{key}`"),
        "what a count is",
        format!(
            "give `{key}`, or `{key} = \"{estimate}\"` for a log with static stops in many \
             attitudes"
        ),
    )
}

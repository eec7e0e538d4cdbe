//! Checks of a record before anything is estimated from it.

use gyrocal::Platform;
use gyrocal_record::Record;

use crate::error::CalibrationError;

/// Checks that the columns of a record are of one length, and that at least as many rows have a value
/// of an accelerometer as the nominal model has states.
///
/// # Errors
///
/// [`CalibrationError::UnequalLengths`] and [`CalibrationError::TooShort`].
pub fn check_record(record: &Record) -> Result<(), CalibrationError> {
    check_lengths(record)?;
    let found = record.measured_rows();
    if found < Platform::STATES {
        return Err(CalibrationError::TooShort {
            found,
            expected: Platform::STATES,
        });
    }
    Ok(())
}

/// Checks that a record has as many samples as times.
pub(crate) fn check_lengths(record: &Record) -> Result<(), CalibrationError> {
    if record.time_s.len() == record.accel_g.len() {
        return Ok(());
    }
    Err(CalibrationError::UnequalLengths {
        times: record.time_s.len(),
        samples: record.accel_g.len(),
    })
}

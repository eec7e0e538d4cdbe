use gyrocal::ControllerError;

/// The call did as it was told.
pub const GYROCAL_OK: i32 = 0;
/// Refused: a component of the sample is infinite or no number.
pub const GYROCAL_SAMPLE_NOT_FINITE: i32 = 1;
/// Refused: a component of the sample is beyond the range of the sensor.
pub const GYROCAL_SAMPLE_OUT_OF_RANGE: i32 = 2;
/// Refused: the interval is zero, negative or no number.
pub const GYROCAL_INTERVAL_NOT_POSITIVE: i32 = 3;
/// Refused: the interval is longer than the limit.
pub const GYROCAL_INTERVAL_TOO_LONG: i32 = 4;
/// Refused: a saved state has another length.
pub const GYROCAL_SAVED_LENGTH: i32 = 5;
/// Refused: a saved state is of another version, model or number type.
pub const GYROCAL_SAVED_VERSION: i32 = 6;
/// Refused: the checksum of a saved state is wrong.
pub const GYROCAL_SAVED_CHECKSUM: i32 = 7;
/// Refused: a number of a saved state has no meaning, such as a variance that is not positive.
pub const GYROCAL_SAVED_NUMBERS: i32 = 8;
/// Refused: a pointer is null.
pub const GYROCAL_NULL: i32 = 9;
/// The NIS of the sample is beyond the limit. It was not taken; the time of the call has passed without it,
/// so it needs no gyrocal_coast.
pub const GYROCAL_SAMPLE_SURPRISING: i32 = 10;
/// As GYROCAL_SAMPLE_SURPRISING, and so were all samples of the last hour, ten at least: it is the filter
/// that is wrong. gyrocal_reopen takes the sample all the same.
pub const GYROCAL_DIVERGED: i32 = 11;
/// No sample was taken since gyrocal_init, and the attitude has become too uncertain meanwhile for a first
/// one: initialise again at a sample. The time of the call has passed.
pub const GYROCAL_GAP_AT_START: i32 = 12;
/// The memory holds no filter, or the filter has stopped: initialise or restore it.
pub const GYROCAL_NOT_RUNNING: i32 = -1;
/// A setting is outside its domain: the filter is not running.
pub const GYROCAL_SETTINGS: i32 = -2;
/// The step failed, and the filter has stopped: initialise or restore it.
pub const GYROCAL_FAILED: i32 = -3;

pub(crate) fn of<T>(result: Result<T, ControllerError>) -> i32 {
    match result {
        Ok(_) => GYROCAL_OK,
        Err(ControllerError::SampleNotFinite { .. }) => GYROCAL_SAMPLE_NOT_FINITE,
        Err(ControllerError::SampleOutOfRange { .. }) => GYROCAL_SAMPLE_OUT_OF_RANGE,
        Err(ControllerError::IntervalNotPositive) => GYROCAL_INTERVAL_NOT_POSITIVE,
        Err(ControllerError::IntervalTooLong) => GYROCAL_INTERVAL_TOO_LONG,
        Err(ControllerError::SavedLength { .. }) => GYROCAL_SAVED_LENGTH,
        Err(ControllerError::SavedVersion) => GYROCAL_SAVED_VERSION,
        Err(ControllerError::SavedChecksum) => GYROCAL_SAVED_CHECKSUM,
        Err(ControllerError::SavedNumbers) => GYROCAL_SAVED_NUMBERS,
        Err(ControllerError::SampleSurprising) => GYROCAL_SAMPLE_SURPRISING,
        Err(ControllerError::Diverged) => GYROCAL_DIVERGED,
        Err(ControllerError::GapAtStart) => GYROCAL_GAP_AT_START,
        Err(ControllerError::NotRunning) => GYROCAL_NOT_RUNNING,
        Err(ControllerError::Settings(_)) => GYROCAL_SETTINGS,
        // What a later version adds is a failure until it has a status of its own.
        Err(_) => GYROCAL_FAILED,
    }
}

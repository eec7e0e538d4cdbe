//! Axes of instruments that are fixed to a body: files beside records.

use std::path::PathBuf;

use gyrocal_calibration::GyroAxes;
use gyrocal_instruments::strapdown::read_axes;
use gyrocal_record::{Record, SourceText};
use gyrocal_setup::PlatformKind;

use crate::Failure;

/// The file of axes of each record, in their order; none without files.
pub(crate) fn read<'a>(
    paths: &[PathBuf],
    records: impl IntoIterator<Item = &'a Record>,
) -> Result<Vec<GyroAxes>, Failure> {
    let pairs = paths.iter().zip(records);
    let read = pairs.map(|(path, record)| {
        let quaternions = read_axes(&SourceText::read(path)?, record)?;
        Ok(GyroAxes::new(&quaternions))
    });
    read.collect()
}

/// Kind of the platforms whose records are given with these files.
pub(crate) fn kind(paths: &[PathBuf]) -> PlatformKind {
    if paths.is_empty() {
        PlatformKind::Stabilised
    } else {
        PlatformKind::Computed
    }
}

/// Refuses another number of files than that of records.
pub(crate) fn check(paths: &[PathBuf], records: usize) -> Result<(), Failure> {
    let axes = paths.len();
    if axes == 0 || axes == records {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{axes} of --gyro-axes for {records} of records: give one for each record, in their order"
    )))
}

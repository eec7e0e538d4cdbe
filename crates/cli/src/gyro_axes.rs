//! Axes of instruments that are fixed to a body: files beside records.

use std::path::PathBuf;

use gyrocal_calibration::GyroAxes;
use gyrocal_instruments::strapdown::read_axes;
use gyrocal_record::{Record, SourceText};

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

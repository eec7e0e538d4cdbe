//! The report of a calibration: the nominal model fitted to each record alone, for charts over time.

use std::path::Path;

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options};
use gyrocal_pages::{CalibratedRecord, Part, of_calibration};
use gyrocal_record::CalibrationReport;
use gyrocal_setup::PlatformKind;

use super::CalibrationRun;
use crate::{Failure, page};

/// The page of records, the first of which is at `path`. A platform that was computed from a log, and a
/// record that cannot be fitted alone, have no charts over time.
pub(super) fn part(
    path: &Path,
    report: &CalibrationReport,
    found: &CalibrationRun,
    options: &Options,
) -> Result<Part, Failure> {
    let measurements = found.measurements.iter();
    let fits = measurements.filter_map(|measurement| {
        if found.kind != PlatformKind::Stabilised || found.calibration.fit.is_gross() {
            return None;
        }
        let fit = FittedPlatform::nominal(&measurement.run(), options, &NoiseModel::default());
        fit.inspect_err(
            |error| tracing::warn!(%error, "no charts of {}", measurement.path.display()),
        )
        .ok()
        .map(|fit| (measurement, fit))
    });
    let fits: Vec<_> = fits.collect();
    let records = fits.iter().map(|(measurement, fit)| CalibratedRecord {
        name: measurement.path.display().to_string(),
        record: &measurement.record,
        bench: &measurement.bench,
        fit,
    });
    let records: Vec<_> = records.collect();
    page::part(path, of_calibration(report, &records))
}

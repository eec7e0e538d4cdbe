//! The report of a calibration: the nominal model fitted to each record alone, for charts over time.

use std::path::Path;

use gyrocal_calibration::{FittedPlatform, GyroAxes, NoiseModel, Options};
use gyrocal_pages::{CalibratedRecord, Part, of_calibration};
use gyrocal_record::CalibrationReport;

use super::inputs::Measurement;
use crate::{Failure, page};

/// The page of records, the first of which is at `path`. A record that cannot be fitted alone has no charts
/// over time.
pub(super) fn part(
    path: &Path,
    report: &CalibrationReport,
    measurements: &[Measurement],
    (axes, options): (&[GyroAxes], &Options),
) -> Result<Part, Failure> {
    let fits = measurements
        .iter()
        .enumerate()
        .filter_map(|(index, measurement)| {
            if !report.usable {
                return None;
            }
            let (axes, noise) = (axes.get(index), NoiseModel::default());
            let fit = FittedPlatform::nominal_of_unit(&measurement.run(), axes, options, &noise);
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

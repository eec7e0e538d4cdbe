//! Outliers among rows that the noise audit cannot test: those in which the filter has not settled,
//! and gross errors, with which no fit converges.

use core::ops::Range;

use gyrocal_calibration::FittedPlatform;
use gyrocal_record::Record;

use crate::error_budget::UNTESTABLE_OUTLIER_Z;
use crate::noise::{Outlier, runs};

/// Neighbours on either side that a value is compared with.
const REACH: usize = 4;

/// Rows that the audit does not test at the start of a record, and after a gap.
const EARLY_ROWS: usize = 48;
const ROWS_AFTER_GAP: usize = 8;

/// The untestable rows, gross ones among them.
pub(super) fn untestable_rows(record: &Record, gross: &[usize]) -> Vec<usize> {
    let early = runs(&record.time_s).into_iter().flat_map(|run| {
        let rows = if run.start == 0 {
            EARLY_ROWS
        } else {
            ROWS_AFTER_GAP
        };
        run.start..(run.start + rows).min(run.end)
    });
    let mut rows: Vec<usize> = early.chain(gross.iter().copied()).collect();
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// Values of some rows whose smoothed residuals differ from those of their neighbours by more than
/// [`UNTESTABLE_OUTLIER_Z`] standard deviations of the noise `noise_g`.
pub(super) fn detect_outliers(
    record: &Record,
    rows: &[usize],
    fitted: &FittedPlatform<'_>,
    noise_g: [f64; 3],
) -> Vec<Outlier> {
    let predicted_g = fitted.predicted_g();
    let residual = |row: usize, axis: usize| record.accel_g[row][axis] - predicted_g[row][axis];
    let mut found = Vec::new();
    for row in rows.iter().copied() {
        for (axis, noise_g) in noise_g.into_iter().enumerate() {
            let around: Range<usize> =
                row.saturating_sub(REACH)..(row + REACH + 1).min(record.len());
            let mut others: Vec<f64> = around
                .filter(|other| *other != row)
                .map(|other| residual(other, axis))
                .filter(|value| value.is_finite())
                .collect();
            others.sort_unstable_by(f64::total_cmp);
            let Some(middle) = others.get(others.len() / 2) else {
                continue;
            };
            let size_g = residual(row, axis) - middle;
            let deviation = size_g / noise_g;
            if deviation.abs() > UNTESTABLE_OUTLIER_Z {
                found.push(Outlier {
                    row,
                    axis,
                    size_g,
                    deviation,
                });
            }
        }
    }
    found
}

//! Values that the audit of the noise cannot judge: those of rows in which the filter has not settled,
//! and gross ones, with which no fit can begin.

use core::ops::Range;

use gyrocal_calibration::Extended;
use gyrocal_record::Record;

use crate::noise::{Outlier, runs};

/// A value whose smoothed residual is farther from those of its neighbours than this, in standard
/// deviations of the noise, is none of noise: of a million such values of sound records not one is.
const STANDS_OFF: f64 = 7.0;

/// Rows on either side that a value is compared with.
const REACH: usize = 4;

/// Rows that the audit passes over, at the start of a record and after a gap.
const EARLY_ROWS: usize = 48;
const ROWS_AFTER_GAP: usize = 8;

/// The rows to look at, with some that are gross.
pub(super) fn unsettled(record: &Record, gross: &[usize]) -> Vec<usize> {
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

/// The values of some rows that stand off their neighbours; the noise is `noise_g`.
pub(super) fn standing_off(
    record: &Record,
    rows: &[usize],
    fitted: &Extended<'_>,
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
            if deviation.abs() > STANDS_OFF {
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

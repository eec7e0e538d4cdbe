//! Sentences of `gyrocal calibrate`, made from its result alone.

use std::fmt::Write as _;

use gyrocal_calibration::{SIGNIFICANT_WALK_SHARE, times_overlap};
use gyrocal_pages::calibration_sections;
use gyrocal_record::printable_path;

use super::inputs::Measurement;
use super::{CalibrationRun, json};
use crate::layout;
use crate::text::paragraph;

/// The records, errors of their set-ups, and the sections of the page.
pub(super) fn summary(found: &CalibrationRun) -> String {
    let mut text = String::new();
    for measurement in &found.measurements {
        text.push_str(&paragraph(&record_line(measurement)));
    }
    for problem in found.setup() {
        let problem = format!("Error of the set-up: {}", problem.text());
        text.push_str(&paragraph(&problem));
    }
    text.push_str(&overlapping_times(&found.measurements));
    text.push('\n');
    // Only the files of a manifest can fail to be read.
    if let Ok(report) = json::report(found, &[]) {
        text.push_str(&layout::sections(&calibration_sections(&report)));
    }
    text
}

pub(super) fn record_line(measurement: &Measurement) -> String {
    let rows = measurement
        .averaged
        .map_or(measurement.record.len(), |averaged| {
            averaged.report.rows_read
        });
    let mut text = format!(
        "{}: {rows} rows over {:.2} days",
        printable_path(&measurement.path),
        measurement.record.duration_s() / 86_400.0,
    );
    let Some(averaged) = measurement.averaged else {
        return text;
    };
    let _ = write!(
        text,
        ", averaged over {} s to {} means of {:.3} times the noise",
        averaged.report.interval_s, averaged.means, averaged.report.noise_ratio
    );
    if averaged.report.left_out > 0 {
        let _ = write!(
            text,
            "; {} values left out, means of fewer than half of the median number of values",
            averaged.report.left_out
        );
    }
    if averaged.walk_share > SIGNIFICANT_WALK_SHARE {
        let _ = write!(
            text,
            ". Up to {:.0} % of the variance of these means is the attitude random walk within an \
             interval, which the declared noise does not include: average over a shorter interval",
            100.0 * averaged.walk_share
        );
    }
    text
}

fn overlapping_times(measurements: &[Measurement]) -> String {
    let mut text = String::new();
    for (index, one) in measurements.iter().enumerate() {
        for other in &measurements[index + 1..] {
            if times_overlap(&one.record, &other.record) {
                text.push_str(&paragraph(&format!(
                    "The times of {} and {} overlap: they are treated as turn-ons with separate \
                     clocks.",
                    printable_path(&one.path),
                    printable_path(&other.path)
                )));
            }
        }
    }
    text
}

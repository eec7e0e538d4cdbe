//! Means in the place of rows.

use gyrocal_record::AveragedReport;
use gyrocal_statistics::format::short;

/// Share of the variance of a mean from which on the attitude random walk within it is told; a smaller one does not
/// change the consistency test of a record of some days.
const SIGNIFICANT_WALK_SHARE: f64 = 0.05;

/// The means that are used in the place of the rows of a record.
#[must_use]
pub(crate) fn means(averaged: &AveragedReport) -> String {
    let mut text = format!(
        "averaged over {} s to {} means of {:.3} times the noise",
        short(averaged.interval_s, 4),
        averaged.means,
        averaged.noise_ratio
    );
    if averaged.left_out > 0 {
        text += &format!(
            "; {} values left out, means of fewer than half of the median number of values",
            averaged.left_out
        );
    }
    if averaged.walk_share > SIGNIFICANT_WALK_SHARE {
        text += &format!(
            ". Up to {:.0} % of the variance of these means is the attitude random walk within an \
             interval, which the declared noise does not include: average over a shorter interval",
            100.0 * averaged.walk_share
        );
    }
    text
}

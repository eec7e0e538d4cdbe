//! Sampling of a series: intervals between its values.

use crate::descriptive::upper_median;

/// Median of the intervals between rows \[s\], the upper one of an even number; infinite without
/// any.
#[must_use]
pub fn median_interval_s(time_s: &[f64]) -> f64 {
    let mut intervals: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    upper_median(&mut intervals).unwrap_or(f64::INFINITY)
}

//! Selection of quiet rows by the scatter of their samples.

use gyrocal_statistics::upper_median;

use super::PlatformRow;

/// `true` for each row with at most `factor` times the scatter of the median row.
pub(super) fn quiet(rows: &[PlatformRow], factor: f64) -> Vec<bool> {
    let [gyro, accel] = median_scatter(rows);
    rows.iter()
        .map(|row| {
            row.gyro_scatter_rad_per_s <= factor * gyro && row.accel_scatter_g <= factor * accel
        })
        .collect()
}

/// Scatter of gyros and accelerometers in the median row.
pub(super) fn median_scatter(rows: &[PlatformRow]) -> [f64; 2] {
    let median = |of: fn(&PlatformRow) -> f64| {
        let mut values: Vec<f64> = rows.iter().map(of).collect();
        upper_median(&mut values).unwrap_or(0.0)
    };
    [
        median(|row| row.gyro_scatter_rad_per_s),
        median(|row| row.accel_scatter_g),
    ]
}

/// Intervals of rows that are not quiet.
pub(super) fn disturbed_s(rows: &[PlatformRow], quiet: &[bool], averaging_s: f64) -> Vec<[f64; 2]> {
    let mut disturbed: Vec<[f64; 2]> = Vec::new();
    for (row, _) in rows.iter().zip(quiet).filter(|(_, quiet)| !**quiet) {
        let [from_s, to_s] = [-0.5, 0.5].map(|half| row.time_s + half * averaging_s);
        match disturbed.last_mut() {
            // Rows are an averaging interval apart but for rounding.
            Some(last) if from_s < last[1] + 0.5 * averaging_s => last[1] = to_s,
            _ => disturbed.push([from_s, to_s]),
        }
    }
    disturbed
}

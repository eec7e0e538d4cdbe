//! Detection of gross errors by the norm of specific force.

use gyrocal_record::Record;
use gyrocal_statistics::upper_median;

/// Rows whose norm differs from the local median by more than this many standard deviations of the
/// noise are gross errors. The norm of specific force is that of gravity at any attitude, and errors
/// of accelerometers change it slowly. Smaller outliers do not affect the initial guess.
const NOISE_MULTIPLE: f64 = 100.0;

/// Least multiple of the median difference, for noise that is declared far too small.
const MEDIAN_MULTIPLE: f64 = 20.0;

/// Rows on either side that enter the local median.
const HALF_WINDOW: usize = 8;

/// Fewest rows of a local median.
const LEAST_ROWS: usize = 3;

/// Rows with gross errors, such as those of a converter or a link; `noise_g` is the declared noise
/// of a sample. The initial guess of the attitude leaves them out.
#[must_use]
pub fn gross_errors(record: &Record, noise_g: f64) -> Vec<usize> {
    let norms: Vec<f64> = record
        .accel_g
        .iter()
        .map(|row| row.iter().map(|g| g * g).sum::<f64>().sqrt())
        .collect();
    let differences: Vec<f64> = (0..norms.len())
        .map(|row| difference(&norms, row))
        .collect();
    let mut finite: Vec<f64> = differences
        .iter()
        .copied()
        .filter(|difference| difference.is_finite())
        .collect();
    let Some(median) = upper_median(&mut finite) else {
        return Vec::new();
    };
    let limit = f64::max(NOISE_MULTIPLE * noise_g, MEDIAN_MULTIPLE * median);
    (0..differences.len())
        .filter(|row| differences[*row] > limit)
        .collect()
}

/// How far the norm of a row is from those of its neighbours; `NaN` of a row without a norm, and where there are too
/// few others.
fn difference(norms: &[f64], row: usize) -> f64 {
    let norm = norms[row];
    let median = local_median(norms, row);
    if norm.is_nan() || !median.is_nan() {
        return (norm - median).abs();
    }
    // Among missing rows: beyond both medians of the nearest that are not, between which errors of accelerometers may
    // have moved it.
    let (before, after) = norms.split_at(row);
    let sides = [
        nearest_median(before.iter().rev()),
        nearest_median(after[1..].iter()),
    ];
    let beyond = |sign: f64| {
        let excess = sides.iter().flatten().map(|side| sign * (norm - side));
        excess.reduce(f64::min)
    };
    let excess = [1.0, -1.0].into_iter().filter_map(beyond);
    excess
        .reduce(f64::max)
        .map_or(f64::NAN, |excess| excess.max(0.0))
}

/// Median of the nearest norms on one side; `None` where there are too few.
fn nearest_median<'n>(norms: impl Iterator<Item = &'n f64>) -> Option<f64> {
    let present = norms.filter(|norm| norm.is_finite());
    let mut near: Vec<f64> = present.take(HALF_WINDOW).copied().collect();
    if near.len() < LEAST_ROWS {
        return None;
    }
    upper_median(&mut near)
}

/// Median of the norms of the neighbouring rows; `NaN` where there are too few.
fn local_median(norms: &[f64], row: usize) -> f64 {
    let rows = row.saturating_sub(HALF_WINDOW)..(row + HALF_WINDOW + 1).min(norms.len());
    let mut near = [0.0; 2 * HALF_WINDOW];
    let mut count = 0;
    for other in rows.filter(|other| *other != row && norms[*other].is_finite()) {
        near[count] = norms[other];
        count += 1;
    }
    if count < LEAST_ROWS {
        return f64::NAN;
    }
    upper_median(&mut near[..count]).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A platform that turns about y with the Earth's rate, a row a minute.
    fn record() -> Record {
        let angles = (0..300).map(|row| 0.004_4 * f64::from(row));
        Record {
            time_s: (0..300).map(|row| 60.0 * f64::from(row)).collect(),
            accel_g: angles
                .map(|angle| [angle.sin(), 0.0, angle.cos()])
                .collect(),
            temperature_c: None,
        }
    }

    #[test]
    fn a_gross_error_is_found_in_any_row() {
        for at in [0, 1, 9, 150, 299] {
            let mut record = record();
            record.accel_g[at][2] += 0.1;
            assert_eq!(gross_errors(&record, 1e-5), [at]);
            record.accel_g[at][0] = f64::NAN;
            assert!(gross_errors(&record, 1e-5).is_empty());
        }
        // Two of three rows about one may be gone.
        let mut record = record();
        record.accel_g[100..103].fill([0.5, 0.5, 0.5]);
        assert_eq!(gross_errors(&record, 1e-5), [100, 101, 102]);
    }

    /// One accelerometer changes its scale over the hours in which it is missing.
    #[test]
    fn a_gross_error_among_missing_rows_is_found_and_a_drift_is_none() {
        let mut record = record();
        for (row, accel_g) in record.accel_g.iter_mut().enumerate() {
            *accel_g = accel_g.map(|g| g * 1e-5f64.mul_add(row as f64, 1.0));
        }
        for row in (50..250).filter(|row| *row != 150) {
            record.accel_g[row][0] = f64::NAN;
        }
        assert!(gross_errors(&record, 1e-5).is_empty());
        record.accel_g[150][0] += 0.05;
        assert_eq!(gross_errors(&record, 1e-5), [150]);
        record.accel_g[150][0] -= 0.1;
        assert_eq!(gross_errors(&record, 1e-5), [150]);
    }

    #[test]
    fn a_knock_and_noise_declared_too_small_are_no_gross_errors() {
        let mut record = record();
        assert!(gross_errors(&record, 1e-5).is_empty());
        // A knock by a radian keeps the norm.
        record.accel_g[150..].fill([0.6, 0.0, 0.8]);
        assert!(gross_errors(&record, 1e-5).is_empty());
        // Noise a thousand times the declared, in turn up and down.
        for (row, accel_g) in record.accel_g.iter_mut().enumerate() {
            accel_g[2] += if row % 2 == 0 { 0.01 } else { -0.01 };
        }
        assert!(gross_errors(&record, 1e-5).is_empty());
    }
}

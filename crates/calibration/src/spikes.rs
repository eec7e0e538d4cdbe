//! Rows that no platform could have made.

use gyrocal_record::Record;

/// The norm of specific force is that of gravity, whatever the platform does: a row whose norm is off
/// that of the rows about it by so many standard deviations of the noise is none of a platform.
/// Outliers below that harm no start; errors of accelerometers change the norm slowly.
const FAR: f64 = 100.0;

/// And by so many times what such differences usually are, where the noise is declared far too small.
const UNUSUAL: f64 = 20.0;

/// Rows on either side that a row is compared with, and the fewest that it needs.
const REACH: usize = 8;
const LEAST: usize = 3;

/// Rows with gross errors, such as those of a converter or a link: from them no search for the
/// attitude can begin.
#[must_use]
pub fn spikes(record: &Record, noise_g: f64) -> Vec<usize> {
    let norms: Vec<f64> = record
        .accel_g
        .iter()
        .map(|row| row.iter().map(|g| g * g).sum::<f64>().sqrt())
        .collect();
    let off: Vec<f64> = (0..norms.len())
        .map(|row| (norms[row] - about(&norms, row)).abs())
        .collect();
    let mut usual: Vec<f64> = off.iter().copied().filter(|off| off.is_finite()).collect();
    let Some(usual) = median(&mut usual) else {
        return Vec::new();
    };
    let limit = f64::max(FAR * noise_g, UNUSUAL * usual);
    (0..off.len()).filter(|row| off[*row] > limit).collect()
}

/// The median of the norms about a row; `NaN` where there are too few.
fn about(norms: &[f64], row: usize) -> f64 {
    let rows = row.saturating_sub(REACH)..(row + REACH + 1).min(norms.len());
    let mut near = [0.0; 2 * REACH];
    let mut count = 0;
    for other in rows.filter(|other| *other != row && norms[*other].is_finite()) {
        near[count] = norms[other];
        count += 1;
    }
    if count < LEAST {
        return f64::NAN;
    }
    median(&mut near[..count]).unwrap_or(f64::NAN)
}

fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
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
    fn a_row_that_is_off_by_far_is_a_spike_wherever_it_stands() {
        for at in [0, 1, 9, 150, 299] {
            let mut record = record();
            record.accel_g[at][2] += 0.1;
            assert_eq!(spikes(&record, 1e-5), [at]);
            record.accel_g[at][0] = f64::NAN;
            assert!(spikes(&record, 1e-5).is_empty());
        }
        // Two of three rows about one may be gone.
        let mut record = record();
        record.accel_g[100..103].fill([0.5, 0.5, 0.5]);
        assert_eq!(spikes(&record, 1e-5), [100, 101, 102]);
    }

    #[test]
    fn what_a_platform_or_wrong_noise_makes_is_no_spike() {
        let mut record = record();
        assert!(spikes(&record, 1e-5).is_empty());
        // A knock by a radian keeps the norm.
        record.accel_g[150..].fill([0.6, 0.0, 0.8]);
        assert!(spikes(&record, 1e-5).is_empty());
        // Noise a thousand times the declared, in turn up and down.
        for (row, accel_g) in record.accel_g.iter_mut().enumerate() {
            accel_g[2] += if row % 2 == 0 { 0.01 } else { -0.01 };
        }
        assert!(spikes(&record, 1e-5).is_empty());
    }
}

//! Noise and resolution of a column, as its own values show them.

use gyrocal_record::Record;
use gyrocal_statistics::{NORMAL_MAD, upper_median};

/// Noise of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ColumnNoise {
    /// Standard deviation of one sample: the larger of the declared one and that of fourth
    /// differences, g.
    pub(crate) sigma_g: f64,
    /// Step of the converter; of a column without steps a small part of its noise, g.
    pub(crate) step_g: f64,
}

impl ColumnNoise {
    /// By how much two readings of the same force differ at most, in the unit that tests multiply.
    pub(crate) fn width_g(&self) -> f64 {
        self.sigma_g.max(self.step_g)
    }
}

/// Share of the smallest differences that may be other than one step of the converter.
const ODD_SHARE: f64 = 0.01;

/// Fewest fourth differences that tell a noise.
const LEAST_DIFFERENCES: usize = 20;

/// Variance of a fourth difference of white noise of unit variance: 1 + 16 + 36 + 16 + 1.
const FOURTH_DIFFERENCE_VARIANCE: f64 = 70.0;

/// Noise of a column at some times. Of gravity, which turns by ω between rows, a fourth difference
/// leaves ω⁴: 4e-10 at a row a minute, 4e-6 at a row in ten.
pub(crate) fn column_noise(time_s: &[f64], column: &[f64], declared_g: f64) -> ColumnNoise {
    let declared_g = if declared_g.is_finite() {
        declared_g.max(0.0)
    } else {
        0.0
    };
    let mut fourth: Vec<f64> = column
        .windows(5)
        .zip(time_s.windows(5))
        .filter(|(_, times)| is_even(times))
        .map(|(v, _)| (v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4]).abs())
        .filter(|difference| !difference.is_nan())
        .collect();
    let shown_g = if fourth.len() < LEAST_DIFFERENCES {
        0.0
    } else {
        upper_median(&mut fourth).unwrap_or(0.0) / NORMAL_MAD / FOURTH_DIFFERENCE_VARIANCE.sqrt()
    };
    let step_g = step_g(column);
    ColumnNoise {
        sigma_g: declared_g.max(shown_g),
        step_g,
    }
}

/// Step of the converter: all differences of its values, of any order, are multiples of it. Those of the
/// second order are small also where gravity turns by many steps between all rows of a short record. Zero of a
/// column that does not change.
fn step_g(column: &[f64]) -> f64 {
    let largest = column
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    // Sums of values that are rounded to steps are not exact.
    let rounding = 16.0 * f64::EPSILON * largest;
    let first = column.windows(2).map(|v| v[1] - v[0]);
    let second = column.windows(3).map(|v| v[2] - 2.0 * v[1] + v[0]);
    let smallest = |differences: &mut Vec<f64>| {
        let place = (ODD_SHARE * differences.len() as f64) as usize;
        (!differences.is_empty())
            .then(|| *differences.select_nth_unstable_by(place, f64::total_cmp).1)
    };
    let steps = |difference: f64| Some(difference.abs()).filter(|size| *size > rounding);
    let orders = [
        smallest(&mut first.filter_map(steps).collect()),
        smallest(&mut second.filter_map(steps).collect()),
    ];
    orders.into_iter().flatten().reduce(f64::min).unwrap_or(0.0)
}

/// Noise of the accelerometers x, y, z as fourth differences of their values show it, whatever is
/// declared; zero of a column with too few equally spaced values.
#[must_use]
pub fn shown_noise_g(record: &Record) -> [f64; 3] {
    core::array::from_fn(|axis| {
        let column: Vec<f64> = record.accel_g.iter().map(|row| row[axis]).collect();
        column_noise(&record.time_s, &column, 0.0).sigma_g
    })
}

/// Whether five times are equally spaced, so that a smooth curve leaves nothing.
fn is_even(times_s: &[f64]) -> bool {
    /// Of an interval; jitter of a clock is less.
    const TOLERANCE: f64 = 1e-3;
    let interval_s = times_s[1] - times_s[0];
    times_s
        .windows(2)
        .all(|pair| (pair[1] - pair[0] - interval_s).abs() <= TOLERANCE * interval_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_statistics::deviates::Draw;

    #[test]
    fn noise_and_step_are_found_beside_a_turning_vector() {
        let mut deviates = Draw::new(3, 0);
        let time_s: Vec<f64> = (0..2000).map(|row| 60.0 * f64::from(row)).collect();
        let column: Vec<f64> = time_s
            .iter()
            .map(|t| (7.29e-5 * t).sin() + 3e-5 * deviates.normal())
            .collect();
        let noise = column_noise(&time_s, &column, 1e-5);
        // A median of 2000 dependent values.
        assert!((noise.sigma_g / 3e-5 - 1.0).abs() < 0.15, "{noise:?}");
        assert!(noise.step_g < 1e-4, "{noise:?}");
        let stepped: Vec<f64> = column.iter().map(|g| (g / 3e-4).round() * 3e-4).collect();
        let noise = column_noise(&time_s, &stepped, 1e-5);
        assert!((noise.step_g / 3e-4 - 1.0).abs() < 1e-6, "{noise:?}");
        assert_eq!(column_noise(&[], &[], f64::NAN), ColumnNoise::default());
    }
}

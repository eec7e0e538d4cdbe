//! Descriptive statistics: mean, root mean square, quantiles.

use core::borrow::Borrow;

/// Mean; `NaN` of nothing.
#[must_use]
pub fn mean(values: impl IntoIterator<Item = impl Borrow<f64>>) -> f64 {
    let mut count = 0_usize;
    let counted = values.into_iter().inspect(|_| count += 1);
    let sum: f64 = counted.map(|value| *value.borrow()).sum();
    sum / count as f64
}

/// Standard error of the mean, from the scatter of the values; `NaN` of fewer than two.
#[must_use]
pub fn standard_error(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let count = values.len() as f64;
    (squares / (count - 1.0) / count).sqrt()
}

/// Root mean square; `NaN` of nothing.
#[must_use]
pub fn root_mean_square(values: impl IntoIterator<Item = impl Borrow<f64>>) -> f64 {
    let squares = values.into_iter().map(|value| value.borrow().powi(2));
    mean(squares).sqrt()
}

/// Root mean square of the values that are not missing (`NaN`), and their number; zero of nothing.
#[must_use]
pub fn rms_of_present(values: impl IntoIterator<Item = impl Borrow<f64>>) -> (f64, usize) {
    let values = values.into_iter().map(|value| *value.borrow());
    let (sum, count) = values
        .filter(|value| !value.is_nan())
        .fold((0.0, 0), |(sum, count), value| {
            (sum + value * value, count + 1)
        });
    ((sum / count.max(1) as f64).sqrt(), count)
}

/// Median: half of the values lie below. `NaN` of nothing.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Quantile, linear between neighbouring values (type 7 of Hyndman and Fan 1996, the default of
/// R and NumPy). `NaN` of nothing.
///
/// # Panics
/// If `share` is not between 0 and 1.
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    assert!((0.0..=1.0).contains(&share), "a share, found {share}");
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    let fraction = place - below as f64;
    if fraction == 0.0 {
        return sorted[below];
    }
    sorted[below] + fraction * (sorted[above] - sorted[below])
}

/// Median of some values, which are reordered: of an even number the upper one of the two in the
/// middle. `None` without values.
#[must_use]
pub fn upper_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_values_are_left_out() {
        assert_eq!(rms_of_present([3.0, f64::NAN, -3.0]), (3.0, 2));
        assert_eq!(rms_of_present([0.0; 0]), (0.0, 0));
        assert!(root_mean_square([0.0; 0]).is_nan());
    }

    #[test]
    fn the_upper_median_is_a_value() {
        assert_eq!(upper_median(&mut [4.0, 1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(upper_median(&mut []), None);
    }
}

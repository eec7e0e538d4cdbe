//! Robust location.

/// Median of some values, which are reordered: the upper one of the two in the middle of an even
/// number. `None` without values.
pub fn upper_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

//! Size of a scale about zero, with few extremes left out.

/// Fraction of the values that a scale must hold.
const KEPT: f64 = 0.995;
/// Extremes are left out only if they would make the scale larger by more than this factor.
const CUT_FACTOR: f64 = 4.0;

/// Half of a scale about zero without a few values that would flatten the others, and never smaller than the
/// least half; `None` if all values have a place.
pub(crate) fn without_extremes<'a>(
    columns: impl IntoIterator<Item = &'a [f64]>,
    least_half: f64,
) -> Option<f64> {
    let values = columns.into_iter().flatten();
    let finite = values.filter(|value| value.is_finite());
    let mut sizes: Vec<f64> = finite.map(|value| value.abs()).collect();
    let place = (sizes.len().checked_sub(1)? as f64 * KEPT) as usize;
    let (_, kept, above) = sizes.select_nth_unstable_by(place, f64::total_cmp);
    let largest = above.iter().fold(*kept, |most, &size| most.max(size));
    let usual = kept.max(least_half);
    (largest > CUT_FACTOR * usual).then_some(1.7 * usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_outliers_do_not_flatten_the_rest() {
        let mut values: Vec<f64> = (0..1000).map(|n| f64::from(n % 7) - 3.0).collect();
        assert_eq!(without_extremes([values.as_slice()], 0.0), None);
        values[17] = -100.0;
        let cut = without_extremes([values.as_slice()], 0.0).unwrap();
        assert!(cut > 3.0 && cut < 6.0);
        // A band that is as wide has them all.
        assert_eq!(without_extremes([values.as_slice()], 50.0), None);
        assert_eq!(without_extremes([], 1.0), None);
    }
}

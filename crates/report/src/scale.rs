//! Size of a scale about zero, with few extremes left out.

use crate::span::Span;

/// A scale about zero that may leave a few extremes out.
pub(crate) struct Scale {
    /// Half of the scale.
    pub half: f64,
    cut: bool,
}

/// Fraction of the values that a scale must hold.
const KEPT: f64 = 0.995;
/// Extremes are left out only if they would make the scale larger by more than this factor.
const CUT_FACTOR: f64 = 4.0;

impl Scale {
    /// A scale for all values, unless a few of them would flatten the others; never smaller than
    /// the least half.
    pub(crate) fn about_zero<'a>(
        columns: impl IntoIterator<Item = &'a [f64]>,
        least_half: f64,
    ) -> Self {
        let mut sizes: Vec<f64> = columns
            .into_iter()
            .flatten()
            .filter(|value| value.is_finite())
            .map(|value| value.abs())
            .collect();
        if sizes.is_empty() {
            return Self {
                half: least_half,
                cut: false,
            };
        }
        let place = ((sizes.len() - 1) as f64 * KEPT) as usize;
        let (_, kept, above) = sizes.select_nth_unstable_by(place, f64::total_cmp);
        let largest = above.iter().fold(*kept, |most, &size| most.max(size));
        let usual = kept.max(least_half);
        let cut = largest > CUT_FACTOR * usual;
        let half = if cut { 1.6 * usual } else { largest };
        Self {
            half: 1.06 * half.max(least_half),
            cut,
        }
    }

    pub(crate) fn span(&self) -> Span {
        Span::symmetric(self.half)
    }

    /// Number of values outside the scale and the largest of them; `None` if none was left out.
    pub(crate) fn beyond(&self, values: &[f64]) -> Option<(usize, f64)> {
        let beyond = values.iter().filter(|value| value.abs() > self.half);
        let (count, largest) = beyond.fold((0, 0.0_f64), |(count, largest), value| {
            (count + 1, largest.max(value.abs()))
        });
        (self.cut && count > 0).then_some((count, largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_outliers_do_not_flatten_the_rest() {
        let mut values: Vec<f64> = (0..1000).map(|n| f64::from(n % 7) - 3.0).collect();
        let whole = Scale::about_zero([values.as_slice()], 0.0);
        assert!(whole.half >= 3.0 && whole.half < 3.3);
        assert_eq!(whole.beyond(&values), None);
        values[17] = -100.0;
        let cut = Scale::about_zero([values.as_slice()], 0.0);
        assert!(cut.half > 3.0 && cut.half < 6.0);
        assert_eq!(cut.beyond(&values), Some((1, 100.0)));
    }
}

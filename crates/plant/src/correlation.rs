//! Correlation of what a model leaves from row to row.

/// The innovations of an output, of `FittedPlant::whitened`.
pub(crate) fn of_output(whitened: &[(usize, usize, f64)], output: usize) -> Vec<f64> {
    let own = whitened.iter().filter(|(_, own, _)| *own == output);
    own.map(|(.., value)| *value).collect()
}

/// Correlation of neighbours, in its standard deviations in white noise, below which values count as white.
const WHITE: f64 = 4.0;

/// Variance of a sum of values over that of a sum of white ones: one and twice the correlations, by pairs of lags
/// until a pair is negative (Geyer's initial positive sequence).
pub(crate) fn inflation(values: &[f64]) -> f64 {
    let all = correlations(values, values.len());
    let first = all.first().copied().unwrap_or(0.0);
    if first * (values.len() as f64).sqrt() < WHITE {
        return 1.0;
    }
    // The first pair is that of the lags zero and one.
    let later = all[1..].chunks_exact(2).map(|pair| pair[0] + pair[1]);
    let pairs = core::iter::once(1.0 + first).chain(later);
    (2.0 * pairs.take_while(|pair| *pair > 0.0).sum::<f64>() - 1.0).max(1.0)
}

/// Correlations of values at the lags from one on, up to a quarter of them.
pub(crate) fn correlations(values: &[f64], lags: usize) -> Vec<f64> {
    let power: f64 = values.iter().map(|value| value * value).sum();
    let lags = 1..=lags.min(values.len() / 4);
    lags.map(|lag| {
        let pairs = values.iter().zip(&values[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / power
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use gyrocal_statistics::deviates::Draw;

    use super::inflation;

    /// Values whose neighbours have this correlation.
    fn correlated(by: f64) -> Vec<f64> {
        let mut draw = Draw::new(1, 1);
        let mut last = draw.normal();
        let next = |_| {
            last = by * last + (1.0 - by * by).sqrt() * draw.normal();
            last
        };
        (0..20_000).map(next).collect()
    }

    #[test]
    fn a_sum_of_correlated_values_varies_as_theory_says() {
        assert_eq!(inflation(&correlated(0.0)), 1.0);
        assert_eq!(inflation(&[]), 1.0);
        for by in [0.5, 0.9] {
            let theory = (1.0 + by) / (1.0 - by);
            let share = inflation(&correlated(by)) / theory;
            // The correlation time is known to a tenth from some 1000 independent pieces.
            assert!((share - 1.0).abs() < 0.2, "{by}: {share} of {theory}");
        }
    }
}

//! Intervals of chi-square variables.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The central interval of a chi-square variable that leaves out `false_alarm` in both tails
/// together.
///
/// # Panics
/// If `degrees_of_freedom` is not positive.
#[must_use]
pub fn chi_square_band(degrees_of_freedom: f64, false_alarm: f64) -> [f64; 2] {
    #[expect(clippy::expect_used, reason = "documented under # Panics")]
    let distribution =
        ChiSquared::new(degrees_of_freedom).expect("degrees of freedom must be positive");
    [
        distribution.inverse_cdf(false_alarm / 2.0),
        distribution.inverse_cdf(1.0 - false_alarm / 2.0),
    ]
}

/// The interval that holds, with this probability, the sum over `runs` of normalised squared
/// errors divided by `runs`, if the covariances are right; `degrees_of_freedom` is the sum over
/// all runs.
///
/// # Panics
/// If `degrees_of_freedom` is not positive, or `probability` not between 0 and 1.
#[must_use]
pub fn mean_square_band(degrees_of_freedom: f64, runs: f64, probability: f64) -> [f64; 2] {
    check(probability);
    chi_square_band(degrees_of_freedom, 1.0 - probability).map(|bound| bound / runs)
}

/// The interval that holds, with this confidence, the true ratio of root mean square error to
/// sigma, when normal errors gave `ratio` in a number of runs.
///
/// # Panics
/// If `runs` is 0, or `confidence` not between 0 and 1.
#[must_use]
pub fn rms_ratio_interval(ratio: f64, runs: usize, confidence: f64) -> [f64; 2] {
    check(confidence);
    let count = runs as f64;
    let [low, high] = chi_square_band(count, 1.0 - confidence);
    [ratio * (count / high).sqrt(), ratio * (count / low).sqrt()]
}

pub(crate) fn check(probability: f64) {
    assert!(
        probability > 0.0 && probability < 1.0,
        "a probability between 0 and 1, found {probability}"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_is_that_of_published_tables() {
        // Chi-square with 10 degrees of freedom: 2.5 % and 97.5 % points, printed to 3 decimals.
        let [low, high] = chi_square_band(10.0, 0.05);
        assert!((low - 3.247).abs() < 5e-4 && (high - 20.483).abs() < 5e-4);
        // Large numbers: normal limit, sqrt(2 / n) times 3.29; its skewness enters as 1 / n.
        let n = 13_000.0;
        let [low, high] = chi_square_band(n, 1e-3);
        let half_width = 3.2905 * (2.0 * n).sqrt();
        assert!((low - (n - half_width)).abs() < 10.0 && (high - (n + half_width)).abs() < 10.0);
    }
}

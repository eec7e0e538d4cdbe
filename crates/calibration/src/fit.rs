use gyrocal::Innovation;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::problem::Unknown;
use crate::solve::Solution;
use crate::uncertainty::Uncertainty;

/// Probability with which a record that fits the model is called inconsistent.
const FALSE_ALARM: f64 = 1e-3;

/// A mean NIS beyond this points at the inputs: first-order integration, the worst fault of a
/// model seen here, gives 190.
const GROSS: f64 = 1000.0;

/// How well the innovations agree with the covariance that the filter predicted for them.
///
/// That of a [`crate::Calibration`] has as many rows with a value as the filter has states, or
/// more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    nis_sum: f64,
    values: usize,
    rows: usize,
    log_likelihood: f64,
    /// Of one pass of the filter, not of a solution that was iterated.
    one_pass: bool,
}

/// What the innovations say of the fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Innovations are as large as the declared noise explains.
    Consistent,
    /// They are larger.
    TooLarge,
    /// They are smaller.
    TooSmall,
}

impl Fit {
    /// Sum of the normalised innovations squared.
    #[must_use]
    pub fn nis_sum(&self) -> f64 {
        self.nis_sum
    }

    /// Number of accelerometer values used: the expectation of [`Self::nis_sum`].
    #[must_use]
    pub fn values(&self) -> usize {
        self.values
    }

    /// Number of rows with at least one value.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Logarithm of the likelihood of the record.
    #[must_use]
    pub fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// Mean NIS of a row; expected is the mean number of values of a row, 3 without `nan`.
    #[must_use]
    pub fn nis_mean(&self) -> f64 {
        self.nis_sum / self.rows as f64
    }

    /// The interval that holds [`Self::nis_mean`] of a record that fits, with probability 99.9 %.
    #[must_use]
    pub fn nis_band(&self) -> [f64; 2] {
        chi_square_band(self.values as f64, FALSE_ALARM).map(|bound| bound / self.rows as f64)
    }

    /// Whether [`Self::nis_mean`] lies in [`Self::nis_band`].
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let [low, high] = self.nis_band();
        match self.nis_mean() {
            mean if mean < low => Verdict::TooSmall,
            mean if mean > high => Verdict::TooLarge,
            _ => Verdict::Consistent,
        }
    }

    /// The verdict in a sentence.
    #[must_use]
    pub fn verdict_text(&self) -> String {
        let [low, high] = self.nis_band();
        let mean = self.nis_mean();
        let figures = format!("mean NIS {mean:.3}, 99.9 % band {low:.3} to {high:.3}");
        match self.verdict() {
            Verdict::Consistent => {
                format!("the record fits the model within the declared noise ({figures})")
            }
            // Nothing that a model lacks makes it as large as a mistake in the inputs does.
            Verdict::TooLarge if mean > GROSS => format!(
                "the innovations are far larger than the declared noise explains ({figures}): \
                 check that time is in seconds, that up is positive, and the latitude and initial \
                 angles of the bench file; the coefficients mean nothing"
            ),
            Verdict::TooLarge => format!(
                "the innovations are larger than the declared noise explains ({figures}): {}; the \
                 sigmas cannot be trusted",
                if self.one_pass {
                    "the model lacks something, the noise is larger than declared, or the prior \
                     is too wide for one pass of the filter"
                } else {
                    "the model lacks something, or the noise is larger than declared"
                }
            ),
            Verdict::TooSmall => format!(
                "the innovations are smaller than the declared noise explains ({figures}): the \
                 noise is smaller than declared; the sigmas are too large"
            ),
        }
    }

    /// Before the first innovation; it has no band yet.
    pub(crate) fn of_nothing() -> Self {
        Self {
            nis_sum: 0.0,
            values: 0,
            rows: 0,
            log_likelihood: 0.0,
            one_pass: true,
        }
    }

    /// Of a joint solution: the least sum of squares, priors included, has as many degrees of
    /// freedom as there are values, like the sum of a filter's NIS.
    pub(crate) fn of_batch(
        solution: &Solution,
        unknowns: &[Unknown],
        uncertainty: &Uncertainty,
    ) -> Self {
        let prior: f64 = unknowns
            .iter()
            .filter(|unknown| !unknown.considered)
            .map(|unknown| 2.0 * unknown.sigma.ln())
            .sum();
        let gained = uncertainty.log_determinant();
        Self {
            nis_sum: solution.cost,
            values: solution.values,
            rows: solution.rows,
            log_likelihood: -0.5
                * (solution.cost + solution.log_variance + prior - gained
                    + solution.values as f64 * core::f64::consts::TAU.ln()),
            one_pass: false,
        }
    }

    pub(crate) fn add(&mut self, innovation: &Innovation<f64, 3>) {
        let values = innovation.degrees_of_freedom();
        self.nis_sum += innovation.nis;
        self.values += values;
        self.rows += usize::from(values > 0);
        self.log_likelihood += innovation.log_likelihood();
    }
}

/// The central interval of a chi-square variable that leaves out `false_alarm` in both tails
/// together.
///
/// # Panics
/// If `degrees_of_freedom` is not positive.
#[must_use]
pub fn chi_square_band(degrees_of_freedom: f64, false_alarm: f64) -> [f64; 2] {
    #[allow(clippy::expect_used)] // documented under # Panics
    let distribution =
        ChiSquared::new(degrees_of_freedom).expect("degrees of freedom must be positive");
    [
        distribution.inverse_cdf(false_alarm / 2.0),
        distribution.inverse_cdf(1.0 - false_alarm / 2.0),
    ]
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

    #[test]
    fn the_verdict_follows_the_mean() {
        let fit = |nis_sum| Fit {
            nis_sum,
            values: 12_000,
            rows: 4_000,
            log_likelihood: 0.0,
            one_pass: true,
        };
        assert_eq!(fit(12_000.0).verdict(), Verdict::Consistent);
        assert_eq!(fit(13_000.0).verdict(), Verdict::TooLarge);
        assert_eq!(fit(11_000.0).verdict(), Verdict::TooSmall);
        let one_pass = fit(13_000.0);
        assert!(one_pass.verdict_text().contains("mean NIS 3.250"));
        assert!(one_pass.verdict_text().contains("one pass"));
        let joint = Fit {
            one_pass: false,
            ..one_pass
        };
        assert!(!joint.verdict_text().contains("one pass"));
    }
}

//! Consistency of innovations with their predicted covariance.

use gyrocal::Innovation;
use gyrocal_statistics::chi_square_band;

use crate::problem::Unknown;
use crate::solve::Solution;
use crate::uncertainty::Uncertainty;

/// False-alarm probability of the consistency test.
pub const NIS_FALSE_ALARM: f64 = 1e-3;

/// Mean NIS above which the message points to wrong inputs: first-order integration, the largest
/// model error among the figures, gives 190.
const GROSS: f64 = 1000.0;

/// Whether a mean NIS is so large that no effect which a model lacks explains it: the inputs are wrong, and the
/// estimates mean nothing.
#[must_use]
pub fn is_gross(nis_mean: f64) -> bool {
    nis_mean > GROSS
}

/// Sums of normalised innovations squared (NIS) and of their log-likelihoods: the data of the
/// consistency test.
///
/// Those of a [`crate::Calibration`] are of at least as many rows with a value as the filter has
/// states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitStatistics {
    nis_sum: f64,
    values: usize,
    rows: usize,
    log_likelihood: f64,
}

/// Result of the consistency test: mean NIS against its chi-square band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Consistency {
    /// The innovations agree with the covariance computed from the declared noise.
    Consistent,
    /// The innovations are larger than that covariance: the sigmas are too small.
    Overconfident,
    /// The innovations are smaller than that covariance: the sigmas are too large.
    Underconfident,
}

impl FitStatistics {
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

    /// The 99.9 % interval of [`Self::nis_mean`] for a record that fits the model.
    #[must_use]
    pub fn nis_band(&self) -> [f64; 2] {
        chi_square_band(self.values as f64, NIS_FALSE_ALARM).map(|bound| bound / self.rows as f64)
    }

    /// Compares [`Self::nis_mean`] with [`Self::nis_band`].
    #[must_use]
    pub fn consistency(&self) -> Consistency {
        let [low, high] = self.nis_band();
        match self.nis_mean() {
            mean if mean < low => Consistency::Underconfident,
            mean if mean > high => Consistency::Overconfident,
            _ => Consistency::Consistent,
        }
    }

    /// Whether the innovations are so large that no effect that a model lacks explains them: the
    /// inputs are wrong, and the estimates mean nothing.
    #[must_use]
    pub fn is_gross(&self) -> bool {
        is_gross(self.nis_mean())
    }

    /// Sums before the first innovation; they have no band yet.
    pub(crate) fn of_nothing() -> Self {
        Self {
            nis_sum: 0.0,
            values: 0,
            rows: 0,
            log_likelihood: 0.0,
        }
    }

    /// Statistics of a joint solution. The least sum of squares, priors included, has as many
    /// degrees of freedom as there are values, like the sum of a filter's NIS.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_test_compares_the_mean_with_its_band() {
        let fit = |nis_sum| FitStatistics {
            nis_sum,
            values: 12_000,
            rows: 4_000,
            log_likelihood: 0.0,
        };
        assert_eq!(fit(12_000.0).consistency(), Consistency::Consistent);
        assert_eq!(fit(13_000.0).consistency(), Consistency::Overconfident);
        assert_eq!(fit(11_000.0).consistency(), Consistency::Underconfident);
        assert_eq!(fit(13_000.0).nis_mean(), 3.25);
    }
}

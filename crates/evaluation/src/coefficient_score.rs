//! Comparison of the estimated drift coefficients of one record with the true ones.

use gyrocal_answer::{CoefficientEstimate, Coefficients};
use gyrocal_statistics::NORMAL_97_5;
use serde::{Deserialize, Serialize};

/// The nine drift coefficients of one record against the truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CoefficientScore {
    /// Number of the nine whose 95 % interval holds the true value.
    pub covered: u64,
    /// Largest of the nine errors, in sigmas.
    pub largest_error: f64,
}

impl CoefficientScore {
    /// Of the true values, and of estimates with their standard deviations, in one order.
    pub(crate) fn normal(
        truth: [f64; 9],
        estimates: impl IntoIterator<Item = (f64, f64)>,
    ) -> Option<Self> {
        let both = truth.into_iter().zip(estimates);
        Self::of(both.map(|(truth, (estimate, sigma))| {
            let error = (estimate - truth).abs() / sigma;
            (error, error <= NORMAL_97_5)
        }))
    }

    /// Of the coefficients that a diagnosis gives: over the members of its confidence sets, those of
    /// the extended model, or those of the nominal one.
    pub(crate) fn diagnosed(truth: [f64; 9], found: &Coefficients) -> Option<Self> {
        let normal = |all: &[CoefficientEstimate]| {
            Self::normal(truth, all.iter().map(|of| (of.estimate, of.sigma)))
        };
        match (&found.over_set, &found.extended) {
            (Some(over_set), _) => Self::of(truth.into_iter().zip(over_set).map(|(truth, of)| {
                let [low, high] = of.interval;
                let error = (of.estimate - truth).abs() / of.sigma;
                (error, low <= truth && truth <= high)
            })),
            (None, Some(extended)) => normal(extended),
            (None, None) => normal(&found.nominal),
        }
    }

    /// Of the errors in sigmas, each with `true` if the interval holds the truth; `None` unless there
    /// are nine.
    fn of(errors: impl Iterator<Item = (f64, bool)>) -> Option<Self> {
        let errors: Vec<(f64, bool)> = errors.collect();
        (errors.len() == 9).then(|| Self {
            covered: errors.iter().filter(|(_, covered)| *covered).count() as u64,
            largest_error: errors.iter().map(|(error, _)| *error).fold(0.0, f64::max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_counted_and_the_largest_error_is_kept() {
        let truth = [1.0; 9];
        let mut estimates = vec![(1.1, 0.1); 9];
        estimates[3] = (0.5, 0.1);
        let score = CoefficientScore::normal(truth, estimates.clone()).map(|score| {
            assert!((score.largest_error - 5.0).abs() < 1e-12);
            score.covered
        });
        assert_eq!(score, Some(8));
        estimates.pop();
        assert_eq!(CoefficientScore::normal(truth, estimates), None);
    }
}

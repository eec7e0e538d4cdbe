//! Allan variances drawn from the distribution that the fitted parts of a noise give them.

use nalgebra::DVector;

use super::fit::{Fit, Scales, variance};
use crate::deviates::Normals;

/// Number of draws. The tails of an interval hold 25 of them.
const DRAWS: usize = 1000;

/// Seed of the draws, the same for every fit: a p-value changes smoothly with the parts.
const SEED: u64 = 1;

/// Normal deviates that become Allan variances: each is a multiple of chi-square with its degrees of
/// freedom, and they are correlated as the covariances say (a Gaussian copula).
pub(super) struct Draws {
    variances: Vec<DVector<f64>>,
}

impl Draws {
    /// Draws for a fit; `None` if its covariance is not positive definite.
    pub(super) fn of(scales: &Scales, fit: &Fit) -> Option<Self> {
        let count = scales.averaging.len();
        let covariance = &fit.covariance;
        let sigma: Vec<f64> = (0..count).map(|k| covariance[(k, k)].sqrt()).collect();
        let mut correlation = covariance.clone();
        for row in 0..count {
            for column in 0..count {
                correlation[(row, column)] /= sigma[row] * sigma[column];
            }
        }
        let factor = correlation.cholesky()?.unpack();
        let means: Vec<f64> = scales
            .averaging
            .iter()
            .map(|averaging| variance(&fit.parts, *averaging as f64))
            .collect();
        let mut normals = Normals::of_seed(SEED);
        let variances = (0..DRAWS)
            .map(|_| {
                let white = DVector::from_fn(count, |_, _| normals.normal());
                let mut drawn = &factor * white;
                for k in 0..count {
                    drawn[k] = means[k] * relative_chi_square(drawn[k], sigma[k] / means[k]);
                }
                drawn
            })
            .collect();
        Some(Self { variances })
    }

    /// A function of each draw.
    pub(super) fn map<T>(&self, function: impl Fn(&DVector<f64>) -> T) -> Vec<T> {
        self.variances.iter().map(function).collect()
    }

    /// Share of the draws with a property.
    pub(super) fn share(&self, property: impl Fn(&DVector<f64>) -> bool) -> f64 {
        let with = self
            .variances
            .iter()
            .filter(|drawn| property(drawn))
            .count();
        with as f64 / self.variances.len() as f64
    }
}

/// Chi-square over its mean at a normal deviate, for its relative standard deviation (E. B. Wilson and M. M. Hilferty,
/// Proceedings of the National Academy of Sciences 17, 1931).
fn relative_chi_square(normal: f64, relative_sigma: f64) -> f64 {
    // 2 / (9 ν) with ν = 2 / relative variance.
    let ninth = relative_sigma * relative_sigma / 9.0;
    (1.0 - ninth + normal * ninth.sqrt()).max(0.0).powi(3)
}

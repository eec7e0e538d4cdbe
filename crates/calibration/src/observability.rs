//! Observability: combinations of coefficients that a record does not determine.

use nalgebra::{DMatrix, SymmetricEigen};

use gyrocal::generated::platform::DRIFT;

/// Ratio of posterior to prior sigma from which on a coefficient or combination is unobservable.
pub const DETERMINED: f64 = 0.1;

/// Least weight of a coefficient that [`UnobservableCombination::text`] names.
const NAMED: f64 = 0.15;

/// A combination of coefficients, each over its prior sigma, that a record does not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct UnobservableCombination {
    /// Weight of each coefficient over its prior sigma; the sum of squares is 1.
    pub weights: Vec<f64>,
    /// Posterior over prior standard deviation of the combination.
    pub posterior_to_prior_ratio: f64,
}

impl UnobservableCombination {
    /// The combination as a formula, largest weight first, such as
    /// `0.71 gyro_x.bias - 0.70 gyro_x.g_xx`; each coefficient is taken over its prior sigma.
    #[must_use]
    pub fn text(&self) -> String {
        let mut parts: Vec<(usize, f64)> = self.weights.iter().copied().enumerate().collect();
        parts.retain(|(_, weight)| weight.abs() >= NAMED);
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
        let first_sign = parts.first().map_or(1.0, |(_, weight)| weight.signum());
        let mut text = String::new();
        for (index, weight) in parts {
            let weight = weight * first_sign;
            let sign = match (text.is_empty(), weight < 0.0) {
                (true, _) => "",
                (false, true) => " - ",
                (false, false) => " + ",
            };
            let id = DRIFT.get(index).map_or("?", |element| element.id);
            text.push_str(&format!("{sign}{:.2} {id}", weight.abs()));
        }
        text
    }
}

/// Principal combinations whose posterior sigma is at least a tenth of the prior's, in falling order of the
/// ratio: eigenvectors of `covariance` scaled by the prior sigmas.
pub(crate) fn unobservable(
    covariance: &DMatrix<f64>,
    prior_sigma: &[f64],
) -> Vec<UnobservableCombination> {
    let count = prior_sigma.len();
    let scaled = DMatrix::from_fn(count, count, |i, j| {
        covariance[(i, j)] / (prior_sigma[i] * prior_sigma[j])
    });
    let eigen = SymmetricEigen::new(scaled);
    let mut found: Vec<UnobservableCombination> = (0..count)
        .filter_map(|index| {
            let posterior_to_prior_ratio = eigen.eigenvalues[index].max(0.0).sqrt();
            (posterior_to_prior_ratio >= DETERMINED).then(|| UnobservableCombination {
                weights: eigen.eigenvectors.column(index).iter().copied().collect(),
                posterior_to_prior_ratio,
            })
        })
        .collect();
    found.sort_by(|a, b| {
        b.posterior_to_prior_ratio
            .total_cmp(&a.posterior_to_prior_ratio)
    });
    found
}

//! What a record determines, and which combinations of coefficients it does not.

use nalgebra::{DMatrix, SymmetricEigen};

use gyrocal::generated::platform::DRIFT;

/// A combination whose posterior sigma is not below this share of its prior's counts as not
/// determined by the record.
pub(crate) const DETERMINED: f64 = 0.1;

/// Parts of a combination smaller than this are not named.
const NAMED: f64 = 0.15;

/// A combination of coefficients, in units of their prior sigmas, that a record does not
/// determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Undetermined {
    /// Weight of each coefficient; the sum of squares is 1.
    pub weights: Vec<f64>,
    /// Posterior over prior standard deviation.
    pub share_of_prior: f64,
}

impl Undetermined {
    /// The combination with names and signs, largest part first, such as
    /// `0.71 gyro_x.bias - 0.70 gyro_x.g_xx`. Coefficients stand for their ratio to the prior
    /// sigma.
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

/// Combinations that `covariance` leaves at a tenth of the prior or more, least determined first.
pub(crate) fn undetermined(covariance: &DMatrix<f64>, prior_sigma: &[f64]) -> Vec<Undetermined> {
    let count = prior_sigma.len();
    let scaled = DMatrix::from_fn(count, count, |i, j| {
        covariance[(i, j)] / (prior_sigma[i] * prior_sigma[j])
    });
    let eigen = SymmetricEigen::new(scaled);
    let mut found: Vec<Undetermined> = (0..count)
        .filter_map(|index| {
            let share_of_prior = eigen.eigenvalues[index].max(0.0).sqrt();
            (share_of_prior >= DETERMINED).then(|| Undetermined {
                weights: eigen.eigenvectors.column(index).iter().copied().collect(),
                share_of_prior,
            })
        })
        .collect();
    found.sort_by(|a, b| b.share_of_prior.total_cmp(&a.share_of_prior));
    found
}

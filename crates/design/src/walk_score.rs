//! The score test of a random walk in a planned run: steps at every onset with one common variance.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Points of the logarithm of the variance at which the likelihood is looked at, and their
/// distance: from a thousandth of what could be seen to a million times it.
const POINTS: usize = 46;
const RATIO: f64 = 1.584_893_192_461_113_5;
const LEAST: f64 = 1e-3;

/// Score test of a random walk from the scores of its steps z along the eigenvectors of their
/// information λ: max_v Σ [v z² / (1 + v λ) − ln(1 + v λ)].
#[derive(Clone, Debug)]
pub(crate) struct WalkScore {
    /// Eigenvectors of the steps' information, in columns.
    vectors: DMatrix<f64>,
    /// Variances, rising.
    variances: Vec<f64>,
    /// Gain per square of the score along each eigenvector, a row for each variance.
    gains: DMatrix<f64>,
    /// Cost of each variance: the logarithm of the determinant.
    costs: DVector<f64>,
}

impl WalkScore {
    /// From the steps' information.
    pub(crate) fn new(information: DMatrix<f64>) -> Self {
        let eigen = SymmetricEigen::new(information);
        let values = eigen.eigenvalues.map(|value| value.max(0.0));
        let typical = values.max();
        let variances: Vec<f64> = (0..POINTS)
            .map(|point| LEAST * RATIO.powi(point as i32) / typical)
            .filter(|variance| variance.is_finite())
            .collect();
        let inflation = |point: usize, along: usize| 1.0 + variances[point] * values[along];
        let gains = DMatrix::from_fn(variances.len(), values.len(), |point, along| {
            variances[point] / inflation(point, along)
        });
        let costs = DVector::from_fn(variances.len(), |point, _| {
            (0..values.len())
                .map(|along| inflation(point, along).ln())
                .sum()
        });
        Self {
            vectors: eigen.eigenvectors,
            variances,
            gains,
            costs,
        }
    }

    /// Twice the logarithm of the likelihood that the best variance gains over none, and that
    /// variance, from the scores of the steps.
    pub(crate) fn best(&self, score: &DVector<f64>) -> (f64, f64) {
        let squares = self.vectors.tr_mul(score).map(|along| along * along);
        let gained = &self.gains * squares - &self.costs;
        gained
            .iter()
            .zip(&self.variances)
            .fold((0.0, 0.0), |best, (gain, variance)| {
                if *gain > best.0 {
                    (*gain, *variance)
                } else {
                    best
                }
            })
    }
}

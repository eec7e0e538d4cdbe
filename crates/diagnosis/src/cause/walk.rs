//! A random walk as a cause: steps at every onset, with one variance.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Points of the logarithm of the variance at which the likelihood is looked at, and their
/// distance: from a thousandth of what could be seen to a million times it.
const POINTS: usize = 46;
const RATIO: f64 = 1.584_893_192_461_113_5;
const LEAST: f64 = 1e-3;

/// What turns the scores of the steps into the statistic of a walk.
#[derive(Clone, Debug)]
pub(crate) struct Walk {
    values: DVector<f64>,
    vectors: DMatrix<f64>,
}

impl Walk {
    /// From the steps' information.
    pub(crate) fn new(information: DMatrix<f64>) -> Self {
        let eigen = SymmetricEigen::new(information);
        Self {
            values: eigen.eigenvalues.map(|value| value.max(0.0)),
            vectors: eigen.eigenvectors,
        }
    }

    /// Twice the logarithm of the likelihood that the best variance gains over none, and that
    /// variance, from the scores of the steps.
    pub(crate) fn best(&self, score: &DVector<f64>) -> (f64, f64) {
        let along = self.vectors.tr_mul(score);
        let typical = self.values.max();
        if typical <= 0.0 {
            return (0.0, 0.0);
        }
        let mut best = (0.0, 0.0);
        let mut variance = LEAST / typical;
        for _ in 0..POINTS {
            let mut gain = 0.0;
            for (value, along) in self.values.iter().zip(along.iter()) {
                let total = 1.0 + variance * value;
                gain += variance * along * along / total - total.ln();
            }
            if gain > best.0 {
                best = (gain, variance);
            }
            variance *= RATIO;
        }
        best
    }
}

//! Scores and information of signatures with the fitted parameters projected out:
//! J = J_tt − J_tn J_nn⁻¹ J_nt. The strength of injected effects follows from them, hence they share no
//! code with the search that has to find these effects.

use gyrocal::Platform;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_hypothesis::Column;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::signature::Signature;

/// A column is not observable if the projection leaves less than this fraction of its information.
const LEAST_OBSERVABLE: f64 = 1e-9;

/// Scores and information of all parameters of the catalogue and of further columns, given a fit.
#[derive(Debug, Clone)]
pub struct ProjectedScores {
    /// Projected information: sums of products of columns.
    pub information: DMatrix<f64>,
    /// Projected scores: sums of products of columns and innovations.
    pub score: DVector<f64>,
    /// Number of values of the record.
    pub values: usize,
    /// Whitened innovations of the fit, row by row; NaN where there is no value.
    pub whitened: Vec<[f64; 3]>,
    observable: Vec<bool>,
}

impl ProjectedScores {
    /// Computes scores and information in one pass over the record of a fit.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`], and [`CalibrationError::NotPositiveDefinite`] if the record does not
    /// determine the fitted parameters.
    pub fn new(fitted: &FittedPlatform<'_>, further: &[Column]) -> Result<Self, CalibrationError> {
        let mut whitened = vec![[f64::NAN; 3]; fitted.points().len()];
        let reduced = fitted.signatures(further, |value| {
            whitened[value.row][value.output] = value.columns[0];
        })?;
        let extension = fitted.extension();
        let own = extension.columns.columns().len();
        let catalogue = PARAMETERS.len();
        // In the Gram matrix: residual, catalogue, the fit's own further columns, these.
        let fitted_columns: Vec<usize> = (0..Platform::PARAMETERS)
            .chain(extension.parameters.iter().map(|(parameter, _)| *parameter))
            .chain(catalogue..catalogue + own)
            .map(|column| column + 1)
            .collect();
        let candidates: Vec<usize> = (0..catalogue)
            .chain(catalogue + own..catalogue + own + further.len())
            .map(|column| column + 1)
            .collect();
        let gram = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                reduced.gram[(rows[i], columns[j])]
            })
        };
        let weight: Vec<f64> = fitted
            .prior_sigma()
            .iter()
            .map(|sigma| 1.0 / (sigma * sigma))
            .collect();
        let mut inner = gram(&fitted_columns, &fitted_columns);
        for (i, weight) in weight.iter().enumerate() {
            inner[(i, i)] += weight;
        }
        let cholesky = Cholesky::new(inner).ok_or(CalibrationError::NotPositiveDefinite)?;
        let cross = gram(&fitted_columns, &candidates);
        let raw = gram(&candidates, &candidates);
        let taken = cholesky.solve(&cross);
        let information = &raw - cross.tr_mul(&taken);
        // Columns are derivatives of the innovations, hence the signs.
        let gradient = DVector::from_fn(fitted_columns.len(), |i, _| {
            -reduced.gram[(0, fitted_columns[i])] - weight[i] * fitted.values()[i]
        });
        let score = DVector::from_fn(candidates.len(), |j, _| -reduced.gram[(0, candidates[j])])
            - taken.tr_mul(&gradient);
        let observable = (0..candidates.len())
            .map(|j| raw[(j, j)] > 0.0 && information[(j, j)] > LEAST_OBSERVABLE * raw[(j, j)])
            .collect();
        Ok(Self {
            information,
            score,
            values: reduced.values,
            whitened,
            observable,
        })
    }

    /// Given scores and information, with every column observable.
    #[cfg(test)]
    pub(crate) fn of(information: DMatrix<f64>, score: DVector<f64>, values: usize) -> Self {
        Self {
            observable: vec![true; score.len()],
            information,
            score,
            values,
            whitened: Vec::new(),
        }
    }

    /// `true` if every column of an effect is observable given the fit.
    #[must_use]
    pub fn observes(&self, signature: &Signature) -> bool {
        !signature.columns.is_empty()
            && signature
                .columns
                .iter()
                .all(|column| self.observable[*column])
    }

    /// Information block of the sizes of two effects, in the units of their tables.
    #[must_use]
    pub fn product(&self, one: &Signature, other: &Signature) -> DMatrix<f64> {
        DMatrix::from_fn(one.columns.len(), other.columns.len(), |i, j| {
            one.scale * other.scale * self.information[(one.columns[i], other.columns[j])]
        })
    }

    /// Scores of the sizes of an effect, in the unit of its table.
    #[must_use]
    pub fn scores(&self, of: &Signature) -> DVector<f64> {
        DVector::from_fn(of.columns.len(), |i, _| {
            of.scale * self.score[of.columns[i]]
        })
    }

    /// Cosine of the angle between the signature of an effect of known sizes and the span of the
    /// columns of another. 0 if the other is not observable.
    #[must_use]
    pub fn cosine(&self, effect: &Signature, sizes: &[f64], other: &Signature) -> f64 {
        let sizes = DVector::from_column_slice(sizes);
        let square = (self.product(effect, effect) * &sizes).dot(&sizes);
        let cross = self.product(other, effect) * &sizes;
        if !self.observes(other) || square <= 0.0 {
            return 0.0;
        }
        match Cholesky::new(self.product(other, other)) {
            Some(cholesky) => {
                let explained = cholesky.solve(&cross).dot(&cross) / square;
                explained.clamp(0.0, 1.0).sqrt()
            }
            None => 0.0,
        }
    }
}

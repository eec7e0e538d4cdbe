//! Scores and information of columns, with what the fit takes up of them projected out. It says how large
//! what is hidden is, and is written apart from the search that has to find it.

use gyrocal::Platform;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{CalibrationError, Column, Extended};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::signature::Signature;

/// A column of which the fit leaves less than this share cannot be seen.
const VISIBLE: f64 = 1e-9;

/// All parameters of the catalogue and further columns, given a fit.
#[derive(Debug, Clone)]
pub struct Bank {
    /// Sums of products of columns.
    pub information: DMatrix<f64>,
    /// Sums of products of columns and innovations.
    pub score: DVector<f64>,
    /// Number of values of the record.
    pub values: usize,
    /// Whitened innovations of the fit, row by row; NaN where there is no value.
    pub whitened: Vec<[f64; 3]>,
    visible: Vec<bool>,
}

impl Bank {
    /// Passes over the record of a fit once.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`], and [`CalibrationError::NotPositiveDefinite`] if what was fitted
    /// is not determined.
    pub fn new(fitted: &Extended<'_>, further: &[Column]) -> Result<Self, CalibrationError> {
        let mut whitened = vec![[f64::NAN; 3]; fitted.points().len()];
        let reduced = fitted.signatures(further, |value| {
            whitened[value.row][value.output] = value.columns[0];
        })?;
        let extension = fitted.extension();
        let own = extension.further.columns().len();
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
        let visible = (0..candidates.len())
            .map(|j| raw[(j, j)] > 0.0 && information[(j, j)] > VISIBLE * raw[(j, j)])
            .collect();
        Ok(Self {
            information,
            score,
            values: reduced.values,
            whitened,
            visible,
        })
    }

    /// These scores and this information, of which everything can be seen.
    #[cfg(test)]
    pub(crate) fn of(information: DMatrix<f64>, score: DVector<f64>, values: usize) -> Self {
        Self {
            visible: vec![true; score.len()],
            information,
            score,
            values,
            whitened: Vec::new(),
        }
    }

    /// Whether the fit leaves enough of all columns of an effect to be seen.
    #[must_use]
    pub fn sees(&self, signature: &Signature) -> bool {
        !signature.columns.is_empty()
            && signature.columns.iter().all(|column| self.visible[*column])
    }

    /// Products of two effects' columns, in the units of their tables.
    #[must_use]
    pub fn product(&self, one: &Signature, other: &Signature) -> DMatrix<f64> {
        DMatrix::from_fn(one.columns.len(), other.columns.len(), |i, j| {
            one.scale * other.scale * self.information[(one.columns[i], other.columns[j])]
        })
    }

    /// Scores of an effect's columns, in the unit of its table.
    #[must_use]
    pub fn scores(&self, of: &Signature) -> DVector<f64> {
        DVector::from_fn(of.columns.len(), |i, _| {
            of.scale * self.score[of.columns[i]]
        })
    }

    /// Cosine of the angle between an effect of known sizes and the nearest that another can be,
    /// whatever its sizes. 0 if the other cannot be seen.
    #[must_use]
    pub fn cosine(&self, effect: &Signature, sizes: &[f64], other: &Signature) -> f64 {
        let sizes = DVector::from_column_slice(sizes);
        let square = (self.product(effect, effect) * &sizes).dot(&sizes);
        let cross = self.product(other, effect) * &sizes;
        if !self.sees(other) || square <= 0.0 {
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

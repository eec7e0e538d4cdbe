//! All signatures of a record, with what the fit takes up of them projected out.

use gyrocal_calibration::{CalibrationError, Column, Extended};
use nalgebra::{Cholesky, DMatrix, DVector};

/// A signature of which the fit leaves less than this share cannot be seen.
const VISIBLE: f64 = 1e-9;

/// Scores and information of candidate columns, given the model that was fitted.
#[derive(Clone, Debug)]
pub(crate) struct Bank {
    /// Sum of products of each signature with the innovations.
    pub(crate) score: DVector<f64>,
    /// Sums of products of signatures.
    pub(crate) information: DMatrix<f64>,
    /// Information of each signature before anything was projected out.
    pub(crate) raw: DVector<f64>,
}

impl Bank {
    /// Of all parameters of the catalogue, then `further` columns. What the model was extended by
    /// is projected out like the coefficients, but for the values at the places `without`
    /// (counted like [`Extended::values`]): scores are then those of a model that lacks them.
    pub(crate) fn new(
        fitted: &Extended<'_>,
        further: &[Column],
        without: &[usize],
    ) -> Result<Self, CalibrationError> {
        let reduced = fitted.signatures(further, |_| ())?;
        let parameters = gyrocal::Catalogue::PARAMETERS;
        let extension = fitted.extension();
        let own = extension.further.columns().len();
        // Columns in the Gram matrix: residual, catalogue, the extension's own, then further.
        let mut nuisance: Vec<usize> = (0..crate::COEFFICIENTS).collect();
        nuisance.extend(extension.parameters.iter().map(|(parameter, _)| *parameter));
        nuisance.extend(parameters..parameters + own);
        let place = |column: usize| {
            if column < parameters {
                column + 1
            } else {
                column + own + 1
            }
        };
        let columns = parameters + further.len();
        Self::projected(fitted, &reduced.gram, &nuisance, columns, place, without)
    }

    /// Of `further` columns only, beside what the model has.
    pub(crate) fn beside(
        fitted: &Extended<'_>,
        further: &[Column],
    ) -> Result<Self, CalibrationError> {
        let reduced = fitted.beside(further)?;
        let own = fitted.values().len();
        let nuisance: Vec<usize> = (0..own).collect();
        let place = |column: usize| column + own + 1;
        Self::projected(fitted, &reduced.gram, &nuisance, further.len(), place, &[])
    }

    /// From sums of products: residual and columns; `nuisance` are the columns of the model's own
    /// values, `place` those of the signatures, which begin after the residual.
    fn projected(
        fitted: &Extended<'_>,
        gram: &DMatrix<f64>,
        nuisance: &[usize],
        columns: usize,
        place: impl Fn(usize) -> usize,
        without: &[usize],
    ) -> Result<Self, CalibrationError> {
        let values = fitted.values();
        let prior_sigma = fitted.prior_sigma();
        let dropped: Vec<(usize, f64)> = without
            .iter()
            .map(|index| (nuisance[*index] + 1, values[*index]))
            .collect();
        // Score of a column of the Gram matrix, in the model without what was dropped. Columns
        // are derivatives of the innovations, hence the sign.
        let score_of = |column: usize| {
            -gram[(0, column)]
                + dropped
                    .iter()
                    .map(|(at, value)| gram[(*at, column)] * value)
                    .sum::<f64>()
        };
        let (mut gradient, mut precision, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for (index, column) in nuisance.iter().enumerate() {
            if without.contains(&index) {
                continue;
            }
            let weight = prior_sigma[index].powi(-2);
            // Priors have mean zero.
            gradient.push(score_of(column + 1) - weight * values[index]);
            precision.push(weight);
            kept.push(column + 1);
        }
        let nuisance = kept;
        let count = nuisance.len();
        let mut inner = DMatrix::from_fn(count, count, |i, j| gram[(nuisance[i], nuisance[j])]);
        for (i, precision) in precision.iter().enumerate() {
            inner[(i, i)] += precision;
        }
        let cholesky = Cholesky::new(inner).ok_or(CalibrationError::NotPositiveDefinite)?;
        let cross = DMatrix::from_fn(count, columns, |i, j| gram[(nuisance[i], place(j))]);
        // L⁻¹ of the cross terms: what is projected out is its own product.
        let mut taken = cross;
        let lower = cholesky.l();
        lower.solve_lower_triangular_mut(&mut taken);
        let mut gradient = DVector::from_vec(gradient);
        lower.solve_lower_triangular_mut(&mut gradient);
        let mut information = DMatrix::from_fn(columns, columns, |i, j| gram[(place(i), place(j))]);
        let raw = information.diagonal();
        information.gemm_tr(-1.0, &taken, &taken, 1.0);
        let mut score = DVector::from_fn(columns, |j, _| score_of(place(j)));
        score.gemv_tr(-1.0, &taken, &gradient, 1.0);
        Ok(Self {
            score,
            information,
            raw,
        })
    }

    /// Whether the fit leaves enough of a column to be seen.
    pub(crate) fn visible(&self, column: usize) -> bool {
        self.information[(column, column)] > VISIBLE * self.raw[column] && self.raw[column] > 0.0
    }

    /// Information and scores of some columns.
    pub(crate) fn part(&self, columns: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
        let count = columns.len();
        (
            DMatrix::from_fn(count, count, |i, j| {
                self.information[(columns[i], columns[j])]
            }),
            DVector::from_fn(count, |i, _| self.score[columns[i]]),
        )
    }

    /// Estimate and covariance of some columns jointly, and their statistic: chi-square with as
    /// many degrees of freedom as there are columns if the effect is absent. `None` if the fit
    /// leaves too little of them.
    pub(crate) fn joint(&self, columns: &[usize]) -> Option<Joint> {
        if !columns.iter().all(|column| self.visible(*column)) {
            return None;
        }
        let (information, score) = self.part(columns);
        let cholesky = Cholesky::new(information)?;
        let estimate = cholesky.solve(&score);
        Some(Joint {
            statistic: estimate.dot(&score),
            covariance: cholesky.inverse(),
            estimate,
        })
    }
}

/// What the bank says of one candidate.
pub(crate) struct Joint {
    pub(crate) statistic: f64,
    pub(crate) estimate: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
}

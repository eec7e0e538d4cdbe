//! The score bank: scores and information of all signatures, with the fitted unknowns projected out
//! (equations (1) and (2) of the crate).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};

use crate::model::FittedModel;
use gyrocal_inference::{Column, Singular};

/// A signature of which the fit leaves less than this share cannot be seen.
const VISIBLE: f64 = 1e-9;

/// Scores and information of signatures, given the model that was fitted.
#[derive(Clone, Debug)]
pub struct ScoreBank {
    /// Sum of products of each signature with the innovations.
    pub(crate) score: DVector<f64>,
    /// Sums of products of signatures.
    pub(crate) information: DMatrix<f64>,
    /// Information of each signature before anything was projected out.
    pub(crate) raw: DVector<f64>,
}

/// The nominal parameters, estimated with a member of a confidence set in the model.
#[derive(Clone, Debug, PartialEq)]
pub struct NominalEstimate {
    /// The estimates.
    pub values: Vec<f64>,
    /// Covariance of their errors.
    pub covariance: DMatrix<f64>,
}

impl NominalEstimate {
    /// Those of a fit.
    pub(crate) fn of<F: FittedModel>(fitted: &F) -> Self {
        let count = fitted.plant().nominal_parameters;
        let covariance = fitted.covariance().view((0, 0), (count, count));
        Self {
            values: fitted.values()[..count].to_vec(),
            covariance: covariance.into_owned(),
        }
    }
}

/// Sums of products of residual and columns over a record, for a fitted model.
#[derive(Clone, Debug)]
pub(crate) struct GramProducts {
    gram: DMatrix<f64>,
    /// Columns of the model's own values; column 0 is the residual.
    nuisance: Vec<usize>,
    /// Columns of the signatures.
    signatures: Vec<usize>,
    values: Vec<f64>,
    /// What is taken out with a value, in its column: an effect that bends is its size times a column, and its knee
    /// alone adds nothing.
    removed: Vec<f64>,
    prior_sigma: Vec<f64>,
}

impl GramProducts {
    /// One pass with all parameters of the plant, then `further` columns, as signatures.
    pub(crate) fn new<F: FittedModel>(fitted: &F, further: &[Column]) -> Result<Self, F::Error> {
        let gram = fitted.signatures_gram(further)?;
        let plant = fitted.plant();
        let parameters = plant.parameters.len();
        let extension = fitted.extension();
        // In the Gram matrix: innovations, parameters, the extension's own columns, then further.
        let further = parameters + extension.columns.columns().len();
        let nuisance = (0..plant.nominal_parameters)
            .chain(extension.parameters.iter().map(|(parameter, _)| *parameter))
            .chain(parameters..further)
            .map(|column| column + 1)
            .collect();
        let signatures = (1..=parameters).chain(further + 1..gram.nrows()).collect();
        Ok(Self::of(fitted, gram, nuisance, signatures))
    }

    /// One pass with `further` columns as signatures; the unknowns of the fit and `free` columns,
    /// which have no prior, are projected out.
    pub(crate) fn conditional<F: FittedModel>(
        fitted: &F,
        free: &[Column],
        further: &[Column],
    ) -> Result<Self, F::Error> {
        let all: Vec<Column> = free.iter().chain(further).cloned().collect();
        let gram = fitted.conditional_gram(&all)?;
        let own = fitted.values().len() + free.len();
        let (nuisance, signatures) = ((1..=own).collect(), (own + 1..gram.nrows()).collect());
        let mut products = Self::of(fitted, gram, nuisance, signatures);
        products.values.resize(own, 0.0);
        products.removed.resize(own, 0.0);
        products.prior_sigma.resize(own, f64::INFINITY);
        Ok(products)
    }

    fn of<F: FittedModel>(
        fitted: &F,
        gram: DMatrix<f64>,
        nuisance: Vec<usize>,
        signatures: Vec<usize>,
    ) -> Self {
        let values = fitted.values().to_vec();
        let mut removed = values.clone();
        let extension = &fitted.extension().parameters;
        let own = removed[fitted.plant().nominal_parameters..].iter_mut();
        for (value, (parameter, _)) in own.zip(extension) {
            if fitted.plant().is_knee(*parameter) {
                *value = 0.0;
            }
        }
        Self {
            gram,
            nuisance,
            signatures,
            removed,
            values,
            prior_sigma: fitted.prior_sigma(),
        }
    }

    /// Estimates of the first `count` values of the fit with the signatures `columns` of the bank in the
    /// model in place of the values at the places `without`; `None` if they cannot be told apart.
    pub(crate) fn estimates(
        &self,
        without: &[usize],
        columns: &[usize],
        count: usize,
    ) -> Option<NominalEstimate> {
        let gram = &self.gram;
        let kept: Vec<usize> = (0..self.nuisance.len())
            .filter(|index| !without.contains(index))
            .collect();
        let own = kept.iter().map(|index| self.nuisance[*index]);
        let all: Vec<usize> = own
            .chain(columns.iter().map(|column| self.signatures[*column]))
            .collect();
        let mut information = DMatrix::from_fn(all.len(), all.len(), |i, j| gram[(all[i], all[j])]);
        let mut gradient = DVector::from_fn(all.len(), |i, _| {
            let dropped = without
                .iter()
                .map(|index| gram[(self.nuisance[*index], all[i])] * self.removed[*index]);
            dropped.sum::<f64>() - gram[(0, all[i])]
        });
        for (place, index) in kept.iter().enumerate() {
            let weight = self.prior_sigma[*index].powi(-2);
            information[(place, place)] += weight;
            gradient[place] -= weight * self.values[*index];
        }
        let cholesky = Cholesky::new(information)?;
        let change = cholesky.solve(&gradient);
        let covariance = cholesky.inverse();
        Some(NominalEstimate {
            values: (0..count).map(|i| self.values[i] + change[i]).collect(),
            covariance: covariance.view((0, 0), (count, count)).into_owned(),
        })
    }

    /// With what the fit takes up of each signature projected out, but for the values at the places
    /// `without` (counted like [`Extended::values`]): scores are then those of a model that lacks
    /// them.
    pub(crate) fn bank(&self, without: &[usize]) -> Result<ScoreBank, Singular> {
        let Self {
            gram,
            nuisance,
            signatures,
            values,
            removed,
            prior_sigma,
        } = self;
        let dropped: Vec<(usize, f64)> = without
            .iter()
            .map(|index| (nuisance[*index], removed[*index]))
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
            gradient.push(score_of(*column) - weight * values[index]);
            precision.push(weight);
            kept.push(*column);
        }
        let nuisance = kept;
        let count = nuisance.len();
        let mut inner = DMatrix::from_fn(count, count, |i, j| gram[(nuisance[i], nuisance[j])]);
        for (i, precision) in precision.iter().enumerate() {
            inner[(i, i)] += precision;
        }
        let cholesky = Cholesky::new(inner).ok_or(Singular)?;
        let columns = signatures.len();
        let cross = DMatrix::from_fn(count, columns, |i, j| gram[(nuisance[i], signatures[j])]);
        // L⁻¹ of the cross terms: what is projected out is its own product.
        let mut taken = cross;
        let lower = cholesky.l();
        lower.solve_lower_triangular_mut(&mut taken);
        let mut gradient = DVector::from_vec(gradient);
        lower.solve_lower_triangular_mut(&mut gradient);
        let mut information = DMatrix::from_fn(columns, columns, |i, j| {
            gram[(signatures[i], signatures[j])]
        });
        let raw = information.diagonal();
        information.gemm_tr(-1.0, &taken, &taken, 1.0);
        let mut score = DVector::from_fn(columns, |j, _| score_of(signatures[j]));
        score.gemv_tr(-1.0, &taken, &gradient, 1.0);
        Ok(ScoreBank {
            score,
            information,
            raw,
        })
    }
}

impl ScoreBank {
    /// Signatures of all parameters of the plant, then of `further` columns.
    ///
    /// # Errors
    /// Those of a pass over the record, and [`Singular`].
    pub fn new<F: FittedModel>(fitted: &F, further: &[Column]) -> Result<Self, F::Error> {
        Ok(GramProducts::new(fitted, further)?.bank(&[])?)
    }

    /// Signatures of `further` columns only.
    ///
    /// # Errors
    /// Those of a pass over the record, and [`Singular`].
    pub fn conditional<F: FittedModel>(fitted: &F, further: &[Column]) -> Result<Self, F::Error> {
        Ok(GramProducts::conditional(fitted, &[], further)?.bank(&[])?)
    }

    /// Whether the fit leaves enough of a column to be seen.
    #[must_use]
    pub fn visible(&self, column: usize) -> bool {
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

    /// Information and scores of some columns along their principal directions, each column in units of its
    /// information before anything was projected out: an eigenvalue is what the fit leaves of a direction.
    /// `None` without columns, or if one has no information.
    pub(crate) fn principal(&self, columns: &[usize]) -> Option<Principal> {
        let (information, score) = self.part(columns);
        let raw = columns
            .iter()
            .map(|column| self.raw[*column].sqrt().recip());
        let scale = DVector::from_iterator(columns.len(), raw);
        if columns.is_empty() || !scale.iter().all(|scale| scale.is_finite()) {
            return None;
        }
        let scaled = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            information[(i, j)] * scale[i] * scale[j]
        });
        let eigen = SymmetricEigen::new(scaled);
        let along = eigen.eigenvectors.tr_mul(&score.component_mul(&scale));
        Some(Principal {
            eigen,
            along,
            scale,
        })
    }

    /// Chi-square that some columns explain together, whether or not they can be told apart.
    pub(crate) fn explained(&self, columns: &[usize]) -> f64 {
        let columns = columns.iter().copied();
        let seen: Vec<usize> = columns.filter(|column| self.visible(*column)).collect();
        let Some(principal) = self.principal(&seen) else {
            return 0.0;
        };
        let values = principal.eigen.eigenvalues.iter();
        let directions = values.zip(principal.along.iter());
        let told_apart = directions.filter(|(value, _)| **value > VISIBLE);
        told_apart.map(|(value, along)| along * along / value).sum()
    }

    /// Estimate and covariance of some columns jointly, and their statistic: chi-square with as
    /// many degrees of freedom as there are columns if the effect is absent. `None` if the fit
    /// leaves too little of them.
    #[must_use]
    pub fn joint(&self, columns: &[usize]) -> Option<JointScore> {
        if !columns.iter().all(|column| self.visible(*column)) {
            return None;
        }
        let (information, score) = self.part(columns);
        let cholesky = Cholesky::new(information)?;
        let estimate = cholesky.solve(&score);
        Some(JointScore {
            statistic: estimate.dot(&score),
            covariance: cholesky.inverse(),
            estimate,
        })
    }
}

/// Some columns along their principal directions.
pub(crate) struct Principal {
    pub(crate) eigen: SymmetricEigen<f64, Dyn>,
    /// Score along each direction.
    pub(crate) along: DVector<f64>,
    /// Unit of each column.
    pub(crate) scale: DVector<f64>,
}

/// Joint score test of some columns.
#[derive(Clone, Debug)]
pub struct JointScore {
    pub(crate) statistic: f64,
    pub(crate) estimate: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of columns with these products; nothing was projected out.
    fn bank(information: DMatrix<f64>, score: &[f64]) -> ScoreBank {
        ScoreBank {
            raw: information.diagonal(),
            information,
            score: DVector::from_row_slice(score),
        }
    }

    #[test]
    fn columns_explain_as_much_together_as_their_joint_test() {
        let bank = bank(
            DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 9.0]),
            &[6.0, -3.0],
        );
        let joint = bank
            .joint(&[0, 1])
            .map_or(f64::NAN, |joint| joint.statistic);
        // Rounding of a matrix of two rows.
        assert!((bank.explained(&[0, 1]) - joint).abs() < 1e-12 * joint);
    }

    #[test]
    fn equal_columns_explain_as_much_as_one_and_none_explain_nothing() {
        // The second is twice the first: no Cholesky factor, and no joint test.
        let bank = bank(
            DMatrix::from_row_slice(2, 2, &[4.0, 8.0, 8.0, 16.0]),
            &[6.0, 12.0],
        );
        assert!((bank.explained(&[0, 1]) - bank.explained(&[0])).abs() < 1e-12);
        assert!((bank.explained(&[0]) - 9.0).abs() < 1e-12);
        assert!(bank.explained(&[]).abs() < 1e-300);
    }
}

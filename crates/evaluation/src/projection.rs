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

/// Added to the diagonal of the information of columns of unit length, which exact equivalents make
/// singular.
const EQUIVALENTS_APART: f64 = 1e-6;

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
    nominal: NominalCoefficients,
}

/// The drift coefficients at the fit, and their change with the sizes of effects.
#[derive(Debug, Clone)]
struct NominalCoefficients {
    estimates: [f64; 9],
    covariance: DMatrix<f64>,
    /// Decrease of each coefficient (row) for a size of one of each column.
    taken: DMatrix<f64>,
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
        let of = |sigma: &f64| 1.0 / (sigma * sigma);
        let weight: Vec<f64> = fitted.prior_sigma().iter().map(of).collect();
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
        let nominal = NominalCoefficients {
            // The gradient is that of the last step of the fit: zero but for its tolerance.
            estimates: core::array::from_fn(|i| fitted.values()[i]),
            covariance: cholesky.inverse().view((0, 0), (9, 9)).into_owned(),
            taken: taken.rows(0, 9).into_owned(),
        };
        Ok(Self {
            information,
            score,
            values: reduced.values,
            whitened,
            observable,
            nominal,
        })
    }

    /// Estimate and standard deviation of the nine drift coefficients in a model with further columns,
    /// whose sizes are estimated without a prior: the linearised fit, which is exact for effects that
    /// are small against the drift. `None` if the sizes are not determined.
    pub(crate) fn coefficients_with(&self, columns: &[usize]) -> Option<[(f64, f64); 9]> {
        let length = |column: usize| self.information[(column, column)].sqrt();
        let count = columns.len();
        // Columns of unit length. Exact equivalents have equal columns; their sum is determined.
        let mut own = DMatrix::from_fn(count, count, |i, j| {
            self.information[(columns[i], columns[j])] / (length(columns[i]) * length(columns[j]))
        });
        for i in 0..count {
            own[(i, i)] += EQUIVALENTS_APART;
        }
        let own = Cholesky::new(own)?;
        let score = DVector::from_fn(count, |i, _| self.score[columns[i]] / length(columns[i]));
        let taken = DMatrix::from_fn(count, 9, |i, coefficient| {
            self.nominal.taken[(coefficient, columns[i])] / length(columns[i])
        });
        let change = taken.tr_mul(&own.solve(&score));
        let added = taken.tr_mul(&own.solve(&taken));
        Some(core::array::from_fn(|i| {
            let variance = self.nominal.covariance[(i, i)] + added[(i, i)];
            (self.nominal.estimates[i] - change[i], variance.sqrt())
        }))
    }

    /// Given scores and information, with every column observable.
    #[cfg(test)]
    pub(crate) fn of(information: DMatrix<f64>, score: DVector<f64>, values: usize) -> Self {
        Self {
            observable: vec![true; score.len()],
            nominal: NominalCoefficients {
                estimates: [0.0; 9],
                covariance: DMatrix::identity(9, 9),
                taken: DMatrix::zeros(9, score.len()),
            },
            information,
            score,
            values,
            whitened: Vec::new(),
        }
    }

    /// `true` if every column of an effect is observable given the fit.
    #[must_use]
    pub fn observes(&self, signature: &Signature) -> bool {
        let mut columns = signature.columns.iter();
        !signature.columns.is_empty() && columns.all(|column| self.observable[*column])
    }

    /// Information block of the sizes of two effects, in the units of their tables.
    #[must_use]
    pub fn product(&self, one: &Signature, other: &Signature) -> DMatrix<f64> {
        DMatrix::from_fn(one.columns.len(), other.columns.len(), |i, j| {
            one.scale * other.scale * self.information[(one.columns[i], other.columns[j])]
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

#[cfg(test)]
mod tests {
    use gyrocal::EFFECTS;
    use gyrocal_hypothesis::ModelExtension;
    use gyrocal_statistics::deviates::Draw;
    use gyrocal_truth::{Scenario, simulate};

    use super::*;
    use crate::injection::{inject, nominal_fit};
    use crate::scenario::tests::short;

    /// The coefficients beside an effect, by the linearised fit and by a fit of the extended model.
    #[test]
    fn coefficients_beside_an_effect_are_those_of_a_fit_with_it() {
        let scenario = short(4);
        let effect = EFFECTS.iter().find(|of| of.id == "gyro_x.g_y").unwrap();
        let injected = inject(&scenario, &[(effect, None)], 8.0, 1.0, &mut Draw::new(1, 2))
            .unwrap()
            .unwrap();
        let simulation = simulate(&Scenario {
            hidden: vec![injected[0].to_hidden().unwrap()],
            ..scenario
        })
        .unwrap();
        let nominal = nominal_fit(&simulation).unwrap();
        let scores = ProjectedScores::new(&nominal, &[]).unwrap();
        let parameters: Vec<usize> = effect.model_parameters().collect();
        let extended = nominal
            .refitted(&ModelExtension {
                parameters: parameters.iter().map(|of| (*of, f64::INFINITY)).collect(),
                ..ModelExtension::default()
            })
            .unwrap();
        for (fit, columns) in [(&nominal, &[][..]), (&extended, parameters.as_slice())] {
            let found = scores.coefficients_with(columns).unwrap();
            for (i, (estimate, sigma)) in found.into_iter().enumerate() {
                let expected = fit.covariance()[(i, i)].sqrt();
                // Of the next order in a change of some sigmas.
                assert!(
                    (estimate - fit.values()[i]).abs() < 0.02 * expected,
                    "{i}: {estimate} is not {}",
                    fit.values()[i]
                );
                assert!(
                    (sigma / expected - 1.0).abs() < 0.01,
                    "{i}: {sigma} is not {expected}"
                );
            }
        }
        let change = nominal.values()[0] - extended.values()[0];
        assert!(change.abs() > 0.1 * nominal.covariance()[(0, 0)].sqrt());
    }
}

//! Marginal likelihood of parts of a record.

use gyrocal::estimation::batch::Linearisation;
use nalgebra::{Cholesky, DMatrix, DVector};

use super::FittedPlatform;
use crate::error::CalibrationError;
use crate::solve::add_gram;

/// Standard deviation of the prior of an unknown without a declared one, over the size of its
/// estimate.
const WIDE: f64 = 100.0;

impl FittedPlatform<'_> {
    /// Logarithm of the density of the record without the rows of a range, all unknowns integrated
    /// out over their priors, linearised about this fit. Unknowns without a prior get one, of
    /// mean zero and a hundred times as wide as their estimates are large: what the range alone
    /// tells of is else infinitely unlikely.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`] and [`CalibrationError::NotPositiveDefinite`].
    pub fn log_evidence_without(
        &self,
        left_out: core::ops::Range<usize>,
    ) -> Result<f64, CalibrationError> {
        let parameters = self.parameters();
        let reduced = self
            .problem
            .without_rows(0, &parameters, left_out, |pass| {
                let tape = self.solution.tapes[0].as_deref();
                Linearisation { tape, ..*pass }.reduce(|_| ())
            })
            .map_err(|error| CalibrationError::pass(0, error))?;
        let unknowns = &self.problem.unknowns;
        let count = unknowns.len();
        // The pass has the parameters in the order of the model.
        let mut gram = DMatrix::zeros(count + 1, count + 1);
        add_gram(
            &mut gram,
            &reduced.gram,
            &self.problem.runs[0].column_unknowns(),
        );
        let mut information = gram.view((1, 1), (count, count)).into_owned();
        let mut gradient = DVector::zeros(count);
        let mut prior = 0.0;
        for (i, unknown) in unknowns.iter().enumerate() {
            let sigma = if unknown.sigma.is_finite() {
                unknown.sigma
            } else {
                let known = self.uncertainty.total[(i, i)].sqrt();
                WIDE * self.problem.values[i].hypot(known)
            };
            let weight = sigma.powi(-2);
            information[(i, i)] += weight;
            gradient[i] = -gram[(0, i + 1)] - weight * self.problem.values[i];
            prior += weight * self.problem.values[i].powi(2);
            prior -= weight.ln();
        }
        let cholesky = Cholesky::new(information).ok_or(CalibrationError::NotPositiveDefinite)?;
        let gained = cholesky.solve(&gradient).dot(&gradient);
        let determinant = 2.0 * cholesky.l().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        Ok(-0.5
            * (gram[(0, 0)] + prior - gained
                + reduced.log_variance
                + determinant
                + reduced.values as f64 * core::f64::consts::TAU.ln()))
    }
}

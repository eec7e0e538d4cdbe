//! Marginal likelihood of parts of a record.

use gyrocal_hypothesis::RateNoise;
use gyrocal_inference::Pass;
use nalgebra::{Cholesky, DMatrix, DVector};

use super::{AXES, FittedPlatform};
use crate::error::CalibrationError;
use crate::solve::add_gram;

/// Standard deviation of the prior of an unknown without a declared one, over the size of its
/// estimate.
const WIDE: f64 = 100.0;

/// Sums over passes over the records.
struct Seen {
    /// Gram matrix of residual and unknowns.
    gram: DMatrix<f64>,
    /// Sum of the logarithms of the innovations' variances.
    log_variance: f64,
    /// Number of innovations.
    values: usize,
}

impl Seen {
    fn new(unknowns: usize) -> Self {
        Self {
            gram: DMatrix::zeros(unknowns + 1, unknowns + 1),
            log_variance: 0.0,
            values: 0,
        }
    }
}

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
        let mut parts = Seen::new(self.problem.unknowns.len());
        for (run, rows) in self.record_rows().into_iter().enumerate() {
            let parameters = self.problem.parameters(run);
            let within = |row: usize| row.clamp(rows.start, rows.end) - rows.start;
            let own = within(left_out.start)..within(left_out.end);
            let reduced = self
                .problem
                .with_run(run, &parameters, |pass| {
                    Pass {
                        left_out: &own,
                        ..pass.on(self.kept(run))
                    }
                    .reduce(|_| ())
                })
                .map_err(|error| CalibrationError::pass(run, error))?;
            let columns = self.problem.runs[run].column_unknowns();
            add_gram(&mut parts.gram, &reduced.gram, &columns);
            parts.log_variance += reduced.log_variance;
            parts.values += reduced.values;
        }
        self.log_evidence(&parts)
    }

    /// Logarithm of the density of the first `rows` rows with this noise of the gyros, which walk where
    /// they do in this fit; else as [`Self::log_evidence_without`].
    ///
    /// # Errors
    /// As [`Self::log_evidence_without`].
    pub fn log_evidence_of_first(
        &self,
        rows: usize,
        noise: &RateNoise,
    ) -> Result<f64, CalibrationError> {
        let believed = self.rate_noise();
        let mut factors = vec![1.0; AXES];
        for of_kind in [
            [&noise.white, &believed.white],
            [&noise.walk, &believed.walk],
        ] {
            let pairs = of_kind[0].iter().zip(of_kind[1]);
            let walking = pairs.filter(|(_, believed)| **believed > 0.0);
            factors.extend(walking.map(|(size, believed)| (size / believed).powi(2)));
        }
        let mut parts = Seen::new(self.problem.unknowns.len());
        for (run, own) in self.record_rows().into_iter().enumerate() {
            let count = rows.clamp(own.start, own.end) - own.start;
            if count == 0 {
                continue;
            }
            let parameters = self.problem.parameters(run);
            let score = self
                .problem
                .with_first_rows(run, &parameters, count, |pass| {
                    Pass {
                        factors: &factors,
                        ..pass.on(self.kept(run))
                    }
                    .noise_score_of_columns(usize::MAX, &[])
                })
                .map_err(|error| CalibrationError::pass(run, error))?;
            let columns = self.problem.runs[run].column_unknowns();
            add_gram(&mut parts.gram, &score.gram, &columns);
            parts.log_variance += score.log_variance;
            parts.values += score.values;
        }
        self.log_evidence(&parts)
    }

    /// Standard deviation of an unknown before the record, as the evidence takes it.
    #[must_use]
    pub fn evidence_sigma(&self, unknown: usize) -> f64 {
        let declared = self.problem.unknowns[unknown].sigma;
        if declared.is_finite() {
            return declared;
        }
        let known = self.uncertainty.total[(unknown, unknown)].sqrt();
        WIDE * self.problem.values[unknown].hypot(known)
    }

    /// From passes over the records.
    fn log_evidence(
        &self,
        Seen {
            gram,
            log_variance,
            values,
        }: &Seen,
    ) -> Result<f64, CalibrationError> {
        let count = self.problem.unknowns.len();
        let mut information = gram.view((1, 1), (count, count)).into_owned();
        let mut gradient = DVector::zeros(count);
        let mut prior = 0.0;
        for i in 0..count {
            let weight = self.evidence_sigma(i).powi(-2);
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
                + log_variance
                + determinant
                + *values as f64 * core::f64::consts::TAU.ln()))
    }
}

//! Gain of what was found within the records: parts that are left out in turn are predicted from the others.

use core::ops::Range;

use gyrocal_answer::{Gain, Prediction};
use gyrocal_hypothesis::{FittedModel as _, Searched};
use gyrocal_inference::{Pass, Reduced};
use gyrocal_statistics::math::ln;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::fitted_noise::FittedNoise;
use crate::linearised::reduce;
use crate::prediction::least_prior;

/// Parts of one record; of several each is a part.
const PARTS: usize = 6;

/// Log density of each part given the others with the findings, less that without them. Both models have the
/// noise of the one with the findings, each about its own fit. `None` where nothing was found.
///
/// # Errors
/// [`PlantError::Singular`].
pub(crate) fn cross_validated(
    searched: &Searched<FittedPlant>,
) -> Result<Option<Gain>, PlantError> {
    if searched.findings.is_empty() && searched.unmodelled.is_empty() {
        return Ok(None);
    }
    let extended = &searched.fitted;
    let before = searched.nominal.part_scores(&extended.noise)?;
    let after = extended.part_scores(&extended.noise)?;
    let pairs = before.into_iter().zip(after);
    let blocks: Vec<Option<f64>> = pairs
        .map(|(before, after)| Some(after? - before?))
        .collect();
    let effects = searched.findings.iter();
    Ok(Some(Gain {
        effects: effects.map(|one| one.effect.to_owned()).collect(),
        prediction: Prediction::CrossValidated,
        cross_validated_log_score_nats: blocks.iter().flatten().sum(),
        block_log_score_nats: blocks,
        free_run_rms_g: None,
        coefficient_shift: Vec::new(),
        validation: None,
    }))
}

impl FittedPlant {
    /// Logarithm of the density of each part given the others, nats; `None` of a part without which the others do
    /// not determine all unknowns. Noise is as given.
    fn part_scores(&self, noise: &FittedNoise) -> Result<Vec<Option<f64>>, PlantError> {
        let whole = self.log_evidence(0..0, noise)?;
        let parts = self.parts().into_iter();
        parts
            .map(|rows| {
                let others = self.log_evidence(rows, noise)?;
                Ok(whole.zip(others).map(|(whole, others)| whole - others))
            })
            .collect()
    }

    fn parts(&self) -> Vec<Range<usize>> {
        let record = self.record();
        if !record.starts.is_empty() {
            return record.records().collect();
        }
        let end = |part: usize| part * record.len() / PARTS;
        (0..PARTS).map(|part| end(part)..end(part + 1)).collect()
    }

    /// Logarithm of the density of all outputs but those of some rows, states and unknowns integrated out, up to what
    /// all rows have in common; `None` if they do not determine the unknowns.
    fn log_evidence(
        &self,
        without: Range<usize>,
        noise: &FittedNoise,
    ) -> Result<Option<f64>, PlantError> {
        let lines = self.lines();
        let reduced = reduce(&Pass {
            left_out: &without,
            ..self.linearised(&lines)?.pass(noise, &lines)
        })?;
        Ok(self.integrated(&reduced))
    }

    fn integrated(&self, reduced: &Reduced) -> Option<f64> {
        let values = DVector::from_column_slice(&self.solution.at.values);
        let count = values.len();
        let mut sigmas = self.problem.sigmas(self.extension());
        let states = &self.problem.plant.description.states;
        let later = count - self.problem.later();
        let initial = (0..states.len()).chain(later..count);
        for (place, state) in initial.zip(states.iter().cycle()) {
            sigmas[place] = least_prior(state, sigmas[place]);
        }
        let weights = DVector::from_iterator(count, sigmas.iter().map(|sigma| sigma.powi(-2)));
        let gram = &reduced.gram;
        let mut information: DMatrix<f64> = gram.view((1, 1), (count, count)).into_owned();
        for (place, weight) in weights.iter().enumerate() {
            information[(place, place)] += weight;
        }
        // Half the derivative of the cost by the unknowns, at their values in the fit.
        let pulled = weights.component_mul(&values);
        let slope = gram.view((1, 0), (count, 1)).column(0) + &pulled;
        let cholesky = Cholesky::new(information)?;
        let logarithm: f64 = cholesky.l().diagonal().iter().map(|x| 2.0 * ln(*x)).sum();
        let cost = gram[(0, 0)] + pulled.dot(&values) - cholesky.solve(&slope).dot(&slope);
        let rows = reduced.values as f64 * ln(core::f64::consts::TAU);
        Some(-0.5 * (cost + logarithm + reduced.log_variance + rows))
    }
}

//! A plant linearised about a trajectory, and passes over it.

use gyrocal_inference::{Column, LinearisedRows, Pass, Reduced};

use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;

/// A plant about a trajectory.
#[derive(Clone, Debug)]
pub(crate) struct Linearised {
    pub(crate) rows: LinearisedRows,
    /// For each step the derivative of the next states by the noises, each held over the step, times their declared
    /// standard deviations there, by rows.
    pub(crate) by_noises: Vec<f64>,
}

impl Linearised {
    /// A pass with some columns and a noise.
    pub(crate) fn pass<'p>(&'p self, noise: &'p FittedNoise, lines: &'p [Column]) -> Pass<'p> {
        Pass {
            factors: &noise.factors,
            further: noise.further(),
            loose: &noise.loose,
            ..Pass::new(&self.rows, lines)
        }
    }
}

/// Eliminates the states.
///
/// # Errors
/// [`PlantError::Singular`] if the numbers do not suffice, [`PlantError::Stopped`].
pub(crate) fn reduce(pass: &Pass<'_>) -> Result<Reduced, PlantError> {
    let reduced = pass.reduce(|_| ())?;
    let is_finite = reduced.gram.iter().all(|value| value.is_finite());
    is_finite.then_some(reduced).ok_or(PlantError::Singular)
}

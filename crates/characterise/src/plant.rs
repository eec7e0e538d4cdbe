//! Effects of the catalogue at sizes that are numbers of sigmas of their own bounds.

use gyrocal::{EFFECTS, EffectRow};
use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::bank::Bank;
use crate::draw::Draw;
use crate::error::CharacteriseError;
use crate::population::duration_h;
use crate::signature::{Columns, Signature};

/// Onsets are drawn in the middle of the record, this share of it away from both ends.
const MARGIN: f64 = 0.1;

/// Time constants are drawn between this, h, and a quarter of the record.
const SHORTEST_TIME_CONSTANT_H: f64 = 0.5;

/// An effect with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Planted {
    /// The effect.
    pub effect: &'static EffectRow,
    /// Its sizes, in the units of its table.
    pub sizes: Vec<f64>,
    /// Its onset in s or its time constant in h, if it has one.
    pub shape: Option<f64>,
}

impl Planted {
    /// As the simulator takes it.
    ///
    /// # Errors
    /// [`gyrocal_truth::Error`] if the simulator has no such effect or refuses a value.
    pub fn hidden(&self) -> Result<Hidden, gyrocal_truth::Error> {
        let names: &[&str] = if self.effect.kind == "state" {
            &["x_deg", "y_deg", "z_deg"]
        } else {
            self.effect.parameters
        };
        let mut parameters: Vec<(&str, f64)> = names
            .iter()
            .copied()
            .zip(self.sizes.iter().copied())
            .collect();
        if let (Some(shape), Some(name)) = (self.shape, self.effect.parameters.last()) {
            parameters.push((name, shape));
        }
        Hidden::new(self.effect.id, &parameters)
    }

    /// Its length in sigmas of its own bound; 0 if the record says nothing of it.
    ///
    /// # Errors
    /// As [`simulate`], [`Extended::nominal`] and [`Bank::new`].
    pub fn strength(&self, scenario: &Scenario) -> Result<f64, CharacteriseError> {
        let clean = simulate(scenario)?;
        let mut columns = Columns::default();
        let Some(signature) = columns.signature(self.effect, &clean.record, self.shape) else {
            return Ok(0.0);
        };
        let bank = Bank::new(&fitted(&clean)?, &columns.further)?;
        let sizes = DVector::from_column_slice(&self.sizes);
        let square = (bank.product(&signature, &signature) * &sizes).dot(&sizes);
        Ok(square.max(0.0).sqrt())
    }
}

/// The effects of the default search that have a signature and that a scenario's record can show.
#[must_use]
pub fn searched(scenario: &Scenario) -> Vec<&'static EffectRow> {
    let can_show = |effect: &&EffectRow| {
        effect.default_search
            && matches!(effect.kind, "term" | "state")
            && effect.needs.iter().all(|need| match *need {
                "temperature" => scenario.temperature.is_some(),
                "field" => scenario.magnetic_field_gauss.is_some(),
                _ => false,
            })
    };
    EFFECTS.iter().filter(can_show).collect()
}

/// An onset or a time constant for an effect that has one.
pub fn shape(effect: &EffectRow, scenario: &Scenario, draw: &mut Draw) -> Option<f64> {
    match effect.parameters.last() {
        Some(&"onset_s") => {
            Some((MARGIN + (1.0 - 2.0 * MARGIN) * draw.uniform()) * scenario.duration_s)
        }
        Some(&"time_constant_h") => {
            Some(draw.log_uniform([SHORTEST_TIME_CONSTANT_H, 0.25 * duration_h(scenario)]))
        }
        _ => None,
    }
}

/// The nominal model at its best fit to a record, with the noise that its bench declares.
///
/// # Errors
/// As [`Extended::nominal`].
pub fn fitted(simulation: &Simulation) -> Result<Extended<'_>, CharacteriseError> {
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    Ok(Extended::nominal(
        &run,
        &Options::default(),
        &NoiseModel::default(),
    )?)
}

/// Effects in a random direction of their sizes, each `strength` sigmas of its own bound long:
/// with the coefficients, the first attitude and the other effects of the list projected out.
/// `None` if the record, simulated without them, says nothing of one, or if the cosine of the angle
/// between the signatures of two exceeds `largest_cosine`.
///
/// # Errors
/// As [`simulate`], [`Extended::nominal`] and [`Bank::new`].
pub fn plant(
    scenario: &Scenario,
    effects: &[(&'static EffectRow, Option<f64>)],
    strength: f64,
    largest_cosine: f64,
    draw: &mut Draw,
) -> Result<Option<Vec<Planted>>, CharacteriseError> {
    let clean = simulate(scenario)?;
    let fitted = fitted(&clean)?;
    let mut columns = Columns::default();
    let signatures: Option<Vec<Signature>> = effects
        .iter()
        .map(|(effect, shape)| columns.signature(effect, &clean.record, *shape))
        .collect();
    let Some(signatures) = signatures else {
        return Ok(None);
    };
    let bank = Bank::new(&fitted, &columns.further)?;
    if !signatures.iter().all(|signature| bank.sees(signature)) {
        return Ok(None);
    }
    let directions: Vec<Vec<f64>> = signatures
        .iter()
        .map(|signature| {
            let information = bank.product(signature, signature);
            (0..signature.columns.len())
                .map(|i| draw.normal() / information[(i, i)].sqrt())
                .collect()
        })
        .collect();
    for (i, one) in signatures.iter().enumerate() {
        for (direction, other) in directions.iter().zip(&signatures).skip(i + 1) {
            if bank.cosine(other, direction, one) > largest_cosine {
                return Ok(None);
            }
        }
    }
    let mut planted = Vec::with_capacity(effects.len());
    for (i, (effect, shape)) in effects.iter().enumerate() {
        let others: Vec<&Signature> = (0..signatures.len())
            .filter(|other| *other != i)
            .map(|other| &signatures[other])
            .collect();
        let Some(information) = own_information(&bank, &signatures[i], &others) else {
            return Ok(None);
        };
        let direction = DVector::from_column_slice(&directions[i]);
        let length = (&information * &direction).dot(&direction).sqrt();
        if length <= 0.0 || !length.is_finite() {
            return Ok(None);
        }
        planted.push(Planted {
            effect,
            sizes: (direction * (strength / length)).iter().copied().collect(),
            shape: *shape,
        });
    }
    Ok(Some(planted))
}

/// Information on the sizes of an effect with others projected out; `None` if these cannot be told
/// apart from each other.
fn own_information(bank: &Bank, own: &Signature, others: &[&Signature]) -> Option<DMatrix<f64>> {
    let mut information = bank.product(own, own);
    let joined = Signature {
        columns: others
            .iter()
            .flat_map(|other| other.columns.iter().copied())
            .collect(),
        scale: 1.0,
    };
    if !joined.columns.is_empty() {
        let cross = bank.product(&joined, own);
        let inner = Cholesky::new(bank.product(&joined, &joined))?;
        information -= cross.tr_mul(&inner.solve(&cross));
    }
    Some(information)
}

#[cfg(test)]
mod tests;

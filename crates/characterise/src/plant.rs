//! Effects of the catalogue at sizes that are numbers of sigmas of their own bounds.

use gyrocal::effect::{EffectParameter, Need, Role};
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::bank::Bank;
use crate::cell::TRIES;
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
    pub effect: &'static Effect,
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
        // The simulator names an angle with its unit.
        let name = |parameter: &EffectParameter| match parameter.role {
            Role::State(_) => format!("{}_{}", parameter.name, parameter.unit),
            _ => parameter.name.to_owned(),
        };
        let sizes = self.effect.sizes().zip(self.sizes.iter().copied());
        let shape = self.effect.shape().zip(self.shape);
        let parameters: Vec<(String, f64)> = sizes
            .chain(shape)
            .map(|(parameter, value)| (name(parameter), value))
            .collect();
        let parameters: Vec<(&str, f64)> = parameters
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect();
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
pub fn searched(scenario: &Scenario) -> Vec<&'static Effect> {
    let can_show = |effect: &&Effect| {
        effect.default_search
            && effect.has_signature()
            && effect.needs.iter().all(|need| match need {
                Need::Column(_) => scenario.temperature.is_some(),
                Need::Key(_) => scenario.magnetic_field_gauss.is_some(),
            })
    };
    EFFECTS.iter().filter(can_show).collect()
}

/// An onset or a time constant for an effect that has one.
pub fn shape(effect: &Effect, scenario: &Scenario, draw: &mut Draw) -> Option<f64> {
    match effect.shape()?.role {
        Role::TimeConstant(_) => {
            Some(draw.log_uniform([SHORTEST_TIME_CONSTANT_H, 0.25 * duration_h(scenario)]))
        }
        _ => Some((MARGIN + (1.0 - 2.0 * MARGIN) * draw.uniform()) * scenario.duration_s),
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
    effects: &[(&'static Effect, Option<f64>)],
    strength: f64,
    largest_cosine: f64,
    draw: &mut Draw,
) -> Result<Option<Vec<Planted>>, CharacteriseError> {
    let clean = simulate(scenario)?;
    let fitted = fitted(&clean)?;
    plant_in(&clean, &fitted, effects, strength, largest_cosine, draw)
}

/// A scenario with any effect that its record can show, `strength` sigmas of its own bound large,
/// and that effect.
///
/// # Errors
/// As [`plant`], and [`CharacteriseError::NothingToHide`] if none of those that were tried shows.
pub fn plant_any(
    scenario: Scenario,
    strength: f64,
    draw: &mut Draw,
) -> Result<(Scenario, Planted), CharacteriseError> {
    let effects = searched(&scenario);
    let clean = simulate(&scenario)?;
    let fitted = fitted(&clean)?;
    for _ in 0..TRIES {
        let effect = *draw.one_of(&effects);
        let with_shape = [(effect, shape(effect, &scenario, draw))];
        let planted = plant_in(&clean, &fitted, &with_shape, strength, 1.0, draw)?;
        if let Some(only) = planted.and_then(|planted| planted.into_iter().next()) {
            let scenario = Scenario {
                hidden: vec![only.hidden()?],
                ..scenario
            };
            return Ok((scenario, only));
        }
    }
    Err(CharacteriseError::NothingToHide {
        tried: TRIES,
        strength,
    })
}

/// The same in a record without them that is simulated and fitted already.
///
/// # Errors
/// As [`Bank::new`].
pub fn plant_in(
    clean: &Simulation,
    fitted: &Extended<'_>,
    effects: &[(&'static Effect, Option<f64>)],
    strength: f64,
    largest_cosine: f64,
    draw: &mut Draw,
) -> Result<Option<Vec<Planted>>, CharacteriseError> {
    let mut columns = Columns::default();
    let signatures: Option<Vec<Signature>> = effects
        .iter()
        .map(|(effect, shape)| columns.signature(effect, &clean.record, *shape))
        .collect();
    let Some(signatures) = signatures else {
        return Ok(None);
    };
    let bank = Bank::new(fitted, &columns.further)?;
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
#[allow(clippy::unwrap_used)]
mod tests;

//! Injection of effects of the catalogue at a given strength, in sigmas of their own bound.

use gyrocal::effect::{EffectParameter, Need, Role};
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, DiagnosisError, diagnose};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::error::EvaluationError;
use crate::projection::ProjectedScores;
use crate::signature::{Signature, SignatureColumns};

/// Onsets are drawn from the middle of the record, this fraction of it away from both ends.
const MARGIN: f64 = 0.1;

/// Number of draws of an effect that the record must show before the record is given up.
pub(crate) const MAX_DRAWS: usize = 200;

/// Time constants are drawn between this, h, and a quarter of the record.
const SHORTEST_TIME_CONSTANT_H: f64 = 0.5;

/// An effect of the catalogue with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct InjectedEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Sizes, in the units of the effect's table.
    pub sizes: Vec<f64>,
    /// Onset in s or time constant in h, of effects that have one.
    pub shape: Option<f64>,
}

impl InjectedEffect {
    /// The effect as an input of the simulator.
    ///
    /// # Errors
    /// [`gyrocal_truth::Error`] if the simulator has no such effect or refuses a value.
    pub fn to_hidden(&self) -> Result<Hidden, gyrocal_truth::Error> {
        // The simulator names an angle with its unit.
        let name = |parameter: &EffectParameter| match parameter.role {
            Role::State(_) => format!("{}_{}", parameter.name, parameter.unit),
            _ => parameter.name.to_owned(),
        };
        let sizes = self.effect.sizes().zip(self.sizes.iter().copied());
        let shape = self.effect.shape().zip(self.shape);
        let all = sizes.chain(shape);
        let all: Vec<(String, f64)> = all.map(|(of, value)| (name(of), value)).collect();
        let parameters: Vec<(&str, f64)> = all.iter().map(|(name, of)| (&**name, *of)).collect();
        Hidden::new(self.effect.id, &parameters)
    }

    /// Strength of the effect, in sigmas of its own bound; 0 if the record does not show it.
    ///
    /// # Errors
    /// As [`simulate`], [`FittedPlatform::nominal`] and [`ProjectedScores::new`].
    pub fn strength(&self, scenario: &Scenario) -> Result<f64, EvaluationError> {
        let clean = simulate(scenario)?;
        let mut columns = SignatureColumns::default();
        let Some(signature) = columns.signature(self.effect, &clean.record, self.shape) else {
            return Ok(0.0);
        };
        let scores = ProjectedScores::new(&nominal_fit(&clean)?, &columns.further)?;
        let sizes = DVector::from_column_slice(&self.sizes);
        let square = (scores.product(&signature, &signature) * &sizes).dot(&sizes);
        Ok(square.max(0.0).sqrt())
    }
}

/// Effects of the default search that have a signature and whose inputs the record of a scenario has.
#[must_use]
pub fn testable_effects(scenario: &Scenario) -> Vec<&'static Effect> {
    let testable = |effect: &&Effect| {
        effect.default_search
            && effect.has_signature()
            && effect.needs.iter().all(|need| match need {
                Need::Column(_) => scenario.temperature.is_some(),
                Need::Key(_) => scenario.magnetic_field_gauss.is_some(),
            })
    };
    EFFECTS.iter().filter(testable).collect()
}

/// Draws an onset or a time constant for an effect that has one.
pub fn draw_shape(effect: &Effect, scenario: &Scenario, random: &mut Draw) -> Option<f64> {
    match effect.shape()?.role {
        Role::TimeConstant(_) => {
            let duration_h = scenario.duration_s / 3600.0;
            Some(random.log_uniform([SHORTEST_TIME_CONSTANT_H, 0.25 * duration_h]))
        }
        _ => Some((MARGIN + (1.0 - 2.0 * MARGIN) * random.uniform()) * scenario.duration_s),
    }
}

/// The nominal model fitted to a record, with the noise that its bench declares.
///
/// # Errors
/// As [`FittedPlatform::nominal`].
pub fn nominal_fit(simulation: &Simulation) -> Result<FittedPlatform<'_>, EvaluationError> {
    fit(simulation, &NoiseModel::default())
}

/// The same with another noise.
pub(crate) fn fit<'r>(
    simulation: &'r Simulation,
    noise: &NoiseModel,
) -> Result<FittedPlatform<'r>, EvaluationError> {
    let run = run_of(simulation);
    Ok(FittedPlatform::nominal(&run, &Options::default(), noise)?)
}

/// The record of a simulation with its bench description.
#[must_use]
pub fn run_of(Simulation { record, bench, .. }: &Simulation) -> Run<'_> {
    Run { record, bench }
}

/// The diagnosis of a simulated record by default options.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnosed(
    Simulation { record, bench, .. }: &Simulation,
) -> Result<Diagnosis<'_>, DiagnosisError> {
    diagnose(record, bench, &DiagnoseOptions::default())
}

/// Draws sizes of effects, in a random direction and each of `strength` sigmas of its own bound: with
/// the coefficients, the initial attitude and the other effects of the list projected out. `None` if
/// the record, simulated without them, does not show one of them, or if the cosine of the angle
/// between the signatures of two exceeds `largest_cosine`.
///
/// # Errors
/// As [`simulate`], [`FittedPlatform::nominal`] and [`ProjectedScores::new`].
pub fn inject(
    scenario: &Scenario,
    effects: &[(&'static Effect, Option<f64>)],
    strength: f64,
    largest_cosine: f64,
    random: &mut Draw,
) -> Result<Option<Vec<InjectedEffect>>, EvaluationError> {
    let clean = simulate(scenario)?;
    let fitted = nominal_fit(&clean)?;
    inject_into(&clean, &fitted, effects, strength, largest_cosine, random)
}

/// Injects one randomly drawn effect of `strength` sigmas of its own bound into a scenario, beside what is hidden in
/// it; returns scenario and effect.
///
/// # Errors
/// As [`inject`], and [`EvaluationError::NotInjectable`] if the record shows none of those drawn.
pub fn inject_any(
    scenario: Scenario,
    strength: f64,
    random: &mut Draw,
) -> Result<(Scenario, InjectedEffect), EvaluationError> {
    let effects = testable_effects(&scenario);
    inject_one_of(&effects, scenario, &NoiseModel::default(), strength, random)
}

/// As [`inject_any`], of these effects, with their strength in this noise.
///
/// # Errors
/// As [`inject_any`].
pub fn inject_one_of(
    effects: &[&'static Effect],
    mut scenario: Scenario,
    noise: &NoiseModel,
    strength: f64,
    random: &mut Draw,
) -> Result<(Scenario, InjectedEffect), EvaluationError> {
    let clean = simulate(&scenario)?;
    let fitted = fit(&clean, noise)?;
    let tried = if effects.is_empty() { 0 } else { MAX_DRAWS };
    let only = first_of(tried, strength, |_| {
        let effect = *random.one_of(effects);
        let with_shape = [(effect, draw_shape(effect, &scenario, random))];
        let injected = inject_into(&clean, &fitted, &with_shape, strength, 1.0, random)?;
        Ok(injected.and_then(|injected| injected.into_iter().next()))
    })?;
    scenario.hidden.push(only.to_hidden()?);
    Ok((scenario, only))
}

/// What the first of so many draws gives that gives anything.
pub(crate) fn first_of<T>(
    draws: usize,
    strength: f64,
    mut draw: impl FnMut(usize) -> Result<Option<T>, EvaluationError>,
) -> Result<T, EvaluationError> {
    let none = EvaluationError::NotInjectable {
        tried: draws,
        strength,
    };
    let mut found = (0..draws).filter_map(|number| draw(number).transpose());
    found.next().unwrap_or(Err(none))
}

/// As [`inject`], for a record without the effects that is simulated and fitted already.
///
/// # Errors
/// As [`ProjectedScores::new`].
pub fn inject_into(
    clean: &Simulation,
    fitted: &FittedPlatform<'_>,
    effects: &[(&'static Effect, Option<f64>)],
    strength: f64,
    largest_cosine: f64,
    random: &mut Draw,
) -> Result<Option<Vec<InjectedEffect>>, EvaluationError> {
    let mut columns = SignatureColumns::default();
    let signatures: Option<Vec<Signature>> = effects
        .iter()
        .map(|(effect, shape)| columns.signature(effect, &clean.record, *shape))
        .collect();
    let Some(signatures) = signatures else {
        return Ok(None);
    };
    let scores = ProjectedScores::new(fitted, &columns.further)?;
    if !signatures.iter().all(|one| scores.observes(one)) {
        return Ok(None);
    }
    let mut direction = |signature: &Signature| -> Vec<f64> {
        let sigmas = scores
            .product(signature, signature)
            .diagonal()
            .map(f64::sqrt);
        sigmas.iter().map(|sigma| random.normal() / sigma).collect()
    };
    let directions: Vec<Vec<f64>> = signatures.iter().map(&mut direction).collect();
    for (i, one) in signatures.iter().enumerate() {
        for (direction, other) in directions.iter().zip(&signatures).skip(i + 1) {
            if scores.cosine(other, direction, one) > largest_cosine {
                return Ok(None);
            }
        }
    }
    let mut injected = Vec::with_capacity(effects.len());
    for (i, (effect, shape)) in effects.iter().enumerate() {
        let others = (0..signatures.len()).filter(|other| *other != i);
        let others = others.flat_map(|other| signatures[other].columns.iter().copied());
        let Some(information) = own_information(&scores, &signatures[i], others.collect()) else {
            return Ok(None);
        };
        let direction = DVector::from_column_slice(&directions[i]);
        let length = (&information * &direction).dot(&direction).sqrt();
        if length <= 0.0 || !length.is_finite() {
            return Ok(None);
        }
        injected.push(InjectedEffect {
            effect,
            sizes: (direction * (strength / length)).iter().copied().collect(),
            shape: *shape,
        });
    }
    Ok(Some(injected))
}

/// Information on the sizes of an effect with the columns of others projected out; `None` if these are not
/// distinguishable from each other.
fn own_information(
    scores: &ProjectedScores,
    own: &Signature,
    others: Vec<usize>,
) -> Option<DMatrix<f64>> {
    let mut information = scores.product(own, own);
    let (columns, scale) = (others, 1.0);
    let joined = Signature { columns, scale };
    if !joined.columns.is_empty() {
        let cross = scores.product(&joined, own);
        let inner = Cholesky::new(scores.product(&joined, &joined))?;
        information -= cross.tr_mul(&inner.solve(&cross));
    }
    Some(information)
}

#[cfg(test)]
mod tests;

//! Effects that are not in the catalogue, scaled to a strength given the findings of the diagnosis.
//!
//! Such an effect has no signature in the linearised model. Its strength is the length of the change
//! in the whitened residuals: the fitted model, with the effects that the diagnosis named and the noise that it
//! believes, is fitted to the record with and without the effect. Beside a random walk that takes the effect up
//! little of it is left, as no record tells a slow function of time from a walk.

use gyrocal_diagnosis::Diagnosis;
use gyrocal_hypothesis::{Column, ExtraColumns, ModelExtension};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::{UnlistedEffect, UnlistedKind};
use gyrocal_truth::{Scenario, Simulation, simulate};

use crate::error::EvaluationError;
use crate::injection::{diagnosed, first_of, fit, nominal_fit};
use crate::record_score::{InjectedScore, RecordScore};
use crate::score::findings_score;

/// Corrections of a size after a diagnosis: the findings depend on the size.
const CORRECTIONS: usize = 3;

/// A strength within this fraction of the requested one needs no correction.
const NEAR: f64 = 0.1;

/// Largest correction factor: a finding may have absorbed almost all of the effect.
const LARGEST_CORRECTION: f64 = 4.0;

/// Number of effects drawn before a record is given up.
pub(crate) const MAX_DRAWS: usize = 8;

/// The strength given the nominal model must be within this factor of the requested one: effects that
/// switch are not proportional to their size.
const REACHED: f64 = 1.2;

/// Injects an effect that is not in the catalogue, diagnoses the record and returns its score.
///
/// # Errors
/// [`EvaluationError::NotInjectable`] if none of the effects drawn reaches the strength, and the errors
/// of simulation, calibration and diagnosis.
pub(crate) fn score_out_of_catalogue(
    number: u64,
    scenario: &Scenario,
    strength: f64,
    random: &mut Draw,
) -> Result<RecordScore, EvaluationError> {
    first_of(MAX_DRAWS, strength, |attempt| {
        let kinds = UnlistedKind::ALL;
        let kind = kinds[(number as usize + attempt) % kinds.len()];
        let effect = UnlistedEffect::draw(kind, scenario, random)?;
        match UnlistedRecord::scaled(scenario, effect, strength)? {
            Some(record) => scored(scenario, record, strength),
            None => Ok(None),
        }
    })
}

/// Diagnoses the record with the effect, and corrects the size until the strength beside what is named is
/// the requested one, or as near as some corrections come: names may leave nothing of it. `None` if they cannot
/// be fitted to the record without it.
fn scored(
    scenario: &Scenario,
    mut record: UnlistedRecord,
    strength: f64,
) -> Result<Option<RecordScore>, EvaluationError> {
    let mut corrections = 0;
    loop {
        let found = diagnosed(&record.with)?;
        let Some(reached) = record.strength_beside(&found) else {
            return Ok(None);
        };
        let factor = strength / reached;
        if (factor - 1.0).abs() < NEAR || corrections == CORRECTIONS {
            return Ok(Some(RecordScore {
                hidden: vec![InjectedScore {
                    effect: record.effect.id,
                    strength: reached,
                    ..InjectedScore::default()
                }],
                ..findings_score(&found.result)
            }));
        }
        let effect = &mut record.effect;
        effect.size = (effect.size * factor.min(LARGEST_CORRECTION)).min(effect.largest_size);
        record.with = record.effect.simulate(scenario)?;
        corrections += 1;
    }
}

/// A record with an effect that the catalogue does not hold, and the same record without it.
pub struct UnlistedRecord {
    /// The record without the effect.
    pub clean: Simulation,
    /// The record with it.
    pub with: Simulation,
    /// The effect.
    pub effect: UnlistedEffect,
}

impl UnlistedRecord {
    /// Draws an effect of a kind and scales it to a strength given the nominal model; `None` if none of
    /// those drawn reaches it.
    ///
    /// # Errors
    /// Those of simulation and calibration.
    pub fn draw(
        scenario: &Scenario,
        kind: UnlistedKind,
        strength: f64,
        random: &mut Draw,
    ) -> Result<Option<Self>, EvaluationError> {
        for _ in 0..MAX_DRAWS {
            let effect = UnlistedEffect::draw(kind, scenario, random)?;
            if let Some(record) = Self::scaled(scenario, effect, strength)? {
                return Ok(Some(record));
            }
        }
        Ok(None)
    }

    /// A record with an effect that is scaled to a strength given the nominal model; `None` if it does not
    /// reach it.
    ///
    /// # Errors
    /// Those of simulation and calibration.
    pub fn scaled(
        scenario: &Scenario,
        mut effect: UnlistedEffect,
        strength: f64,
    ) -> Result<Option<Self>, EvaluationError> {
        let clean = simulate(scenario)?;
        let with = scale(scenario, &clean, &mut effect, strength)?;
        Ok(with.map(|with| Self {
            clean,
            with,
            effect,
        }))
    }

    /// Strength of the effect beside the effects and the noise of a diagnosis of the record with it: the
    /// length of the change of the whitened residuals. `None` if that model cannot be fitted.
    #[must_use]
    pub fn strength_beside(&self, found: &Diagnosis<'_>) -> Option<f64> {
        let extended = found.extended.as_ref();
        let named = extended.map_or_else(ModelExtension::default, |extended| {
            named_effects(extended.extension())
        });
        let residuals = |simulation: &Simulation| {
            let nominal = fit(simulation, &found.noise_model).ok()?;
            nominal.refitted(&named).ok()?.whitened().ok()
        };
        Some(distance(&residuals(&self.clean)?, &residuals(&self.with)?))
    }
}

/// Scales an effect to a strength given the nominal model; the record with it, or `None` if it cannot be reached.
fn scale(
    scenario: &Scenario,
    clean: &Simulation,
    effect: &mut UnlistedEffect,
    strength: f64,
) -> Result<Option<Simulation>, EvaluationError> {
    let without = whitened_residuals(clean)?;
    for _ in 0..=CORRECTIONS {
        let Ok(simulation) = effect.simulate(scenario) else {
            return Ok(None);
        };
        let Ok(with) = whitened_residuals(&simulation) else {
            return Ok(None);
        };
        let factor = strength / distance(&without, &with);
        if (1.0 / REACHED..REACHED).contains(&factor) {
            return Ok(Some(simulation));
        }
        effect.size *= factor;
        if !(1e-4..1e4).contains(&factor) || effect.size > effect.largest_size {
            return Ok(None);
        }
    }
    Ok(None)
}

/// Whitened residuals of the nominal model that is fitted to a record.
fn whitened_residuals(simulation: &Simulation) -> Result<Vec<[f64; 3]>, EvaluationError> {
    Ok(nominal_fit(simulation)?.whitened()?)
}

/// Length of the difference between the whitened residuals of one model fitted to two records with
/// the same noise.
fn distance(without: &[[f64; 3]], with: &[[f64; 3]]) -> f64 {
    let both = without.iter().flatten().zip(with.iter().flatten());
    let differences = both.map(|(without, with)| with - without);
    let there = differences.filter(|difference| !difference.is_nan());
    there
        .map(|difference| difference * difference)
        .sum::<f64>()
        .sqrt()
}

/// The extension without unmodelled terms: the spectral lines and curves that the search added have no
/// name and count as unexplained.
fn named_effects(extension: &ModelExtension) -> ModelExtension {
    let further = &extension.columns;
    let mut named = ExtraColumns::default();
    for (column, sigma) in further.columns().iter().zip(further.sigmas()) {
        if !matches!(column, Column::TimeProfile { .. } | Column::Output { .. }) {
            named.extend([column.clone()], *sigma);
        }
    }
    ModelExtension {
        columns: named,
        ..extension.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::tests::short;

    #[test]
    fn every_kind_is_scaled_to_its_strength() {
        let scenario = short(3);
        let mut scaled = 0;
        for (number, kind) in UnlistedKind::ALL.into_iter().enumerate() {
            let random = &mut Draw::new(number as u64, 0);
            let effect = UnlistedEffect::draw(kind, &scenario, random).unwrap();
            if let Some(record) = UnlistedRecord::scaled(&scenario, effect, 10.0).unwrap() {
                scaled += 1;
                let of = |one| whitened_residuals(one).unwrap();
                let strength = distance(&of(&record.clean), &of(&record.with));
                let reached = 10.0 / REACHED..10.0 * REACHED;
                assert!(reached.contains(&strength), "{strength}");
                // Scaling does not change the sign.
                assert!(record.effect.size > 0.0);
            }
        }
        // A term whose force never changes its sign in a day is a constant, and cannot be scaled.
        assert!(scaled >= 6, "{scaled}");
    }

    #[test]
    fn beside_a_random_walk_a_slow_drift_is_nothing_and_an_accelerometer_what_it_was() {
        let scenario = short(3);
        // Strength without a walk, and beside one of each gyro that does in a day what the effect does.
        let strengths = |kind: UnlistedKind| {
            let random = &mut Draw::new(5, 0);
            let record = UnlistedRecord::draw(&scenario, kind, 10.0, random).unwrap();
            let record = record.unwrap();
            let mut found = diagnosed(&record.clean).unwrap();
            assert!(found.extended.is_none());
            let without = record.strength_beside(&found).unwrap();
            found.noise_model.gyro_walk_deg_per_h_per_sqrt_h = [0.003; 3];
            [without, record.strength_beside(&found).unwrap()]
        };
        // The effect is scaled to 10 within a fifth, by the declared noise and not by that of the diagnosis.
        for (kind, left) in [
            (UnlistedKind::TimeProduct, 0.0..0.1),
            (UnlistedKind::Lag, 0.0..0.1),
            (UnlistedKind::Rectified, 0.9..1.0),
            (UnlistedKind::AgeingScale, 0.9..1.0),
        ] {
            let [without, beside] = strengths(kind);
            assert!((8.0..13.0).contains(&without), "{kind:?}: {without}");
            assert!(left.contains(&(beside / without)), "{kind:?}: {beside}");
        }
    }
}

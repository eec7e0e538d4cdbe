//! Random draws of the effects that a cell injects, with their strengths.

use gyrocal::effect::EffectKind;
use gyrocal::generated::catalogue::parameters_index;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::NoiseModel;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};

use crate::error::EvaluationError;
use crate::injection::{
    InjectedEffect, MAX_DRAWS, draw_shape, first_of, inject_into, inject_one_of, nominal_fit,
    testable_effects,
};

/// Two effects are injected together if the cosine between their signatures is less.
const LARGEST_COSINE: f64 = 0.6;

/// Indices of the cubic terms of the gyros along their input axes.
const CUBICS: [usize; 3] = [
    parameters_index::GYRO_X_G_XXX,
    parameters_index::GYRO_Y_G_YYY,
    parameters_index::GYRO_Z_G_ZZZ,
];

/// Error of the initial azimuth, deg.
const AZIMUTH_DEG: f64 = 0.1;

/// Step of a low-discrepancy sequence: the fractional parts of its multiples fill the interval from 0
/// to 1 evenly, however many there are. The golden ratio less one.
const EVENLY: f64 = 0.618_033_988_749_894_9;

/// The steps of the gyros.
pub(super) fn is_step(effect: &Effect) -> bool {
    effect.kind == EffectKind::Step && effect.rate().is_some()
}

/// The cubic terms of the gyros along their input axes.
pub(super) fn is_cubic(effect: &Effect) -> bool {
    effect
        .model_parameters()
        .any(|parameter| CUBICS.contains(&parameter))
}

type Drawn = Result<Vec<(InjectedEffect, f64)>, EvaluationError>;

/// The list that single effects are taken from: every effect once, those without a sister on another
/// axis three times.
fn schedule(effects: &[&'static Effect]) -> Vec<&'static Effect> {
    let mut schedule = effects.to_vec();
    for effect in effects {
        if effect.family == effect.id {
            schedule.extend([effect, effect]);
        }
    }
    schedule
}

/// One effect, evenly over the list; a randomly drawn one if the record does not show it.
pub(super) fn single(seed: u64, scenario: &Scenario, strength: f64, random: &mut Draw) -> Drawn {
    let effects = schedule(&testable_effects(scenario));
    let clean = simulate(scenario)?;
    let fitted = nominal_fit(&clean)?;
    let injected = first_of(MAX_DRAWS, strength, |attempt| {
        let effect = match attempt {
            0 => effects[((seed as f64 * EVENLY).fract() * effects.len() as f64) as usize],
            _ => *random.one_of(&effects),
        };
        let with_shape = [(effect, draw_shape(effect, scenario, random))];
        inject_into(&clean, &fitted, &with_shape, strength, 1.0, random)
    })?;
    Ok(with_strength(injected, strength))
}

/// Two effects that are not exact equivalents and whose signatures are not close.
pub(super) fn pair(scenario: &Scenario, strength: f64, random: &mut Draw) -> Drawn {
    let effects = testable_effects(scenario);
    let clean = simulate(scenario)?;
    let fitted = nominal_fit(&clean)?;
    let injected = first_of(MAX_DRAWS, strength, |_| {
        let one = *random.one_of(&effects);
        let other = *random.one_of(&effects);
        if one.id == other.id || one.equivalents.contains(&other.id) {
            return Ok(None);
        }
        let both = [one, other].map(|effect| (effect, draw_shape(effect, scenario, random)));
        inject_into(&clean, &fitted, &both, strength, LARGEST_COSINE, random)
    })?;
    Ok(with_strength(injected, strength))
}

/// One of the effects that a condition selects.
pub(super) fn one_of(
    selects: fn(&Effect) -> bool,
    scenario: &Scenario,
    strength: f64,
    random: &mut Draw,
) -> Drawn {
    let effects: Vec<&'static Effect> = EFFECTS.iter().filter(|effect| selects(effect)).collect();
    let noise = NoiseModel::default();
    let (_, one) = inject_one_of(&effects, scenario.clone(), &noise, strength, random)?;
    Ok(vec![(one, strength)])
}

/// A rotation of the platform about the vertical at the first row.
pub(super) fn azimuth(scenario: &Scenario, random: &mut Draw) -> Drawn {
    let kind = EffectKind::InitialState;
    let effect = EFFECTS.iter().find(|effect| effect.kind == kind);
    let effect = effect.ok_or(EvaluationError::MissingEffect { kind })?;
    let platform_c_enu = scenario.platform().initial_platform_c_enu.matrix();
    let angle_deg = AZIMUTH_DEG * random.sign();
    let injected = InjectedEffect {
        effect,
        sizes: platform_c_enu.map(|row| angle_deg * row[2]).to_vec(),
        shape: None,
    };
    let strength = injected.strength(scenario)?;
    Ok(vec![(injected, strength)])
}

fn with_strength(injected: Vec<InjectedEffect>, strength: f64) -> Vec<(InjectedEffect, f64)> {
    injected.into_iter().map(|one| (one, strength)).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::scenario::scenario;

    /// A full cell omits no effect and draws none much more often than the list says.
    #[test]
    fn single_effects_are_drawn_evenly() {
        let scenario = Scenario {
            temperature: Some(gyrocal_truth::Temperature::default()),
            ..scenario(1)
        };
        let effects = schedule(&testable_effects(&scenario));
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for seed in 0..1000_u64 {
            let place = ((seed as f64 * EVENLY).fract() * effects.len() as f64) as usize;
            *counts.entry(effects[place].id).or_default() += 1;
        }
        let even = 1000.0 / effects.len() as f64;
        for effect in testable_effects(&scenario) {
            let single = effect.family == effect.id;
            let times = if single { 3.0 } else { 1.0 };
            let count = counts.get(effect.id).copied().unwrap_or(0) as f64;
            // The golden sequence is off by fewer than two in any interval.
            let off = (count - times * even).abs();
            assert!(off < 1.0 + times, "{}: {count}", effect.id);
        }
    }
}

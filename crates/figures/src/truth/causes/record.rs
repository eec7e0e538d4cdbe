//! One record of a population with a cause, diagnosed.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run, rows};
use gyrocal_diagnosis::result::{Coefficients, DiagnosisResult, Finding};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, diagnose};
use gyrocal_evaluation::{
    EvaluationError, InjectedEffect, draw_shape, inject_into, same_or_equivalent, scenario,
    sets_without_walks, testable_effects,
};
use gyrocal_hypothesis::{FittedModel, HypothesisSet, ModelExtension};
use gyrocal_record::AXES;
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::{Causes, Cell, effect};
use crate::truth::interval_s;

/// Purposes of the streams of draws.
const CAUSES: u64 = 47;
const LEVELS: u64 = 48;

/// Ratio of the true standard deviation to the declared one, in half of the records.
const MISDECLARED: [f64; 2] = [0.5, 2.0];

/// Most draws of an effect that the record shows.
const DRAWS: usize = 100;

/// Number of drift coefficients.
const COEFFICIENTS: usize = 9;

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Caused {
    pub(super) effect: String,
    pub(super) detected: bool,
    /// Whether the set of a finding holds the cause; and no noise process.
    pub(super) in_set: bool,
    pub(super) alone: bool,
    pub(super) set_size: Option<usize>,
    pub(super) spurious: bool,
    /// The same of a search that knows that no rate walks.
    pub(super) oracle_in_set: bool,
    pub(super) oracle_set_size: Option<usize>,
    /// Whether the intervals of the coefficients hold the true ones: over the set, and of the first
    /// member.
    pub(super) over_set: Vec<bool>,
    pub(super) first: Vec<bool>,
    /// Width of the intervals over those of the true model.
    pub(super) widths: Vec<f64>,
}

fn is_slow(effect: &Effect) -> bool {
    effect.rate().is_some()
        && matches!(
            effect.kind,
            EffectKind::Ramp | EffectKind::Step | EffectKind::Exponential | EffectKind::Periodic
        )
}

/// Scenario without a cause, and its true noise.
pub(in crate::truth) fn plain(seed: u64) -> Result<(Scenario, NoiseModel), EvaluationError> {
    let mut random = Draw::new(seed, LEVELS);
    let mut plain = Scenario {
        interval_s: interval_s(seed),
        ..scenario(seed)
    };
    let mut noise = NoiseModel::default();
    if random.uniform() < 0.5 {
        for (axis, name) in AXES.into_iter().enumerate() {
            noise.gyro_ratio[axis] = random.log_uniform(MISDECLARED);
            noise.accel_ratio[axis] = random.log_uniform(MISDECLARED);
            for (id, ratio) in [
                (format!("gyro_{name}.noise"), noise.gyro_ratio[axis]),
                (format!("accel_{name}.noise"), noise.accel_ratio[axis]),
            ] {
                plain.hidden.push(Hidden::new(&id, &[("ratio", ratio)])?);
            }
        }
    }
    Ok((plain, noise))
}

/// A cause of the strength of the cell in the noise as it is.
fn draw(
    cell: &Cell,
    seed: u64,
    plain: &Scenario,
    noise: &NoiseModel,
) -> Result<InjectedEffect, EvaluationError> {
    let mut random = Draw::new(seed, CAUSES);
    let effects: Vec<_> = testable_effects(plain)
        .into_iter()
        .filter(|effect| match cell.of {
            Causes::All => true,
            Causes::Slow => is_slow(effect),
            Causes::Of(kind) => effect.kind == kind,
        })
        .collect();
    let clean = simulate(plain)?;
    let run = Run {
        record: &clean.record,
        bench: &clean.bench,
    };
    let fitted = FittedPlatform::nominal(&run, &Options::default(), noise)?;
    // Not every record logs what effects of a kind depend on.
    let draws = if effects.is_empty() { 0 } else { DRAWS };
    for _ in 0..draws {
        let effect = *random.one_of(&effects);
        let with_shape = [(effect, draw_shape(effect, plain, &mut random))];
        let injected = inject_into(
            &clean,
            &fitted,
            &with_shape,
            cell.strength,
            1.0,
            &mut random,
        )?;
        if let Some(only) = injected.and_then(|injected| injected.into_iter().next()) {
            return Ok(only);
        }
    }
    Err(EvaluationError::NotInjectable {
        tried: DRAWS,
        strength: cell.strength,
    })
}

/// Simulates and diagnoses the record of a seed.
pub(super) fn record(cell: &Cell, seed: u64) -> Result<Caused, EvaluationError> {
    let (plain, noise) = plain(seed)?;
    let injected = draw(cell, seed, &plain, &noise)?;
    let mut hidden = plain.hidden.clone();
    hidden.push(injected.to_hidden()?);
    let simulation = simulate(&Scenario { hidden, ..plain })?;
    let (data, bench) = (&simulation.record, &simulation.bench);
    let found = diagnose(data, bench, &DiagnoseOptions::default())?;
    let id = injected.effect.id;
    let sets: Vec<(bool, usize)> = found
        .result
        .causes()
        .map(|finding| (holds(finding, id), 1 + finding.alternatives.len()))
        .collect();
    let in_set = sets.iter().any(|(holds, _)| *holds);
    let alone = found
        .result
        .causes()
        .any(|finding| holds(finding, id) && !has_noise(finding));
    let [over_set, first, widths] = coefficients(&found, &simulation, &injected)?;
    let oracle = sets_without_walks(&found, &simulation)?;
    let holds_it = |set: &Vec<&str>| set.iter().any(|effect| same_or_equivalent(effect, id));
    Ok(Caused {
        effect: id.to_owned(),
        detected: !sets.is_empty(),
        in_set,
        alone,
        set_size: sets.first().map(|(_, size)| *size),
        spurious: sets.len() > 1,
        oracle_in_set: oracle.iter().any(holds_it),
        oracle_set_size: oracle.first().map(Vec::len),
        over_set: over_set.iter().map(|held| *held > 0.5).collect(),
        first: first.iter().map(|held| *held > 0.5).collect(),
        widths,
    })
}

/// Whether a set holds a cause or an exact equivalent of it.
pub(in crate::truth) fn holds(finding: &Finding, id: &str) -> bool {
    let mut others = finding.alternatives.iter();
    same_or_equivalent(&finding.effect, id)
        || others.any(|other| same_or_equivalent(&other.effect, id))
}

/// Whether a noise process is in a set.
fn has_noise(finding: &Finding) -> bool {
    let all = finding
        .alternatives
        .iter()
        .map(|other| other.effect.as_str());
    let is_walk = |id: &str| effect(id).is_some_and(|one| one.kind == EffectKind::RandomWalk);
    all.chain([finding.effect.as_str()]).any(is_walk)
}

/// Whether the intervals over the set hold the true coefficients, whether those of the first member do,
/// and the widths of the former over those of the true model.
fn coefficients(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
    injected: &InjectedEffect,
) -> Result<[Vec<f64>; 3], EvaluationError> {
    let Some(stated) = &found.result.coefficients else {
        return Ok(Default::default());
    };
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &noise)?;
    let plant = &gyrocal_calibration::PLATFORM;
    let rows = rows(run.record, nominal.covariates());
    let set = HypothesisSet::new(plant, &rows, &[injected.effect]);
    let mut extension = ModelExtension::default();
    set.add_to_model(plant, &rows, &mut extension, 0, injected.shape);
    let true_model = nominal.refitted(&extension)?;
    let truth = true_coefficients(simulation);
    let mut answers: [Vec<f64>; 3] = Default::default();
    for (index, value) in truth.iter().enumerate().take(COEFFICIENTS) {
        let [interval, first] = intervals(stated, index);
        let held =
            |interval: [f64; 2]| f64::from(u8::from((interval[0]..=interval[1]).contains(value)));
        answers[0].push(held(interval));
        answers[1].push(held(first));
        let sigma = true_model.covariance()[(index, index)].sqrt();
        answers[2].push((interval[1] - interval[0]) / (2.0 * NORMAL_97_5 * sigma));
    }
    Ok(answers)
}

/// The nine coefficients, gyro by gyro.
fn true_coefficients(simulation: &Simulation) -> Vec<f64> {
    let truth = simulation.truth.coefficients;
    (0..3)
        .flat_map(|gyro| {
            [
                truth.bias_deg_per_h[gyro],
                truth.g_deg_per_h_per_g[gyro],
                truth.gg_deg_per_h_per_g2[gyro],
            ]
        })
        .collect()
}

/// The 95 % intervals of a coefficient: over the sets, and with what is named first.
fn intervals(stated: &Coefficients, index: usize) -> [[f64; 2]; 2] {
    let best = stated.extended.as_ref().unwrap_or(&stated.nominal);
    let own = NORMAL_97_5 * best[index].sigma;
    let first = [best[index].estimate - own, best[index].estimate + own];
    let over_set = stated.over_set.as_ref();
    [over_set.map_or(first, |all| all[index].interval), first]
}

/// Whether the interval of each coefficient over the sets holds it.
pub(in crate::truth) fn covered(found: &DiagnosisResult, simulation: &Simulation) -> Vec<bool> {
    let Some(stated) = &found.coefficients else {
        return Vec::new();
    };
    let truth = true_coefficients(simulation).into_iter().enumerate();
    truth
        .map(|(index, value)| {
            let [[low, high], _] = intervals(stated, index);
            (low..=high).contains(&value)
        })
        .collect()
}

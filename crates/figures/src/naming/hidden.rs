//! One record with a cause in it, diagnosed.

use core::f64::consts::TAU;

use gyrocal::{EFFECTS, EffectRow};
use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_diagnosis::cause::information;
use gyrocal_diagnosis::{DiagnoseOptions, Verdict, diagnose};
use gyrocal_truth::{Hidden, Population, Scenario, simulate};
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

use super::Error;

/// Population that the records are drawn from.
const POPULATION: u64 = 77;

/// What became of a hidden cause.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Case {
    /// Which it was.
    pub(super) effect: String,
    /// Whether any physical cause was found.
    pub(super) detected: bool,
    /// Whether the first name is right, or exactly equivalent.
    pub(super) first: bool,
    /// Whether a named set holds it.
    pub(super) in_set: bool,
    /// Effects in the first set, equivalents not counted.
    pub(super) set_size: usize,
    /// Whether the 95 % intervals of all its sizes hold the true ones, given the right name.
    pub(super) covered: Option<bool>,
}

/// Three days at any latitude and attitude, with drift.
pub(crate) fn scenario(seed: u64) -> Scenario {
    Scenario {
        duration_s: 3.0 * 86_400.0,
        ..Population::new(POPULATION).scenario(seed)
    }
}

/// Whether a clean record shows anything.
pub(super) fn clean(seed: u64) -> Result<bool, Error> {
    let simulation = simulate(&scenario(seed))?;
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    )?;
    Ok(found.verdict != Verdict::Clean)
}

/// A record with a cause in it.
pub(crate) struct Drawn {
    /// With the cause.
    pub(crate) scenario: Scenario,
    pub(crate) effect: &'static EffectRow,
    /// Its true sizes.
    pub(crate) sizes: DVector<f64>,
}

/// Hides a random effect of the default search, `strength` standard deviations of its own bound
/// large.
pub(crate) fn drawn(seed: u64, strength: f64) -> Result<Drawn, Error> {
    let scenario = scenario(seed);
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
    let effects: Vec<&EffectRow> = EFFECTS
        .iter()
        .filter(|effect| {
            effect.default_search
                && effect.needs.is_empty()
                && matches!(effect.kind, "term" | "state")
        })
        .collect();
    loop {
        let effect = effects[(draw.uniform() * effects.len() as f64) as usize];
        let shape = shape(effect, scenario.duration_s, &mut draw);
        // A record may say nothing of an effect: another one then.
        if let Some(sizes) = sizes(&scenario, effect, shape, strength, &mut draw)? {
            let mut parameters: Vec<(&str, f64)> = names(effect)
                .into_iter()
                .zip(sizes.iter().copied())
                .collect();
            parameters
                .extend(shape.map(|shape| (effect.parameters[effect.parameters.len() - 1], shape)));
            return Ok(Drawn {
                scenario: Scenario {
                    hidden: vec![Hidden::new(effect.id, &parameters)?],
                    ..scenario
                },
                effect,
                sizes,
            });
        }
    }
}

/// Diagnoses the record of [`drawn`].
pub(super) fn hidden(seed: u64, strength: f64) -> Result<Case, Error> {
    let Drawn {
        scenario,
        effect,
        sizes,
    } = drawn(seed, strength)?;
    let simulation = simulate(&scenario)?;
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    )?;
    let is_it = |id: &str| id == effect.id || effect.equivalents.contains(&id);
    let first = found.findings.first();
    let named = found
        .findings
        .iter()
        .find(|finding| finding.effect == effect.id);
    Ok(Case {
        effect: effect.id.to_owned(),
        detected: first.is_some(),
        first: first.is_some_and(|finding| is_it(finding.effect)),
        in_set: found.findings.iter().any(|finding| {
            is_it(finding.effect) || finding.rivals.iter().any(|rival| is_it(rival.effect))
        }),
        set_size: first.map_or(0, |finding| 1 + finding.rivals.len()),
        covered: named.map(|finding| {
            finding
                .parameters
                .iter()
                .zip(sizes.iter())
                .all(|(found, truth)| {
                    // Of several parameters each at its share of 5 %.
                    let bound = if sizes.len() == 1 { 1.96 } else { 2.4 };
                    found
                        .sigma
                        .is_none_or(|sigma| (found.estimate - truth).abs() < bound * sigma)
                })
        }),
    })
}

/// Onset in s or time constant in h, where an effect has one.
fn shape(effect: &EffectRow, duration_s: f64, draw: &mut Draw) -> Option<f64> {
    match effect.parameters.last() {
        Some(&"onset_s") => Some((0.1 + 0.8 * draw.uniform()) * duration_s),
        Some(&"time_constant_h") => Some(0.5 * 30.0_f64.powf(draw.uniform())),
        _ => None,
    }
}

/// Names that the simulator gives to the sizes.
fn names(effect: &EffectRow) -> Vec<&'static str> {
    if effect.kind == "state" {
        return vec!["x_deg", "y_deg", "z_deg"];
    }
    effect.parameters.to_vec()
}

/// Sizes in a random direction, `strength` standard deviations of the bound long.
fn sizes(
    scenario: &Scenario,
    effect: &EffectRow,
    shape: Option<f64>,
    strength: f64,
    draw: &mut Draw,
) -> Result<Option<DVector<f64>>, Error> {
    let clean = simulate(scenario)?;
    let run = Run {
        record: &clean.record,
        bench: &clean.bench,
    };
    let fitted = Extended::nominal(&run, &Options::default(), &NoiseModel::default())?;
    let Some(information) = information(&fitted, &clean.record, effect.id, shape)? else {
        return Ok(None);
    };
    let direction = DVector::from_fn(information.nrows(), |i, _| {
        draw.normal() / information[(i, i)].sqrt()
    });
    let length = (&information * &direction).dot(&direction).sqrt();
    Ok(Some(direction * (strength / length)))
}

struct Draw(ChaCha8Rng);

impl Draw {
    fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (radius, angle) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * radius.ln()).sqrt() * (TAU * angle).cos()
    }
}

//! Warm-ups and steps of 5 to 500 σ in noise that is misdeclared in half of the records: spurious causes, and
//! intervals of onsets and time constants.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_diagnosis::{DiagnoseOptions, fit_effects};
use gyrocal_evaluation::{diagnosed, effect_of, inject_one_of, run_of};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, noisy};
use super::judged::{self, within};
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the records.
const SOURCES: Sources = of(DIAGNOSIS, &[file!(), drawn::FILE, judged::FILE]);

/// Sizes, in standard deviations of the effect's own bound.
const STRENGTHS: [f64; 2] = [5.0, 500.0];

/// Purpose of the stream of draws.
const PURPOSE: u64 = 41;

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Shaped {
    effect: String,
    /// Number of causes that are named.
    causes: usize,
    /// Whether the interval holds the true shape, of a fit with the effect where it is not named; `None` if
    /// the record does not determine it.
    covered: Option<bool>,
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let population = Population::new("shapes", [705_000, 2000, 24], SOURCES, record);
    let spurious = "warm-ups and steps of 5 to 500 σ: share of records with a spurious extra cause";
    let has_more = |one: &Shaped| Some(one.causes > 1);
    let level = "the level of 1 %, and one more for what the shape of a large effect leaves";
    let mut rows = vec![Row::share(spurious, has_more).at_most(0.02, level)];
    for (what, kind) in [
        ("onset", EffectKind::Step),
        ("time constant", EffectKind::Exponential),
    ] {
        let name = format!(
            "the same, fitted with the effect, named or not: coverage of the 95 % interval of the {what}"
        );
        let covered = move |one: &Shaped| {
            let is_own = effect_of(&one.effect).is_some_and(|effect| effect.kind == kind);
            one.covered.filter(|_| is_own)
        };
        rows.push(Row::share(name, covered).of_coverage());
    }
    context.measure(&population, &rows)
}

fn record(seed: u64) -> Result<Shaped, Error> {
    let mut random = Draw::new(seed, PURPOSE);
    let (plain, noise) = noisy(seed)?;
    let strength = random.log_uniform(STRENGTHS);
    let shaped = EFFECTS
        .iter()
        .filter(|effect| matches!(effect.kind, EffectKind::Step | EffectKind::Exponential));
    let shaped: Vec<_> = shaped.collect();
    let (scenario, cause) = inject_one_of(&shaped, plain, &noise, strength, &mut random)?;
    let simulation = simulate(&scenario)?;
    let found = diagnosed(&simulation)?.result;
    let effect = cause.effect;
    let shape = cause.shape.unwrap_or(f64::NAN);
    let name = effect.shape().map_or("", |shape| shape.name);
    let named = found.causes().find(|finding| finding.effect == effect.id);
    let named = named.and_then(|finding| finding.parameter(name));
    let interval = match named {
        Some(own) => own.interval.clone(),
        None => fitted_interval(&simulation, effect.id, name),
    };
    Ok(Shaped {
        effect: effect.id.to_owned(),
        causes: found.causes().count(),
        covered: interval.map(|pieces| within(&pieces, shape)),
    })
}

/// Interval of the shape of an effect that is fitted without being named.
fn fitted_interval(simulation: &Simulation, effect: &str, name: &str) -> Option<Vec<[f64; 2]>> {
    let effects = [effect.to_owned()];
    let options = DiagnoseOptions::default();
    let fitted = fit_effects(&run_of(simulation), None, &effects, &options).ok()?;
    let mut parameters = fitted.effects.into_iter().next()?.parameters.into_iter();
    parameters.find(|own| own.name == name)?.interval
}

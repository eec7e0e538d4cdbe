//! Warm-ups and steps of 5 to 500 σ in noise that is misdeclared in half of the records: spurious causes, and
//! intervals of onsets and time constants.

use gyrocal::effect::EffectKind;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose, fit_effects};
use gyrocal_evaluation::{EvaluationError, InjectedEffect, draw_shape, inject_into};
use gyrocal_statistics::Proportion;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::Extent;
use super::causes::plain;
use super::coverage::of_intervals;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// Seeds of the records, and their number in the small version.
const SEEDS: [u64; 2] = [705_000, 2000];
const SMALL: u64 = 24;

/// Sizes, in standard deviations of the effect's own bound.
const STRENGTHS: [f64; 2] = [5.0, 500.0];

/// Purpose of the stream of draws.
const PURPOSE: u64 = 41;

/// Most draws of an effect that the record shows.
const DRAWS: usize = 50;

/// Largest share of records with a spurious cause.
const SPURIOUS: f64 = 0.02;

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Shaped {
    effect: String,
    strength: f64,
    /// Ids of all causes.
    causes: Vec<String>,
    /// Whether the interval holds the true shape, of a fit with the effect where it is not named; `None` if
    /// the record does not determine it.
    covered: Option<bool>,
    /// True shape.
    shape: f64,
    /// Its estimate, where the effect is named.
    estimate: Option<f64>,
}

pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let count = extent.records(SEEDS[1], SMALL);
    let seeds = SEEDS[0]..SEEDS[0] + count;
    let outcome =
        resumable::campaign("truth", "shapes", seeds.clone(), small)?.run(record, |_| ())?;
    let records: Vec<&Shaped> = outcome.successes().map(|(_, record)| record).collect();
    let seeds = format!("{seeds:?}");
    let spurious = Proportion::of(records.iter().map(|record| record.causes.len() > 1));
    let mut first = Figure::within(
        "warm-ups and steps of 5 to 500 σ: share of records with a spurious extra cause",
        [0.0, SPURIOUS],
        spurious.share(),
    )
    .of_share(spurious);
    if small {
        first = first.judged(spurious.at_most(SPURIOUS));
    }
    let mut figures = vec![first.over(records.len(), seeds.as_str())];
    for (name, kind) in [
        ("onset", EffectKind::Step),
        ("time constant", EffectKind::Exponential),
    ] {
        let own: Vec<bool> = records
            .iter()
            .filter(|record| kind_of(&record.effect) == Some(kind))
            .filter_map(|record| record.covered)
            .collect();
        let name = format!(
            "the same, fitted with the effect, named or not: coverage of the 95 % interval of the {name}"
        );
        figures.push(of_intervals(&name, &own, &seeds, small));
    }
    for failure in outcome.failures() {
        eprintln!(
            "record {} is not diagnosed: {}",
            failure.seed, failure.message
        );
    }
    let failed = outcome.failures().count();
    figures.push(Figure::truth(
        "the same: every record is diagnosed",
        failed == 0,
    ));
    Ok(figures)
}

fn kind_of(id: &str) -> Option<EffectKind> {
    let effect = EFFECTS.iter().find(|effect| effect.id == id)?;
    Some(effect.kind)
}

fn record(seed: u64) -> Result<Shaped, EvaluationError> {
    let mut random = Draw::new(seed, PURPOSE);
    let (plain, noise) = plain(seed)?;
    let strength = random.log_uniform(STRENGTHS);
    let (effect, shape, injected) = draw(&plain, &noise, strength, &mut random)?;
    let mut hidden = plain.hidden.clone();
    hidden.push(injected.to_hidden()?);
    let simulation = simulate(&Scenario { hidden, ..plain })?;
    let (data, bench) = (&simulation.record, &simulation.bench);
    let found = diagnose(data, bench, &DiagnoseOptions::default())?.result;
    let truth = shape.unwrap_or(f64::NAN);
    let name = effect.shape().map_or("", |shape| shape.name);
    let named = found.causes().find(|finding| finding.effect == effect.id);
    let named = named.and_then(|finding| finding.parameter(name));
    let interval = match named {
        Some(own) => own.interval.clone(),
        None => fitted_interval(&simulation, effect.id, name),
    };
    let holds = |pieces: Vec<[f64; 2]>| {
        let mut pieces = pieces.iter();
        pieces.any(|[low, high]| (*low..=*high).contains(&truth))
    };
    Ok(Shaped {
        effect: effect.id.to_owned(),
        strength,
        causes: found.causes().map(|cause| cause.effect.clone()).collect(),
        covered: interval.map(holds),
        shape: truth,
        estimate: named.map(|own| own.estimate),
    })
}

/// A step or a warm-up of this strength in the noise as it is.
fn draw(
    plain: &Scenario,
    noise: &NoiseModel,
    strength: f64,
    random: &mut Draw,
) -> Result<(&'static Effect, Option<f64>, InjectedEffect), EvaluationError> {
    let shaped: Vec<_> = EFFECTS
        .iter()
        .filter(|effect| matches!(effect.kind, EffectKind::Step | EffectKind::Exponential))
        .collect();
    let clean = simulate(plain)?;
    let run = Run {
        record: &clean.record,
        bench: &clean.bench,
    };
    let fitted = FittedPlatform::nominal(&run, &Options::default(), noise)?;
    // A record whose platform stands nearly still shows no drift of one gyro.
    for _ in 0..DRAWS {
        let effect = *random.one_of(&shaped);
        let shape = draw_shape(effect, plain, random);
        let injected = inject_into(&clean, &fitted, &[(effect, shape)], strength, 1.0, random)?;
        if let Some(only) = injected.and_then(|injected| injected.into_iter().next()) {
            return Ok((effect, shape, only));
        }
    }
    Err(EvaluationError::NotInjectable {
        tried: DRAWS,
        strength,
    })
}

/// Interval of the shape of an effect that is fitted without being named.
fn fitted_interval(simulation: &Simulation, effect: &str, name: &str) -> Option<Vec<[f64; 2]>> {
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let effects = [effect.to_owned()];
    let fitted = fit_effects(&run, None, &effects, &DiagnoseOptions::default()).ok()?;
    let mut parameters = fitted.effects.into_iter().next()?.parameters.into_iter();
    parameters.find(|own| own.name == name)?.interval
}

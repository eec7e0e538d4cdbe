//! Diagnosis of any plant: five simulated plants with hidden effects.

mod effort;
mod gauges;
mod interpreted;
mod oracle;
mod second;

use gyrocal_evaluation::Progress;
use gyrocal_plant::answer::Found;
use gyrocal_plant::{FittedPlant, LoadedPlant, PlantError, PlantRecord, SearchOptions, diagnose};
use gyrocal_statistics::Proportion;
use gyrocal_truth::plant::{Kind, Run, Setting, Stream, simulate, strength, with_strength};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable::campaign;
use crate::truth::Extent;

/// Seeds of clean records, of those with a hidden effect, and of starts; no constant was tuned on them.
const CLEAN: u64 = 610_000;
const HIDDEN: u64 = 620_000;
const STARTS: u64 = 300_000;

/// Rows of a record.
const ROWS: usize = 600;

/// Strengths of hidden effects, standard deviations.
const STRENGTHS: [f64; 2] = [5.0, 50.0];

/// Strength from which on an effect must be detected, and from which on it must predict.
const DETECTABLE: f64 = 8.0;
const PREDICTIVE: f64 = 12.0;

/// Rows of the record that the time is measured on.
const LONG: usize = 4096;

/// Costs within this of the least are those of the best fit.
const SAME_FIT: f64 = 1.0;

/// A record with a hidden effect, diagnosed; one that cannot be diagnosed is one of any strength that is missed.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Outcome {
    /// `None` of a record that cannot be diagnosed.
    strength: Option<f64>,
    detected: bool,
    holds: bool,
    first: bool,
    set: usize,
    /// Effects without an onset in the set, and in that of an oracle, of a hidden effect without one.
    beside_oracle: Option<[f64; 2]>,
    /// Whether the simulation of a second record is better with what was found, of a record whose effect
    /// was named and whose true model gains there.
    better: Option<bool>,
}

/// All figures of the topic.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let plants: Vec<(Kind, LoadedPlant)> = Kind::ALL
        .into_iter()
        .map(|kind| Ok((kind, loaded(kind)?)))
        .collect::<Result<_, PlantError>>()?;
    let mut figures = clean(&plants, extent)?;
    figures.extend(hidden(&plants, extent)?);
    figures.extend(gauges::figures()?);
    figures.push(starts(&plants, extent.records(100, 2))?);
    figures.push(effort::lines()?);
    figures.push(effort::duration()?.timed(extent.small));
    figures.extend(interpreted::figures(&plants[0].1, extent.records(20, 2))?);
    Ok(figures)
}

pub(crate) fn loaded(kind: Kind) -> Result<LoadedPlant, PlantError> {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let file = format!("{examples}/{}/plant.json", kind.facts().name);
    LoadedPlant::read(std::path::Path::new(&file))
}

fn record(plant: &LoadedPlant, setting: &Setting) -> Result<PlantRecord, PlantError> {
    prepared(plant, simulate(setting, None))
}

pub(crate) fn prepared(plant: &LoadedPlant, run: Run) -> Result<PlantRecord, PlantError> {
    let record = PlantRecord {
        time_s: run.time_s,
        inputs: run.inputs.concat(),
        outputs: run.outputs.concat(),
        ..PlantRecord::default()
    };
    record.prepared(plant.description(), "simulated")
}

/// False alarms on clean records; the noise of every second one is misdeclared. A record that cannot be
/// fitted counts as an alarm.
fn clean(plants: &[(Kind, LoadedPlant)], extent: Extent) -> Result<Vec<Figure>, Error> {
    let records = extent.records(400, 2);
    let mut figures = Vec::new();
    let mut all = Proportion { hits: 0, trials: 0 };
    let seeds = format!("{CLEAN} to {}", CLEAN + records - 1);
    for (kind, plant) in plants {
        let cell = format!("clean {kind:?}");
        let range = CLEAN..CLEAN + records;
        let outcome = campaign("any-plant", &cell, range, extent.small)?
            .run(|seed| is_silent(*kind, plant, seed), told(&cell))?;
        let silent = outcome.successes().map(|(_, silent)| !*silent);
        let alarms = silent.chain(outcome.failures().map(|_| true));
        let own = Proportion::of(alarms);
        all.hits += own.hits;
        all.trials += own.trials;
        let name = format!("any plant: false alarms, {kind:?}");
        figures.push(Figure::note_share(&name, own, seeds.clone()));
    }
    let name = "any plant: false alarms of all five, noise of half misdeclared by 0.5 to 2";
    let pooled = Figure::note_share(name, all, seeds);
    let pooled = Figure {
        target: "<= 0.02 at the upper 95 % bound".to_owned(),
        ..pooled
    };
    figures.insert(0, pooled.judged(all.at_most(0.02)));
    Ok(figures)
}

/// Tells how far a cell is.
fn told(cell: &str) -> impl FnMut(Progress) + Send {
    move |progress| {
        if progress.done % 50 == 0 {
            eprintln!("{cell}: {} of {}", progress.done, progress.total);
        }
    }
}

/// Whether nothing is found in a clean record.
fn is_silent(kind: Kind, plant: &LoadedPlant, seed: u64) -> Result<bool, PlantError> {
    let mut setting = Setting::random(kind, seed, ROWS);
    if seed % 2 == 1 {
        setting.noise = Stream::new(seed, 9).log_between(0.5, 2.0);
    }
    let record = record(plant, &setting)?;
    let answer = diagnose(plant, record, None, &SearchOptions::default())?.answer;
    Ok(answer.findings.is_empty() && answer.unexplained.is_empty())
}

fn one_hidden(kind: Kind, plant: &LoadedPlant, seed: u64) -> Result<Outcome, PlantError> {
    let mut setting = Setting::random(kind, seed, ROWS);
    let effects = kind.facts().effects;
    setting.hidden = effects[seed as usize % effects.len()];
    let wanted = Stream::new(seed, 9).log_between(STRENGTHS[0], STRENGTHS[1]);
    let setting = with_strength(&setting, wanted);
    // What began in the first record is there from the start of the second.
    let later = Setting {
        seed: seed + 10_000_000,
        onset: -1.0,
        initial: Setting::random(kind, seed + 10_000_000, ROWS).initial,
        ..setting.clone()
    };
    let second = second::Second::new(plant, &later)?;
    let first = record(plant, &setting)?;
    let diagnosed = diagnose(
        plant,
        first,
        Some(second.record.clone()),
        &SearchOptions::default(),
    )?;
    let (answer, nominal) = (diagnosed.answer, diagnosed.searched.nominal);
    let own = setting.hidden.0;
    let strength = strength(&setting);
    let beside_oracle = answer.findings.first().and_then(|found| {
        let ids = found.rivals.iter().map(|(id, _)| id.as_str());
        let ids = ids.chain([found.effect.as_str()]);
        let set = ids
            .filter(|id| !oracle::has_onset(plant.tables(), id))
            .count();
        let oracle = oracle::set_size(&nominal, own, strength)?;
        Some([set as f64, oracle])
    });
    let is_in = |found: &Found| {
        let rivals = found.rivals.iter().map(|(id, _)| id.as_str());
        let mut set = rivals.chain(found.equivalents.iter().map(String::as_str));
        found.effect == own || set.any(|id| id == own)
    };
    let named = answer.findings.iter().any(|found| found.effect == own);
    let better = answer.later_record.as_ref();
    let better = better.filter(|later| named && second.true_gain(later) >= second::LEAST_GAIN);
    let better = better.map(second::is_better);
    Ok(Outcome {
        strength: Some(strength),
        beside_oracle,
        detected: !(answer.findings.is_empty() && answer.unexplained.is_empty()),
        holds: answer.findings.iter().any(is_in),
        first: answer
            .findings
            .first()
            .is_some_and(|found| found.effect == own),
        set: answer
            .findings
            .first()
            .map_or(0, |found| 1 + found.rivals.len()),
        better,
    })
}

/// Records with one hidden effect.
fn hidden(plants: &[(Kind, LoadedPlant)], extent: Extent) -> Result<Vec<Figure>, Error> {
    let records = extent.records(200, 3);
    let seeds = format!("{HIDDEN} to {}", HIDDEN + records - 1);
    let mut outcomes: Vec<(Kind, Outcome)> = Vec::new();
    for (kind, plant) in plants {
        let cell = format!("hidden {kind:?}");
        let range = HIDDEN..HIDDEN + records;
        let found = campaign("any-plant", &cell, range, extent.small)?
            .run(|seed| one_hidden(*kind, plant, seed), told(&cell))?;
        let found_each = found.successes().map(|(_, one)| one.clone());
        let missed = found.failures().map(|_| Outcome::default());
        outcomes.extend(found_each.chain(missed).map(|one| (*kind, one)));
    }
    Ok(of_hidden(&outcomes, &seeds))
}

fn of_hidden(outcomes: &[(Kind, Outcome)], seeds: &str) -> Vec<Figure> {
    let from = |least: f64| {
        let all = outcomes.iter();
        all.filter(move |(_, one)| one.strength.is_none_or(|own| own >= least))
    };
    let strong = || from(DETECTABLE).map(|(_, one)| one);
    let at_least = |name: &str, share: Proportion, least: f64| {
        let figure = Figure::note_share(name, share, seeds);
        let figure = Figure {
            target: format!(">= {least}"),
            ..figure
        };
        figure.judged(share.at_least(least))
    };
    let detected = Proportion::of(strong().map(|one| one.detected));
    let holds = Proportion::of(strong().map(|one| one.holds));
    let first = Proportion::of(strong().map(|one| one.first));
    let better = Proportion::of(from(PREDICTIVE).filter_map(|(_, one)| one.better));
    let mut figures = vec![
        at_least("any plant: effect of d >= 8 detected", detected, 0.99),
        at_least("any plant: set holds the effect of d >= 8", holds, 0.95),
        Figure::note_share(
            "any plant: first name of d >= 8 is the effect",
            first,
            seeds,
        ),
        at_least(&second::name(ROWS), better, 0.95),
    ];
    figures.push(set_sizes(strong(), seeds));
    for kind in Kind::ALL {
        let of_kind = from(DETECTABLE).filter(|(other, _)| *other == kind);
        let own: Vec<&Outcome> = of_kind.map(|(_, one)| one).collect();
        let holds = Proportion::of(own.iter().map(|one| one.holds));
        let size = own.iter().map(|one| one.set as f64).sum::<f64>() / holds.trials.max(1) as f64;
        let name = format!("any plant: set holds the effect, {kind:?}");
        figures.push(Figure::note_share(&name, holds, seeds));
        let name = format!("any plant: mean size of the set, {kind:?}");
        let note = Figure::note(&name, format!("{size:.2}"));
        figures.push(note.over(holds.trials as usize, seeds));
    }
    figures
}

/// Mean size of the set over that of an oracle's.
fn set_sizes<'a>(strong: impl Iterator<Item = &'a Outcome>, seeds: &str) -> Figure {
    let pairs: Vec<[f64; 2]> = strong.filter_map(|one| one.beside_oracle).collect();
    let sum = |index: usize| pairs.iter().map(|pair| pair[index]).sum::<f64>();
    let (ours, oracle) = (sum(0), sum(1));
    let name = "any plant: mean size of the set of d >= 8 over an oracle's, effects without onset";
    let count = pairs.len().max(1) as f64;
    let figure = Figure::within(name, [0.0, 1.1], ours / oracle);
    Figure {
        target: "<= 1.1".to_owned(),
        measured: format!(
            "{:.3}: {:.2} over {:.2}",
            ours / oracle,
            ours / count,
            oracle / count
        ),
        ..figure
    }
    .over(pairs.len(), seeds)
}

/// Fits of oscillator and tanks from random parameters within a factor of three.
fn starts(plants: &[(Kind, LoadedPlant)], records: u64) -> Result<Figure, Error> {
    let mut reached = Vec::new();
    for (kind, plant) in plants {
        if !matches!(kind, Kind::Duffing | Kind::Tanks) {
            continue;
        }
        let setting = Setting::random(*kind, STARTS, ROWS);
        let record = record(plant, &setting)?;
        let best = FittedPlant::nominal(plant, record.clone(), &[])?;
        let held = best.to_hold()?.0;
        let cost = |first: Option<&[f64]>| {
            FittedPlant::nominal_from(plant, record.clone(), &held, first)
                .map_or(f64::INFINITY, |fit| fit.deviance())
        };
        let all: Vec<f64> = (0..records)
            .into_par_iter()
            .map(|index| {
                let mut random = Stream::new(STARTS + index, 3);
                let states = plant.description().states.len();
                let mut first = vec![0.0; states];
                let parameters = plant.description().parameters.iter();
                first.extend(
                    parameters.map(|own| own.value * (random.log_between(1.0 / 3.0, 3.0) - 1.0)),
                );
                cost(Some(&first))
            })
            .collect();
        let least = all.iter().copied().fold(cost(None), f64::min);
        reached.extend(all.into_iter().map(|cost| cost - least < SAME_FIT));
    }
    let share = Proportion::of(reached);
    let name =
        "any plant: starts within a factor of 3 that reach the best fit, oscillator and tanks";
    let figure = Figure {
        target: ">= 0.98".to_owned(),
        ..Figure::note_share(name, share, format!("{STARTS}"))
    };
    Ok(figure.judged(share.at_least(0.98)))
}

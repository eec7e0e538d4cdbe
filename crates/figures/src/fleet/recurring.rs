//! Causes that recur below what a unit shows: power over an oracle's, and false discoveries.
//!
//! The scores of 200 units are drawn from the joint normal distribution of those of simulated records, which
//! were diagnosed: signatures overlap as they do in records. The oracle knows effect, strength and share,
//! and tests the likelihood ratio of the one cause at the level q/m that the search demands of a single
//! discovery among m effects.

use core::ops::Range;

use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_fleet::recurrence::{
    Injected, RecurrenceOptions, ScoreSimulator, UnitRecords, oracle_finds, recurring,
};
use gyrocal_hypothesis::ScoreTable;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Judgement, Proportion};
use gyrocal_truth::{Population, Scenario, simulate};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

const UNITS: usize = 200;
const STRENGTHS: [f64; 3] = [1.0, 2.0, 3.0];
const SHARES: [f64; 3] = [0.05, 0.1, 0.2];

/// First seed; constants and rules were chosen on seeds below it.
const FIRST_SEED: u64 = 40_000;

/// Draws of an oracle's p-value.
const DRAWS: usize = 400;

/// The scenario of a clean record of two to three days, every ten minutes.
pub(super) fn scenario(number: u64) -> Scenario {
    let mut population = Population::new(FIRST_SEED);
    population.duration_days = [2.0, 3.0];
    population.common.interval_s = 600.0;
    population.scenario(number)
}

/// Scores of clean records.
fn simulators(records: u64) -> Result<Vec<ScoreSimulator>, Error> {
    let all = (0..records).into_par_iter().map(|number| {
        let simulated = simulate(&scenario(number))?;
        let options = DiagnoseOptions::default();
        let scores = diagnose(&simulated.record, &simulated.bench, &options)?.scores;
        Ok(ScoreSimulator::new(scores))
    });
    let all: Vec<Option<ScoreSimulator>> = all.collect::<Result<_, Error>>()?;
    Ok(all.into_iter().flatten().collect())
}

/// Effects that all of the records show.
fn effects(simulators: &[ScoreSimulator]) -> Vec<String> {
    let ids = |one: &ScoreSimulator| -> Vec<String> {
        let effects = one.table().effects.iter();
        effects.map(|effect| effect.id.clone()).collect()
    };
    let Some((first, others)) = simulators.split_first() else {
        return Vec::new();
    };
    let mut all = ids(first);
    for other in others {
        let own = ids(other);
        all.retain(|id| own.contains(id));
    }
    all
}

/// What became of a fleet.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Outcome {
    found: bool,
    oracle: bool,
    discoveries: usize,
    wrong: usize,
}

fn fleet(
    simulators: &[ScoreSimulator],
    effects: &[String],
    cause: Option<(f64, f64)>,
    seed: u64,
) -> Result<Outcome, Error> {
    let mut draw = Draw::new(seed, 1);
    let effect = draw.one_of(effects).clone();
    let has = |unit: usize, share: f64| unit < (share * UNITS as f64).round() as usize;
    let tables = (0..UNITS).map(|unit| {
        let simulator = draw.one_of(simulators);
        let own = cause.filter(|(_, share)| has(unit, *share));
        let own = own.map(|(strength, _)| (effect.as_str(), strength));
        simulator
            .draw(own, &mut draw)
            .ok_or_else(|| Error::from("scores that no record has"))
    });
    let tables: Vec<ScoreTable> = tables.collect::<Result<_, _>>()?;
    let names: Vec<String> = (0..UNITS).map(|unit| format!("{unit}")).collect();
    let units: Vec<UnitRecords<'_>> = names
        .iter()
        .zip(&tables)
        .map(|(unit, table)| UnitRecords {
            unit,
            tables: vec![table],
        })
        .collect();
    let options = RecurrenceOptions {
        seed,
        ..RecurrenceOptions::default()
    };
    let found = recurring(&units, &options);
    let tested = tables
        .iter()
        .map(|table| table.effects.len())
        .max()
        .unwrap_or(1);
    let right = found.iter().filter(|one| {
        cause.is_some() && (one.effect == effect || one.alternatives.contains(&effect))
    });
    let right = right.count();
    let oracle = cause.is_some_and(|(strength, share)| {
        let cause = Injected {
            effect: &effect,
            strength,
            share,
        };
        let level = options.false_discovery_rate / tested as f64;
        oracle_finds(&units, cause, level, DRAWS, &mut draw)
    });
    Ok(Outcome {
        found: right > 0,
        oracle,
        discoveries: found.len(),
        wrong: found.len() - right,
    })
}

/// Fleets of each share and strength, and fleets without a cause.
const FLEETS: u64 = 30;
const CLEAN: u64 = 100;

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let simulators = simulators(if extent.small { 2 } else { 16 })?;
    let effects = effects(&simulators);
    let run = |cell: &str, share: Option<f64>, seeds: Range<u64>| -> Result<Vec<Outcome>, Error> {
        let campaign = resumable::campaign("fleet", cell, seeds, extent.small)?;
        let job = |seed: u64| {
            let strength = STRENGTHS[(seed % STRENGTHS.len() as u64) as usize];
            let cause = share.map(|share| (strength, share));
            fleet(&simulators, &effects, cause, seed)
        };
        let outcome = campaign.run(job, |_| ())?;
        Ok(outcome.successes().map(|(_, one)| *one).collect())
    };
    let mut figures = Vec::new();
    let mut all = Vec::new();
    for (row, share) in SHARES.into_iter().enumerate() {
        let first = FIRST_SEED + 1000 * row as u64;
        let last = first + STRENGTHS.len() as u64 * extent.records(FLEETS, 1);
        let own = run(&format!("share {share}"), Some(share), first..last)?;
        figures.push(power(
            &format!(
                "200 units, a cause of 1, 2 or 3 sigmas in {:.0} % of them",
                100.0 * share
            ),
            &own,
            format!("{first}..{last}"),
        ));
        all.extend(own);
    }
    figures.push(power("the same, all shares", &all, String::new()));
    figures.push(false_discoveries(
        "fleets with a cause: false discovery rate",
        &all,
        "those".to_owned(),
    ));
    let first = FIRST_SEED + 5000;
    let last = first + extent.records(CLEAN, 3);
    let none = run("without a cause", None, first..last)?;
    let seeds = format!("{first}..{last}");
    figures.push(Figure::note_share(
        "fleets without a cause that name one; their rate is set to 5 %",
        Proportion::of(none.iter().map(|one| one.discoveries > 0)),
        seeds.clone(),
    ));
    all.extend(none);
    figures.push(false_discoveries(
        "fleets with and without a cause: false discovery rate",
        &all,
        format!("those, and {seeds}"),
    ));
    Ok(figures)
}

/// Share of fleets in which the cause is found, over the oracle's.
fn power(name: &str, fleets: &[Outcome], seeds: String) -> Figure {
    let count = |is: fn(&Outcome) -> bool| fleets.iter().filter(|one| is(one)).count();
    let (found, oracle) = (count(|one| one.found), count(|one| one.oracle));
    let ratio = found as f64 / oracle as f64;
    let figure = Figure::within(
        &format!("{name}: power over the oracle's"),
        [0.8, f64::INFINITY],
        ratio,
    );
    Figure {
        measured: format!("{ratio:.2} ({found} over {oracle})"),
        // Of nothing that an oracle finds there is no share.
        holds: figure.holds.filter(|_| oracle >= LEAST),
        too_few: oracle < LEAST,
        ..figure
    }
    .over(fleets.len(), seeds)
}

/// Fewest fleets of an oracle that a power is compared with.
const LEAST: usize = 3;

/// Quantiles of the normal distribution at which a mean is shown to be below a limit and above it.
const SHOWN: [f64; 2] = [1.645, 3.090];

/// Mean share of false ones among the discoveries of a fleet, none of them where there are none; with its
/// standard error.
fn false_discoveries(name: &str, fleets: &[Outcome], seeds: String) -> Figure {
    let rate = |one: &Outcome| one.wrong as f64 / one.discoveries.max(1) as f64;
    let count = fleets.len() as f64;
    let mean = fleets.iter().map(rate).sum::<f64>() / count;
    let squares = fleets.iter().map(|one| (rate(one) - mean).powi(2));
    // As if one fleet more had a false one: no error of zero.
    let error = ((squares.sum::<f64>() + 1.0) / (count * count)).sqrt();
    let any = fleets.iter().filter(|one| one.wrong > 0).count();
    let judgement = Judgement::of(
        mean + SHOWN[0] * error <= RATE,
        mean - SHOWN[1] * error > RATE,
    );
    let figure = Figure::within(name, [0.0, RATE], mean);
    Figure {
        measured: format!("{mean:.3} +- {error:.3}, {any} fleets with a false one"),
        ..figure
    }
    .judged(judgement)
    .over(fleets.len(), seeds)
}

/// The false discovery rate that is promised.
const RATE: f64 = 0.05;

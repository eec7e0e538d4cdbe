//! Causes that recur below what a unit shows: power over an oracle's, and false discoveries.
//!
//! The scores of 200 units are drawn from the joint normal distribution of those of simulated records, which
//! were diagnosed: signatures overlap as they do in records. The oracle knows effect, strength and share,
//! and tests the likelihood ratio of the one cause at the level q/m that the search demands of a single
//! discovery among m effects.

use gyrocal_evaluation::diagnosed;
use gyrocal_fleet::recurrence::{
    Injected, RecurrenceOptions, ScoreSimulator, UnitRecords, oracle_finds, recurring,
};
use gyrocal_hypothesis::ScoreTable;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Population, Scenario, simulate};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::fleets;
use crate::harness::{Context, Error, Figure, Row};

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
        let scores = diagnosed(&simulate(&scenario(number))?)?.scores;
        Ok(ScoreSimulator::new(scores))
    });
    let all: Vec<Option<ScoreSimulator>> = all.collect::<Result<_, Error>>()?;
    Ok(all.into_iter().flatten().collect())
}

/// Effects that all of the records show.
fn effects(simulators: &[ScoreSimulator]) -> Vec<String> {
    let of = |one: &ScoreSimulator| one.table().effects.clone().into_iter().map(|one| one.id);
    let mut all: Vec<String> = simulators.iter().take(1).flat_map(of).collect();
    let has = |one: &ScoreSimulator, id: &String| of(one).any(|own| own == *id);
    all.retain(|id| simulators.iter().all(|one| has(one, id)));
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
        let drawn = simulator.draw(own, &mut draw);
        drawn.ok_or_else(|| Error::from("scores that no record has"))
    });
    let tables: Vec<ScoreTable> = tables.collect::<Result<_, _>>()?;
    let names: Vec<String> = (0..UNITS).map(|unit| unit.to_string()).collect();
    let units = names.iter().zip(&tables).map(|(unit, table)| {
        let tables = vec![table];
        UnitRecords { unit, tables }
    });
    let units: Vec<UnitRecords<'_>> = units.collect();
    let options = RecurrenceOptions {
        seed,
        ..RecurrenceOptions::default()
    };
    let found = recurring(&units, &options)?;
    let tested = tables.iter().map(|table| table.effects.len()).max();
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
        let level = options.false_discovery_rate / tested.unwrap_or(1) as f64;
        oracle_finds(&units, cause, level, DRAWS, &mut draw)
    });
    Ok(Outcome {
        found: right > 0,
        oracle,
        discoveries: found.len(),
        wrong: found.len() - right,
    })
}

/// The share of false ones among the discoveries.
fn wrong(one: &Outcome) -> f64 {
    one.wrong as f64 / one.discoveries.max(1) as f64
}

/// Fleets of one number: one with a cause in each share of its units, and one without.
type Fleets = ([Outcome; SHARES.len()], Outcome);

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let simulators = simulators(if context.is_small() { 2 } else { 16 })?;
    let effects = effects(&simulators);
    let population = fleets("with causes", [FIRST_SEED, 100, 3], |seed| {
        let of = |share: Option<f64>, seed: u64| {
            let strength = STRENGTHS[(seed % STRENGTHS.len() as u64) as usize];
            let cause = share.map(|share| (strength, share));
            fleet(&simulators, &effects, cause, seed)
        };
        let [few, some, many] = [0, 1, 2].map(|at| of(Some(SHARES[at]), seed + 1000 * at as u64));
        Ok(([few?, some?, many?], of(None, seed + 5000)?))
    });
    context.measure(&population, &rows())
}

fn rows() -> Vec<Row<'static, Fleets>> {
    let power = |name: &str, from: usize, to: usize| {
        let name = format!("{name}: power over the oracle's");
        let count = |of: &[Outcome], is: fn(&Outcome) -> bool| {
            of.iter().filter(|one| is(one)).count() as f64
        };
        Row::ratio(name, move |(with, _): &Fleets| {
            let of = &with[from..to];
            Some([count(of, |one| one.found), count(of, |one| one.oracle)])
        })
        .at_least(
            0.8,
            "the oracle knows effect, strength and share: four of its five are found without",
        )
    };
    let false_ones = |name: &str, without: usize| {
        Row::mean(name, move |(with, none): &Fleets| {
            let all = with.iter().chain([none]).take(SHARES.len() + without);
            Some(all.map(wrong).sum::<f64>() / (SHARES.len() + without) as f64)
        })
        .at_most(0.05, "the rate that is promised")
    };
    let each = SHARES.iter().enumerate().map(|(place, share)| {
        let percent = 100.0 * share;
        let name = format!("200 units, a cause of 1, 2 or 3 sigmas in {percent:.0} % of them");
        power(&name, place, place + 1)
    });
    let mut rows: Vec<Row<'_, Fleets>> = each.collect();
    let named = |(_, none): &Fleets| Some(none.discoveries > 0);
    let without = "fleets without a cause that name one; their rate is set to 5 %";
    rows.extend([
        power("the same, all shares", 0, SHARES.len()),
        false_ones("fleets with a cause: false discovery rate", 0),
        Row::share(without, named),
        false_ones("fleets with and without a cause: false discovery rate", 1),
    ]);
    rows
}

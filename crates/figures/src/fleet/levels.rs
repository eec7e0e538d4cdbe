//! Coefficients over the units of simulated fleets: coverage of the hierarchical intervals, batches and
//! sites.

use gyrocal_fleet::{
    Coefficient, FleetOptions, FleetRecord, FleetResult, GroupKind, RecordName, WithInterval,
    summarise,
};
use gyrocal_statistics::Proportion;
use gyrocal_statistics::deviates::Draw;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::{Figure, coverage};
use crate::resumable;
use crate::truth::Extent;

/// Band of the coverage of 95 % intervals.
const BAND: [f64; 2] = [0.93, 0.97];

/// Numbers of units of the fleets of the coverage.
const UNITS: [u64; 3] = [5, 20, 100];

/// True spread of the units.
const SPREAD: f64 = 1.0;

/// True standard deviation from record to record.
const REPEATABILITY: f64 = 0.3;

/// True mean change in a year, and its spread.
const AGEING: [f64; 2] = [0.2, 0.1];

/// Seconds of a year, of 365.25 days.
const YEAR_S: f64 = 31_557_600.0;

/// Units of a fleet with batches, batches, sites, and units of the batch that differs.
const FLEET: u64 = 400;
const BATCHES: u64 = 12;
const SITES: u64 = 4;
const ODD_BATCH: u64 = 30;

/// Such fleets, with a batch that differs and without.
const GROUPED: u64 = 12_000;

/// Coefficients of such a fleet.
const COEFFICIENTS: usize = 9;

/// First seed; constants were chosen on seeds below it.
const FIRST_SEED: u64 = 30_000;

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = coverages(extent.records(2000, 150))?;
    figures.push(course(extent.records(600, 60))?);
    figures.extend(groups(extent)?);
    Ok(figures)
}

fn record(name: RecordName, coefficients: Vec<Coefficient>) -> FleetRecord {
    FleetRecord {
        name,
        coefficients,
        causes: Vec::new(),
        scores: None,
    }
}

fn coefficient(index: usize, estimate: f64, sigma: f64) -> Coefficient {
    Coefficient {
        name: format!("coefficient {index}"),
        estimate,
        sigma,
        unit: "1".to_owned(),
    }
}

fn summarised(records: &[FleetRecord]) -> Result<FleetResult, Error> {
    Ok(summarise(records, &FleetOptions::default())?)
}

/// Whether an interval covers a value; an interval that is missing does not.
fn covers(found: Option<WithInterval>, truth: f64) -> bool {
    found.is_some_and(|found| (found.interval[0]..=found.interval[1]).contains(&truth))
}

/// One record a unit, whose sigmas are a tenth to seven tenths of the spread.
fn one_record_each(units: u64, seed: u64) -> Result<[bool; 2], Error> {
    let mut draw = Draw::new(seed, units);
    let records: Vec<FleetRecord> = (0..units)
        .map(|unit| {
            let sigma = SPREAD * draw.log_uniform([0.1, 0.7]);
            let estimate = SPREAD * draw.normal() + sigma * draw.normal();
            let name = RecordName {
                unit: format!("{unit}"),
                record: "1".to_owned(),
                ..RecordName::default()
            };
            record(name, vec![coefficient(0, estimate, sigma)])
        })
        .collect();
    let found = &summarised(&records)?.coefficients[0];
    Ok([covers(found.mean, 0.0), covers(found.spread, SPREAD)])
}

fn coverages(fleets: u64) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for units in UNITS {
        let seeds = FIRST_SEED..FIRST_SEED + fleets;
        let covered: Vec<[bool; 2]> = seeds
            .clone()
            .into_par_iter()
            .map(|seed| one_record_each(units, seed))
            .collect::<Result<_, _>>()?;
        for (index, what) in ["mean", "spread"].into_iter().enumerate() {
            let share = Proportion::of(covered.iter().map(|covered| covered[index]));
            let name =
                format!("{units} units: coverage of the 95 % interval of the fleet's {what}");
            figures.push(of_coverage(&name, share, &seeds));
        }
    }
    Ok(figures)
}

fn of_coverage(name: &str, share: Proportion, seeds: &std::ops::Range<u64>) -> Figure {
    Figure::within(name, BAND, share.share())
        .judged(coverage(share, BAND))
        .of_share(share)
        .over(
            share.trials as usize,
            format!("{}..{}", seeds.start, seeds.end),
        )
}

/// Thirty units with four records over three years: all five intervals.
fn course(fleets: u64) -> Result<Figure, Error> {
    let seeds = FIRST_SEED..FIRST_SEED + fleets;
    let covered: Vec<[bool; 5]> = seeds
        .clone()
        .into_par_iter()
        .map(|seed| {
            let mut draw = Draw::new(seed, 0);
            let mut records = Vec::new();
            for unit in 0..30 {
                let level = SPREAD * draw.normal();
                let slope = AGEING[0] + AGEING[1] * draw.normal();
                for index in 0..4 {
                    let years = f64::from(index) + 0.5 * draw.uniform() - 1.75;
                    let sigma = draw.log_uniform([0.05, 0.2]);
                    let error = REPEATABILITY * draw.normal() + sigma * draw.normal();
                    let name = RecordName {
                        unit: format!("{unit}"),
                        record: format!("{index}"),
                        date_s: Some(years * YEAR_S),
                        ..RecordName::default()
                    };
                    let estimate = level + slope * years + error;
                    records.push(record(name, vec![coefficient(0, estimate, sigma)]));
                }
            }
            let found = &summarised(&records)?.coefficients[0];
            Ok([
                covers(found.mean, 0.0),
                covers(found.spread, SPREAD),
                covers(found.repeatability, REPEATABILITY),
                covers(found.ageing, AGEING[0]),
                covers(found.ageing_spread, AGEING[1]),
            ])
        })
        .collect::<Result<_, Error>>()?;
    let share = Proportion::of(covered.into_iter().flatten());
    let name = "30 units with 4 records in 3 years: coverage of mean, spread, repeatability, ageing and its spread";
    Ok(of_coverage(name, share, &seeds))
}

/// What became of a fleet with batches and sites.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Grouped {
    found: bool,
    /// Whether a batch or site is told that does not hold the units that differ.
    is_false: bool,
    both_told: bool,
}

/// Where a batch differs, and where it went.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Odd {
    Nothing,
    Batch,
    /// All its units are at one site, which has no others.
    BatchWithItsSite,
}

fn grouped(odd: Odd, seed: u64) -> Result<Grouped, Error> {
    let mut draw = Draw::new(seed, odd as u64);
    let differs = (draw.uniform() * COEFFICIENTS as f64) as usize;
    let others = (FLEET - ODD_BATCH) / (BATCHES - 1) + 1;
    let records: Vec<FleetRecord> = (0..FLEET)
        .map(|unit| {
            let batch = match unit < ODD_BATCH {
                true => 0,
                false => 1 + (unit - ODD_BATCH) / others,
            };
            let site = match odd {
                Odd::BatchWithItsSite if batch == 0 => SITES,
                _ => (draw.uniform() * SITES as f64) as u64,
            };
            let offset = f64::from(u8::from(odd != Odd::Nothing && batch == 0)) * SPREAD;
            let name = RecordName {
                unit: format!("{unit}"),
                record: "1".to_owned(),
                batch: Some(format!("{batch}")),
                site: Some(format!("{site}")),
                date_s: None,
            };
            let coefficients = (0..COEFFICIENTS).map(|index| {
                let sigma = SPREAD * draw.log_uniform([0.05, 0.2]);
                let level = SPREAD * draw.normal() + sigma * draw.normal();
                let own = if index == differs { offset } else { 0.0 };
                coefficient(index, level + own, sigma)
            });
            record(name, coefficients.collect())
        })
        .collect();
    let found = summarised(&records)?.groups;
    let holds = |kind, name: &str| match kind {
        GroupKind::Batch => odd != Odd::Nothing && name == "0",
        _ => odd == Odd::BatchWithItsSite && name == SITES.to_string(),
    };
    let name = format!("coefficient {differs}");
    let right = found
        .iter()
        .find(|one| one.coefficient == name && holds(one.group.kind, &one.group.name));
    let both = right.is_some_and(|one| {
        let mut alternatives = one.alternatives.iter();
        alternatives.any(|other| holds(other.group.kind, &other.group.name))
    });
    Ok(Grouped {
        found: right.is_some(),
        is_false: found.len() > usize::from(right.is_some()),
        both_told: both,
    })
}

fn groups(extent: Extent) -> Result<Vec<Figure>, Error> {
    let fleets = extent.records(GROUPED, 12);
    let seeds = FIRST_SEED..FIRST_SEED + fleets;
    let run = |odd: Odd, last: u64| -> Result<Vec<Grouped>, Error> {
        let cell = format!("groups {odd:?}");
        let campaign = resumable::campaign("fleet", &cell, seeds.start..last, extent.small)?;
        let outcome = campaign.run(|seed| grouped(odd, seed), |_| ())?;
        Ok(outcome.successes().map(|(_, one)| *one).collect())
    };
    let none = run(Odd::Nothing, seeds.end)?;
    let batch = run(Odd::Batch, seeds.end)?;
    let together = run(Odd::BatchWithItsSite, seeds.start + fleets / 10 + 2)?;
    let told = format!("{}..{}", seeds.start, seeds.end);
    let found = Proportion::of(batch.iter().map(|one| one.found));
    let wrong = Proportion::of(none.iter().chain(&batch).map(|one| one.is_false));
    let both = together.iter().filter(|one| one.found);
    let both = Proportion::of(both.map(|one| one.both_told));
    Ok(vec![
        Figure::within(
            "a batch of 30 of 400 units differs by one spread: found",
            [0.9, f64::INFINITY],
            found.share(),
        )
        .judged(found.at_least(0.9))
        .of_share(found)
        .over(batch.len(), told.clone()),
        Figure::within(
            "fleets with a batch or site that is falsely told to differ",
            [0.0, 0.02],
            wrong.share(),
        )
        .judged(wrong.at_most(0.02))
        .of_share(wrong)
        .over(none.len() + batch.len(), told.clone()),
        Figure::within(
            "the batch is a site too, and is found: both are told",
            [1.0, 1.0],
            both.share(),
        )
        .of_share(both)
        .over(both.trials as usize, "found ones of the first tenth"),
    ])
}

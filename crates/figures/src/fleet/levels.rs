//! Coefficients over the units of simulated fleets: coverage of the hierarchical intervals, batches and sites.

use gyrocal_fleet::{
    Coefficient, FleetOptions, FleetRecord, FleetResult, Group, GroupKind, RecordName,
    WithInterval, summarise,
};
use gyrocal_statistics::deviates::Draw;
use serde::{Deserialize, Serialize};

use super::fleets;
use crate::harness::{Context, Error, Figure, Row};

/// Numbers of units of the fleets of the coverage, and of those with records over years.
const UNITS: [u64; 3] = [5, 20, 100];
const OVER_YEARS: u64 = 30;

/// True spread of the units, and true standard deviation from record to record.
const SPREAD: f64 = 1.0;
const REPEATABILITY: f64 = 0.3;

/// True mean change in a year, and its spread.
const AGEING: [f64; 2] = [0.2, 0.1];

/// Seconds of a year, of 365.25 days.
const YEAR_S: f64 = 31_557_600.0;

/// Units of a fleet with batches, batches, sites, and units of the batch that differs; its coefficients.
const FLEET: u64 = 400;
const BATCHES: u64 = 12;
const SITES: u64 = 4;
const ODD_BATCH: u64 = 30;
const COEFFICIENTS: usize = 9;

/// First seed; constants were chosen on seeds below it.
const FIRST_SEED: u64 = 30_000;

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for units in UNITS {
        let name = format!("of {units}");
        let population = fleets(&name, [FIRST_SEED, 2000, 150], |seed| {
            one_record_each(units, seed)
        });
        let row = |place: usize, what| {
            let name =
                format!("{units} units: coverage of the 95 % interval of the fleet's {what}");
            Row::share(name, move |covered: &[bool; 2]| Some(covered[place])).of_coverage()
        };
        figures.extend(context.measure(&population, &[row(0, "mean"), row(1, "spread")])?);
    }
    let name = "30 units with 4 records in 3 years: coverage of mean, spread, repeatability, ageing and its spread";
    let row = Row::each(name, |covered: &[bool; 5]| *covered).of_coverage();
    let population = fleets("over years", [FIRST_SEED, 600, 60], over_years);
    figures.extend(context.measure(&population, &[row])?);
    figures.extend(groups(context)?);
    Ok(figures)
}

fn record(unit: u64, name: RecordName, coefficients: Vec<Coefficient>) -> FleetRecord {
    let unit = unit.to_string();
    FleetRecord {
        name: RecordName { unit, ..name },
        coefficients,
        causes: Vec::new(),
        is_settled: true,
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
    let records = (0..units).map(|unit| {
        let sigma = SPREAD * draw.log_uniform([0.1, 0.7]);
        let estimate = SPREAD * draw.normal() + sigma * draw.normal();
        let own = vec![coefficient(0, estimate, sigma)];
        record(unit, RecordName::default(), own)
    });
    let found = &summarised(&records.collect::<Vec<_>>())?.coefficients[0];
    Ok([covers(found.mean, 0.0), covers(found.spread, SPREAD)])
}

/// Units with four records over three years: all five intervals.
fn over_years(seed: u64) -> Result<[bool; 5], Error> {
    let mut draw = Draw::new(seed, 0);
    let mut records = Vec::new();
    for unit in 0..OVER_YEARS {
        let level = SPREAD * draw.normal();
        let slope = AGEING[0] + AGEING[1] * draw.normal();
        for index in 0..4 {
            let years = f64::from(index) + 0.5 * draw.uniform() - 1.75;
            let sigma = draw.log_uniform([0.05, 0.2]);
            let error = REPEATABILITY * draw.normal() + sigma * draw.normal();
            let name = RecordName {
                record: index.to_string(),
                date_s: Some(years * YEAR_S),
                ..RecordName::default()
            };
            let estimate = level + slope * years + error;
            records.push(record(unit, name, vec![coefficient(0, estimate, sigma)]));
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
    let records = (0..FLEET).map(|unit| {
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
            batch: Some(batch.to_string()),
            site: Some(site.to_string()),
            ..RecordName::default()
        };
        let coefficients = (0..COEFFICIENTS).map(|index| {
            let sigma = SPREAD * draw.log_uniform([0.05, 0.2]);
            let level = SPREAD * draw.normal() + sigma * draw.normal();
            let own = if index == differs { offset } else { 0.0 };
            coefficient(index, level + own, sigma)
        });
        record(unit, name, coefficients.collect())
    });
    let found = summarised(&records.collect::<Vec<_>>())?.groups;
    let holds = |kind, name: &str| match kind {
        GroupKind::Batch => odd != Odd::Nothing && name == "0",
        _ => odd == Odd::BatchWithItsSite && name == SITES.to_string(),
    };
    let name = format!("coefficient {differs}");
    let holds = |group: &Group| holds(group.kind, &group.name);
    let mut own = found.iter().filter(|one| one.coefficient == name);
    let right = own.find(|one| holds(&one.group));
    let both = right.is_some_and(|one| one.alternatives.iter().any(|of| holds(&of.group)));
    Ok(Grouped {
        found: right.is_some(),
        is_false: found.len() > usize::from(right.is_some()),
        both_told: both,
    })
}

fn groups(context: &Context) -> Result<Vec<Figure>, Error> {
    let job = |seed| Ok([grouped(Odd::Nothing, seed)?, grouped(Odd::Batch, seed)?]);
    let population = fleets("with a batch", [FIRST_SEED, 2000, 12], job);
    let found = |all: &[Grouped; 2]| Some(all[1].found);
    let is_false = |all: &[Grouped; 2]| all.map(|one| one.is_false);
    let worth = "thirty units of one spread are worth a look: nine of ten are found";
    let told = "fleets with a batch or site that is falsely told to differ";
    let rows = [
        Row::share(
            "a batch of 30 of 400 units differs by one spread: found",
            found,
        )
        .at_least(0.9, worth),
        Row::each(told, is_false).at_most(0.02, "the level is 1.8 %"),
    ];
    let mut figures = context.measure(&population, &rows)?;
    let job = |seed| grouped(Odd::BatchWithItsSite, seed);
    let population = fleets("with a batch at one site", [FIRST_SEED, 200, 3], job);
    let both = |one: &Grouped| one.found.then_some(one.both_told);
    let row = Row::share("the batch is a site too, and is found: both are told", both)
        .at_least(1.0, "the same units, the same evidence");
    figures.extend(context.measure(&population, &[row])?);
    Ok(figures)
}

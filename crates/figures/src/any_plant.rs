//! Diagnosis of any plant: five simulated plants with hidden effects.

mod coloured;
mod effort;
mod gauges;
pub(crate) mod hidden;
mod offsets;
mod oracle;
mod searched;
mod second;
mod unknown;

use std::path::PathBuf;

pub(crate) use gauges::derived;
use gyrocal_answer::Finding;
use gyrocal_evaluation::Statistic;
use gyrocal_plant::{FittedPlant, LoadedPlant, PlantError, PlantRecord, SearchOptions, diagnose};
pub(crate) use gyrocal_truth::plant as simulated;
use serde::{Deserialize, Serialize};

use self::simulated::{Kind, Run, Setting, Stream, simulate};
use crate::harness::{Context, Error, Figure, PLANTS, Population, Row, of};

/// Seeds of clean records, and of starts; no constant was tuned on them.
const CLEAN: u64 = 610_000;
const STARTS: u64 = 300_000;

/// Rows of a record.
const ROWS: usize = 600;

/// Costs within this of the least are those of the best fit.
const SAME_FIT: f64 = 1.0;

/// What is found in a record of one of the plants.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Of<T> {
    /// Index of the plant.
    pub(crate) plant: usize,
    pub(crate) found: T,
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let plants = plants()?;
    let mut figures = clean(context, &plants)?;
    figures.extend(context.measure(&hidden::population(&plants)?, &hidden::rows())?);
    figures.extend(searched::figures(context, &plants)?);
    figures.push(gauges::figure(&plants)?);
    figures.extend(starts(context, &plants)?);
    figures.extend(unknown::figures(context, &plants)?);
    figures.extend(coloured::figures(context, &plants)?);
    figures.extend(offsets::figures(context, &plants)?);
    figures.push(effort::lines()?);
    figures.push(effort::duration()?.timed(context.is_small()));
    figures.push(effort::interpreted(&plants[Kind::Duffing as usize])?);
    Ok(figures)
}

/// The plants, in the order of [`Kind::ALL`].
pub(crate) fn plants() -> Result<Vec<LoadedPlant>, PlantError> {
    Kind::ALL.into_iter().map(loaded).collect()
}

/// The file of an example plant.
fn program(kind: Kind) -> PathBuf {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    PathBuf::from(format!("{examples}/{}/plant.json", kind.facts().name))
}

/// An example plant.
pub(crate) fn loaded(kind: Kind) -> Result<LoadedPlant, PlantError> {
    LoadedPlant::read(&program(kind))
}

/// A population of records of some plants in turn: seeds and numbers are of each of them.
fn in_turn<'a, T>(
    name: &str,
    kinds: &'a [Kind],
    seeds: [u64; 3],
    job: impl Fn(Kind, u64) -> Result<T, Error> + Sync + 'a,
) -> Population<'a, Of<T>> {
    const FILES: &[&str] = &[file!(), "crates/figures/src/any_plant", "examples"];
    let count = kinds.len() as u64;
    let (name, seeds) = (format!("any plant, {name}"), seeds.map(|one| count * one));
    Population::new(name, seeds, of(PLANTS, FILES), move |seed| {
        let kind = kinds[(seed % count) as usize];
        let (plant, found) = (kind as usize, job(kind, seed / count)?);
        Ok(Of { plant, found })
    })
}

fn prepared(plant: &LoadedPlant, run: Run) -> Result<PlantRecord, PlantError> {
    let record = PlantRecord {
        time_s: run.time_s,
        inputs: run.inputs.concat(),
        outputs: run.outputs.concat(),
        ..PlantRecord::default()
    };
    record.prepared(plant.description(), "simulated")
}

/// Shares of the records of each plant.
fn by_kind<T: 'static>(name: &str, of: fn(&T) -> bool) -> [Row<'static, Of<T>>; Kind::ALL.len()] {
    Kind::ALL.map(|kind| {
        Row::share(format!("{name} {kind:?}"), move |one: &Of<T>| {
            (one.plant == kind as usize).then(|| of(&one.found))
        })
    })
}

/// Parameters within a factor of three of the declared ones, as a fit begins with them.
fn far_start(plant: &LoadedPlant, mut random: Stream) -> Vec<f64> {
    let mut first = vec![0.0; plant.description().states.len()];
    let parameters = plant.description().parameters.iter();
    first.extend(parameters.map(|own| own.value * (random.log_between(1.0 / 3.0, 3.0) - 1.0)));
    first
}

/// Whether the set of a finding holds an effect, or one that no record tells from it.
pub(crate) fn holds(found: &Finding, id: &str) -> bool {
    found.set().chain(found.equivalents()).any(|own| own == id)
}

/// False alarms on clean records; the noise of every second one is misdeclared.
fn clean(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let population = in_turn("clean", &Kind::ALL, [CLEAN, 400, 2], |kind, seed| {
        let mut setting = Setting::random(kind, seed, ROWS);
        if seed % 2 == 1 {
            setting.noise = Stream::new(seed, 9).log_between(0.5, 2.0);
        }
        let plant = &plants[kind as usize];
        let record = prepared(plant, simulate(&setting, None))?;
        let answer = diagnose(plant, record, None, &SearchOptions::default())?.answer;
        Ok(answer.has_findings())
    });
    let name = "any plant: false alarms of all five, noise of half misdeclared by 0.5 to 2";
    let mut rows = vec![Row::bound(name, |one: &Of<bool>| one.found).at_most(
        0.02,
        "the level is 1 %: twenty of 2000 are due, and 27 within the bound",
    )];
    rows.extend(by_kind("any plant: false alarms,", |found| *found));
    context.measure(&population, &rows)
}

/// Fits of oscillator and tanks from random parameters within a factor of three.
fn starts(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let kinds = [Kind::Duffing, Kind::Tanks];
    let mut fits = Vec::new();
    for kind in kinds {
        let plant = &plants[kind as usize];
        let record = prepared(plant, simulate(&Setting::random(kind, STARTS, ROWS), None))?;
        let held = FittedPlant::nominal(plant, record.clone(), &[])?
            .to_hold()?
            .0;
        let usual = FittedPlant::nominal_from(plant, record.clone(), &held, None)?.deviance();
        fits.push((record, held, usual));
    }
    let population = in_turn("starts", &kinds, [STARTS, 100, 2], |kind, seed| {
        let (plant, (record, held, _)) = (&plants[kind as usize], &fits[kind as usize]);
        let first = far_start(plant, Stream::new(seed, 3));
        let fit = FittedPlant::nominal_from(plant, record.clone(), held, Some(&first));
        Ok(fit.ok().map(|fit| fit.deviance()))
    });
    let reached = |records: &[Of<Option<f64>>]| {
        let least: Vec<f64> = (0..fits.len())
            .map(|plant| {
                let own = records.iter().filter(|one| one.plant == plant);
                let costs = own.filter_map(|one| one.found);
                costs.fold(fits[plant].2, f64::min)
            })
            .collect();
        Statistic::share(records, |one| {
            Some(
                one.found
                    .is_some_and(|cost| cost - least[one.plant] < SAME_FIT),
            )
        })
    };
    let name =
        "any plant: starts within a factor of 3 that reach the best fit, oscillator and tanks";
    let row =
        Row::new(name, reached).at_least(0.98, "a diagnosis has several starts, and one is enough");
    context.measure(&population, &[row])
}

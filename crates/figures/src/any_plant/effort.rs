//! What a diagnosis takes: lines of a user, and time.

use std::time::Instant;

use gyrocal_plant::{LoadedPlant, SearchOptions, diagnose};
use gyrocal_plant_codegen::{Package, Source};

use super::hidden::{HIDDEN, duffing};
use super::simulated::{Kind, Setting, simulate};
use super::{gauges, prepared};
use crate::harness::{Error, Figure};

/// Most lines of Python and of Rust.
const MOST_LINES: [usize; 2] = [60, 20];

/// Rows of the record that the time is measured on.
const LONG: usize = 4096;

/// Diagnoses that are timed.
const TIMED: usize = 5;

/// Lines that a new package has of each language, which are all that a diagnosis needs.
pub(super) fn lines() -> Result<Figure, Error> {
    let package = Package::new("oscillator", Source::Version("0".to_owned()))?;
    let count = |ending: &str| -> usize {
        let files = package.files.iter();
        let own = files.filter(|file| file.path.ends_with(ending));
        let filled = |text: &str| text.lines().filter(|line| !line.trim().is_empty()).count();
        own.map(|file| filled(&file.text)).sum()
    };
    let [python, rust] = [".py", ".rs"].map(count);
    let holds = python <= MOST_LINES[0] && rust <= MOST_LINES[1];
    let name = "any plant: lines from nothing to a diagnosis in a new package, Python / Rust";
    Ok(Figure {
        target: format!("<= {} / <= {}", MOST_LINES[0], MOST_LINES[1]),
        measured: format!("{python} / {rust}"),
        ..Figure::truth(name, holds)
    })
}

/// Time of one diagnosis of a long record, the least of a few: what else the machine does is no part of it.
pub(super) fn duration() -> Result<Figure, Error> {
    let plant = gauges::script("sixty.py")?;
    let least = least_s(&plant, TIMED)?;
    let name = format!(
        "any plant: time of a diagnosis, {LONG} rows, {} states, {} candidate terms, least of {TIMED}",
        plant.description().states.len(),
        plant.tables().effects.len()
    );
    Ok(Figure::at_most(&name, 1.0, least, "s"))
}

/// Time with interpreted and with generated functions of an oscillator.
pub(super) fn interpreted(plant: &LoadedPlant) -> Result<Figure, Error> {
    let generated = least_s(&plant.with_model(duffing::Duffing)?, 1)?;
    let name = "any plant: time of a diagnosis, interpreted / generated";
    let times = format!("{:.2} s / {generated:.2} s", least_s(plant, 1)?);
    Ok(Figure::note(name, times))
}

/// Least time of some diagnoses of one long record with an effect, s.
fn least_s(plant: &LoadedPlant, count: usize) -> Result<f64, Error> {
    let mut setting = Setting::random(Kind::Duffing, HIDDEN, LONG);
    setting.hidden = Kind::Duffing.facts().effects[0];
    let record = prepared(plant, simulate(&setting, None))?;
    let mut least = f64::INFINITY;
    for _ in 0..count {
        let record = record.clone();
        let began = Instant::now();
        diagnose(plant, record, None, &SearchOptions::default())?;
        least = least.min(began.elapsed().as_secs_f64());
    }
    Ok(least)
}

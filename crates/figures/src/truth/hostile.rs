//! Work of a diagnosis on hostile records, over that on a sound record of the same size.

mod records;

use gyrocal_calibration::work;
use gyrocal_evaluation::{Statistic, diagnosed};
use gyrocal_statistics::median;
use gyrocal_truth::Simulation;
use serde::{Deserialize, Serialize};

use super::drawn;
use crate::cost::on_one_core;
use crate::harness::{Context, Error, Figure, Population, Row, Sources, of};
use records::{FEW_ROWS, ROWS, record, sound};

const SOURCES: Sources = of(
    &["crates/diagnosis", "crates/truth"],
    &[file!(), records::FILE, drawn::FILE],
);

/// Cost of one diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Cost {
    kind: String,
    rows: usize,
    work: u64,
    seconds: f64,
}

fn cost(kind: &str, simulation: &Simulation) -> Cost {
    let before = work();
    let (_, seconds) = on_one_core(|| diagnosed(simulation));
    Cost {
        kind: kind.to_owned(),
        rows: simulation.record.len(),
        work: work() - before,
        seconds,
    }
}

/// Sound records of both sizes.
fn sound_costs(seed: u64) -> Result<[Cost; 2], Error> {
    let of = |rows: usize| Ok::<_, Error>(cost("sound", &sound(seed, rows)?));
    Ok([of(ROWS)?, of(FEW_ROWS)?])
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let name = "hostile, sound records beside";
    let reference = Population::new(name, [3_230_000, 5, 5], SOURCES, sound_costs);
    let reference = context.records(&reference)?;
    let job = |seed| record(seed).map(|(kind, simulation)| cost(kind, &simulation));
    let population = Population::new("hostile", [3_220_000, 200, 5], SOURCES, job);
    // Of a value over the median of sound records of that size.
    let over = move |one: &Cost, value: fn(&Cost) -> f64| {
        let sound = reference.records.iter().flatten();
        let of_size = sound.filter(|sound| sound.rows == one.rows).map(value);
        value(one) / median(&of_size.collect::<Vec<_>>())
    };
    let name = "work of `diagnose` on hostile records over a sound one of that size";
    let largest = |all: &[Cost]| {
        let works = all.iter().map(|one| over(one, |one| one.work as f64));
        Statistic::Value(works.fold(0.0, f64::max), all.len() as u64)
    };
    let time = |all: &[Cost]| {
        let largest = |of: &dyn Fn(&Cost) -> f64| all.iter().map(of).fold(0.0, f64::max);
        let slowest = largest(&|one| over(one, |one| one.seconds));
        let longest_s = largest(&|one| one.seconds);
        let work = |one: &Cost| over(one, |one| one.work as f64);
        let kind = all.iter().max_by(|a, b| work(a).total_cmp(&work(b)));
        let kind = kind.map_or("none", |one| &one.kind);
        format!("{slowest:.1} times, {longest_s:.1} s; most work: {kind}")
    };
    let rows = [
        Row::new(name, largest).at_most(20.0, "the budget of a search, with what comes before it"),
        Row::words("the same in time, largest", time),
    ];
    context.measure(&population, &rows)
}

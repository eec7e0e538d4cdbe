//! Dialects of files, read as they are or by the map that is proposed for them.

mod dialect;
mod drawn;

use gyrocal_instruments::{Description, InstrumentError, propose_map, read_any};
use gyrocal_record::Record;
use gyrocal_statistics::deviates::Draw;
use nalgebra::{Rotation3, Unit, Vector3};
use serde::{Deserialize, Serialize};

use self::dialect::Dialect;
use self::drawn::{Dialects, drawn};
use crate::harness::{Context, Error, Figure, INSTRUMENTS, Population, Row, Seeds, Sources, of};

/// What can move the results.
const SOURCES: Sources = of(
    INSTRUMENTS,
    &[
        file!(),
        "crates/figures/src/dialects.toml",
        "crates/figures/src/dialects",
    ],
);

/// Purpose of the stream of draws.
const FILE: u64 = 1810;

/// Seeds of the listed dialects and of those that are drawn.
const LISTED_FROM: u64 = 870_000;
const DRAWN_FROM: u64 = 871_000;

/// Rate of the Earth \[rad/s\].
const EARTH_RAD_PER_S: f64 = 7.292_115e-5;

/// Most difference of a value \[g\] and of a time \[s\] from what was written: eight decimals, and days of eight decimals;
/// a wrong unit, column, sign or format is far beyond.
const TOLERANCE_G: f64 = 1e-4;
const TOLERANCE_S: f64 = 2e-3;

/// What became of a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Outcome {
    dialect: String,
    as_is: bool,
    /// What went wrong; empty if it was read.
    fault: String,
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let dialects: Dialects = toml::from_str(include_str!("dialects.toml"))?;
    let all = &dialects.listed;
    let listed = |seed: u64| {
        let index = (seed % Seeds::REPORT - LISTED_FROM) as usize;
        outcome(&all[index % all.len()], seed)
    };
    let listed = Population::new("dialects listed", [LISTED_FROM, 40, 5], SOURCES, listed);
    let by_chance = |seed| outcome(&drawn(&dialects, &mut Draw::new(seed, FILE + 1)), seed);
    let by_chance = Population::new("dialects drawn", [DRAWN_FROM, 40, 5], SOURCES, by_chance);
    let mut figures = context.measure(&listed, &rows("listed dialects"))?;
    figures.extend(context.measure(&by_chance, &rows("drawn dialects"))?);
    Ok(figures)
}

fn rows(what: &str) -> [Row<'static, Outcome>; 2] {
    let is_wrong = |file: &Outcome| !file.fault.is_empty();
    let words = move |files: &[Outcome]| {
        let wrong = files.iter().filter(|file| is_wrong(file));
        let wrong = wrong.map(|file| format!("{}: {}", file.dialect, file.fault));
        let as_is = files.iter().filter(|file| file.as_is).count();
        let by_map = files.len() - as_is;
        match &wrong.collect::<Vec<_>>()[..] {
            [] => format!("{as_is} as they are, {by_map} by the proposed map"),
            wrong => wrong.join("; "),
        }
    };
    let faults = move |file: &Outcome| usize::from(is_wrong(file));
    [
        Row::count(format!("{what}: files that are not read"), faults)
            .at_most(0.0, "the target of all"),
        Row::words(format!("{what}: how they are read"), words),
    ]
}

/// Writes a record in a dialect and reads it.
fn outcome(dialect: &Dialect, seed: u64) -> Result<Outcome, Error> {
    let mut draw = Draw::new(seed, FILE);
    let (record, first_s) = record(&mut draw);
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("log.csv");
    std::fs::write(&path, dialect.bytes(&record, first_s))?;
    let read = |map: Option<String>| -> Result<Record, InstrumentError> {
        let description = map.map(|map| Description::parse(&map, "map.toml"));
        Ok(read_any(&path, description.transpose()?.as_ref())?.into_rising()?)
    };
    let plain = read(None);
    let as_is = plain.is_ok();
    let found = plain.or_else(|refused| {
        // Only what is told can be followed.
        match refused.advice().contains("--propose MAP.toml") {
            true => read(Some(propose_map(&path)?)),
            false => Err(refused),
        }
    });
    let fault = match found {
        Ok(found) => difference(&found, &record, dialect),
        Err(error) => format!("{error}; {}", error.advice()),
    };
    Ok(Outcome {
        dialect: format!("{} ({seed})", dialect.name),
        as_is,
        fault,
    })
}

/// A platform at rest for hours to days: gravity on a cone about the axis of the Earth, with noise. Times are whole
/// minutes from the first.
fn record(draw: &mut Draw) -> (Record, f64) {
    let interval_s = *draw.one_of(&[60.0, 120.0, 300.0]);
    let mut vector = || Vector3::from_fn(|_, _| draw.normal());
    let axis = Unit::new_normalize(vector());
    let across = axis.cross(&vector()).normalize();
    let latitude = draw.log_uniform([0.4, 1.0]);
    let mut record = Record {
        temperature_c: Some(Vec::new()),
        ..Record::default()
    };
    let up = axis.into_inner() * latitude.sin() + across * latitude.cos();
    for row in 0..400 {
        let time_s = f64::from(row) * interval_s;
        let force = Rotation3::from_axis_angle(&axis, -EARTH_RAD_PER_S * time_s) * up;
        record.time_s.push(time_s);
        let noisy = [0, 1, 2].map(|at| force[at] + 1e-5 * draw.normal());
        record.accel_g.push(noisy);
        let celsius = 22.0 + (time_s / 2e4).sin() + 0.02 * draw.normal();
        record.temperature_c.get_or_insert_default().push(celsius);
    }
    // A whole minute of 2026.
    let first_s = 1_767_139_200.0 + 60.0 * (draw.uniform() * 500_000.0).floor();
    (record, first_s)
}

/// The first value that is not as it was written.
fn difference(found: &Record, written: &Record, dialect: &Dialect) -> String {
    if found.len() != written.len() {
        return format!("{} rows of {}", found.len(), written.len());
    }
    let since_s = |record: &Record, row: usize| record.time_s[row] - record.time_s[0];
    for row in 0..found.len() {
        let late_s = since_s(found, row) - since_s(written, row);
        if late_s.abs() > TOLERANCE_S {
            return format!("row {row} is late by {late_s} s");
        }
        for axis in 0..3 {
            let is_missing = dialect.missing.is_some() && row % 50 == 7 + axis;
            let error_g = found.accel_g[row][axis] - written.accel_g[row][axis];
            if error_g.is_nan() != is_missing || error_g.abs() > TOLERANCE_G {
                return format!("axis {axis} of row {row} is off by {error_g} g");
            }
        }
        let celsius = |record: &Record| record.temperature_c.as_ref().map(|all| all[row]);
        let expected = celsius(written).filter(|_| dialect.temperature.is_some());
        // Two decimals of any unit.
        let same = match (celsius(found), expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 0.011,
            (found, expected) => found.is_none() && expected.is_none(),
        };
        if !same {
            return format!("the temperature of row {row} is {:?}", celsius(found));
        }
    }
    String::new()
}

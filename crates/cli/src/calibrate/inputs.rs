//! Records and bench descriptions, read and checked against each other.

use std::borrow::Cow;
use std::path::PathBuf;

use gyrocal_calibration::{Options, Run};
use gyrocal_diagnosis::{Blocks, CalibratedRecord, Gate};
use gyrocal_record::{AveragedReport, Bench, Record, SetupProblem, file_behind, printable_path};
use miette::miette;

use super::CalibrateArguments;
use crate::Failure;
use crate::records::refuse_shared_rows;

/// One record with the bench that it was taken on.
pub(super) struct Measurement {
    pub(super) path: PathBuf,
    pub(super) bench_path: PathBuf,
    pub(super) record: Record,
    pub(super) bench: Bench,
    /// Record and bench description before fast rows became means of blocks.
    before: Option<(Record, Bench)>,
    /// Rows before averaging.
    pub(super) rows: usize,
    pub(super) averaged: Option<AveragedReport>,
    /// Gross errors of the set-up.
    pub(super) setup: Vec<SetupProblem>,
    /// Whether one of them leaves nothing sound; the record is then as it was given.
    pub(super) stops: bool,
}

impl Measurement {
    pub(super) fn run(&self) -> Run<'_> {
        Run {
            record: &self.record,
            bench: &self.bench,
        }
    }

    pub(super) fn calibrated(&self) -> CalibratedRecord<'_> {
        CalibratedRecord {
            name: self.path.display().to_string(),
            bench_name: self.bench_path.display().to_string(),
            run: self.run(),
            diagnosed: match &self.before {
                Some((record, bench)) => Run { record, bench },
                None => self.run(),
            },
            rows: self.rows,
            averaged: self.averaged,
            setup: &self.setup,
        }
    }
}

/// Reads records and benches (one for all records or one for each), leaves out what gross errors of
/// the set-ups spoilt, averages if requested, and refuses inputs that cannot belong together.
pub(super) fn read(arguments: &CalibrateArguments) -> Result<Vec<Measurement>, Failure> {
    let given = &arguments.given;
    refuse_twins(&given.records)?;
    let (files, benches) = given.read()?;
    let mut measurements = Vec::with_capacity(files.len());
    for (((path, bench_path), file), bench) in given.pairs().zip(&files).zip(benches.iter()) {
        let found = Gate::of_file(given.kind(), file, bench, &Options::default())?;
        let stops = found.stops();
        let record = found.usable;
        let record = record.map_or_else(|| found.record.clone(), Cow::into_owned);
        measurements.push(Measurement {
            path: path.clone(),
            bench_path: bench_path.clone(),
            bench: bench.clone(),
            averaged: None,
            before: None,
            stops,
            rows: record.len(),
            record,
            setup: found.problems,
        });
    }
    let named: Vec<_> = measurements
        .iter()
        .map(|one| (&*one.path, &one.record))
        .collect();
    refuse_shared_rows(&named)?;
    if measurements.iter().any(|measurement| measurement.stops) {
        return Ok(measurements);
    }
    for measurement in &mut measurements {
        take_means(measurement, arguments)?;
    }
    Ok(measurements)
}

fn refuse_twins(records: &[PathBuf]) -> Result<(), Failure> {
    for (index, record) in records.iter().enumerate() {
        let mut earlier = records[..index].iter();
        if let Some(first) = earlier.find(|other| file_behind(other) == file_behind(record)) {
            return Err(Failure::Usage(format!(
                "{} and {} are the same file: a record counts once",
                printable_path(first),
                printable_path(record)
            )));
        }
    }
    Ok(())
}

/// Takes means in the place of rows: of the intervals of `--average`, or of blocks where rows come faster than anything
/// moves.
fn take_means(
    measurement: &mut Measurement,
    arguments: &CalibrateArguments,
) -> Result<(), Failure> {
    let run = measurement.run();
    let blocks = match arguments.average {
        Some(interval_s) => Some(Blocks::every(&run, interval_s).map_err(|error| {
            Failure::Work(miette!(
                help = "choose --average between these, or leave it out",
                "{}: {error}",
                printable_path(&measurement.path)
            ))
        })?),
        None if arguments.takes_blocks() => Blocks::of(&run, None),
        None => None,
    };
    if let Some(blocks) = blocks {
        let record = std::mem::replace(&mut measurement.record, blocks.record);
        let bench = std::mem::replace(&mut measurement.bench, blocks.bench);
        measurement.before = arguments.average.is_none().then_some((record, bench));
        measurement.averaged = Some(blocks.report);
    }
    Ok(())
}

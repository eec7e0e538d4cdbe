//! `gyrocal import csv`: the record of a stable platform from a described file.

use std::path::PathBuf;

use clap::Args;
use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::{Description, InstrumentError, average_file, read_record};
use gyrocal_record::{Record, ResultTable, printable_path, shell_quoted};

use crate::measured::unusable;
use crate::numbers::positive;
use crate::outputs::refuse_overlap;
use crate::{Failure, Reply};

/// A table of a stable platform in another format: CSV of any dialect, plain or compressed, MATLAB, Parquet,
/// MCAP.
///
/// Columns, units, axes and the dialect are those of the map. With --average a text is read in pieces, so
/// that its file may be larger than memory.
#[derive(Debug, Args)]
pub(super) struct TableArguments {
    /// The table: CSV, also compressed by gzip or Zstandard; MATLAB; with their features Parquet and MCAP.
    log: PathBuf,
    /// Map of its columns (TOML); docs/formats.md has every key.
    #[arg(long, value_name = "MAP.toml")]
    columns: PathBuf,
    /// Write the record; as Parquet if the name ends in .parquet.
    #[arg(long, value_name = "RECORD.csv")]
    out: PathBuf,
    /// Average over intervals of this length, 10 s at most; `calibrate --average` takes longer ones.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    average: Option<f64>,
}

/// Runs the command.
pub(super) fn run(arguments: &TableArguments) -> Result<Reply, Failure> {
    let inputs = [&*arguments.log, &*arguments.columns];
    refuse_overlap(&inputs, &[("--out", Some(&arguments.out))])?;
    let (record, rows) = read(arguments).map_err(|error| unusable(&arguments.log, error))?;
    let text = record.to_csv(&arguments.out)?;
    let is_parquet = arguments.out.extension().is_some_and(|it| it == "parquet");
    let content = match is_parquet {
        true => ResultTable::of_record(&record).content(&arguments.out)?,
        false => text.into_bytes(),
    };
    let what = format!(
        "{} rows over {:.1} s, from {rows} of {}",
        record.len(),
        record.duration_s(),
        printable_path(&arguments.log)
    );
    let mut screen = Screen::new(Standing::Good, "IMPORTED", what.clone());
    let out = shell_quoted(&arguments.out.display().to_string());
    screen.then(
        format!("gyrocal diagnose {out} --bench BENCH.toml"),
        "effects in the record",
    );
    let mut answer = Reply::of(screen, format!("{what}\n"));
    answer.write(Some(&arguments.out), "the record", |_| Ok(content))?;
    Ok(answer)
}

fn read(arguments: &TableArguments) -> Result<(Record, usize), InstrumentError> {
    let description = Description::read(&arguments.columns)?;
    if let Some(interval_s) = arguments.average {
        let averaged = average_file(&arguments.log, &description, interval_s)?;
        return Ok((averaged.record, averaged.rows));
    }
    let record = read_record(&arguments.log, &description)?.into_rising()?;
    let rows = record.len();
    Ok((record, rows))
}

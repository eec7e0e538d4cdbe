//! `gyrocal import csv`: the record of a stable platform from a described file, and the proposal of a description.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::{
    AveragedRecordFile, Description, average_file, parse_record, propose_map,
};
use gyrocal_record::{
    ClockFault, Record, RecordFile, ResultTable, SourceText, printable_path, restarts, shell_quoted,
};

use crate::measured::unusable;
use crate::numbers::positive;
use crate::outputs::refuse_overlap;
use crate::records::Map;
use crate::{Failure, Reply};

/// A table of a stable platform in another format: CSV of any dialect, plain or compressed, MATLAB, Parquet,
/// MCAP.
///
/// Columns, units, axes and the dialect are those of the map, which --propose writes from the names and the
/// values of a text. With --average a text is read in pieces, so that its file may be larger than memory.
#[derive(Debug, Args)]
pub(super) struct TableArguments {
    /// The table: CSV, also compressed by gzip or Zstandard; MATLAB; with their features Parquet and MCAP.
    log: PathBuf,
    #[command(flatten)]
    map: Map,
    /// Write a map of the table instead: separator, encoding, time, specific force, temperature and their units, as
    /// names and values suggest.
    #[arg(long, value_name = "MAP.toml", conflicts_with_all = ["columns", "out"])]
    propose: Option<PathBuf>,
    /// Write the record; as Parquet if the name ends in .parquet.
    #[arg(long, value_name = "RECORD.csv", required_unless_present = "propose")]
    out: Option<PathBuf>,
    /// Write a record of each part of a table whose clock goes back: RECORD.1.csv, RECORD.2.csv and so on.
    #[arg(long, requires = "out")]
    split: bool,
    /// Average over intervals of this length, 10 s at most; `calibrate --average` takes longer ones.
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with_all = ["split", "propose"])]
    average: Option<f64>,
}

/// Runs the command.
pub(super) fn run(arguments: &TableArguments) -> Result<Reply, Failure> {
    match (&arguments.propose, &arguments.out) {
        (Some(map), _) => propose(&arguments.log, map),
        (None, Some(out)) => import(arguments, out),
        (None, None) => Ok(Reply::default()),
    }
}

/// Writes a map, once the file is read by it.
fn propose(log: &Path, map: &Path) -> Result<Reply, Failure> {
    refuse_overlap(&[log], &[("--propose", Some(map))])?;
    let of_log = |error| unusable(log, error);
    let text = propose_map(log).map_err(of_log)?;
    let description = Description::parse(&text, &map.display().to_string())?;
    let source = SourceText::read_as(log, description.file.encoding.as_deref())?;
    let file = parse_record(source, &description).map_err(of_log)?;
    let screen = proposed(log, map, &file);
    let mut answer = Reply::of(screen, text.clone());
    answer.write(Some(map), "the map", |_| Ok(text))?;
    Ok(answer)
}

/// What the file is by a map of it; a clock whose times do not rise with its line.
fn proposed(log: &Path, map: &Path, file: &RecordFile) -> Screen {
    let record = file.record();
    let parts = restarts(&record.time_s);
    let fault = ClockFault::of(&record.time_s, file.name());
    let rows = format!("by it {} has {} rows", printable_path(log), record.len());
    let (standing, what) = match (&parts, &fault) {
        (Some(parts), _) => {
            let parts = parts.iter().map(|rows| record.part(rows.clone()));
            let duration_s: f64 = parts.map(|part| part.duration_s()).sum();
            let what = format!("{rows} over {duration_s:.1} s, the clock restarts");
            (Standing::Doubtful, what)
        }
        (None, Some(_)) => (Standing::Doubtful, format!("{rows}, times do not rise")),
        (None, None) => {
            let what = format!("{rows} over {:.1} s", record.duration_s());
            (Standing::Good, what)
        }
    };
    let mut screen = Screen::new(standing, "MAP PROPOSED", what);
    if let Some(fault) = &fault {
        let line = file.line(fault.row);
        let line = line.map_or_else(String::new, |line| format!("line {line}: "));
        // The way out of a clock that restarts is the next command.
        let advice = match parts {
            Some(_) => String::new(),
            None => format!("; {}", fault.advice),
        };
        screen.fact("clock", format!("{line}{}{advice}", fault.found));
    }
    let words = "check units, signs and the order of axes in it";
    screen.fact("what to do", words);
    let [log, map] = [log, map].map(|path| shell_quoted(&path.display().to_string()));
    match (parts, fault) {
        (Some(_), _) => screen.then(
            format!("gyrocal import csv {log} --columns {map} --split --out PART.csv"),
            "a record of each part",
        ),
        (None, Some(_)) => {}
        (None, None) => screen.then(
            format!("gyrocal diagnose {log} --columns {map} --bench BENCH.toml"),
            "effects in the record",
        ),
    }
    screen
}

fn import(arguments: &TableArguments, out: &Path) -> Result<Reply, Failure> {
    let inputs = [Some(&*arguments.log), arguments.map.path()];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().collect();
    let (parts, rows) = read(arguments)?;
    let outputs = match &parts[..] {
        [_] => vec![out.to_owned()],
        parts => (1..=parts.len()).map(|part| numbered(out, part)).collect(),
    };
    for output in &outputs {
        refuse_overlap(&inputs, &[("--out", Some(output))])?;
    }
    let what = format!(
        "{} rows over {:.1} s, from {rows} of {}",
        parts.iter().map(Record::len).sum::<usize>(),
        parts.iter().map(Record::duration_s).sum::<f64>(),
        printable_path(&arguments.log)
    );
    let mut screen = Screen::new(Standing::Good, "IMPORTED", what.clone());
    let names: Vec<String> = outputs
        .iter()
        .map(|out| shell_quoted(&out.display().to_string()))
        .collect();
    match &names[..] {
        [out] => screen.then(
            format!("gyrocal diagnose {out} --bench BENCH.toml"),
            "effects in the record",
        ),
        names => {
            screen.fact(
                "parts",
                format!(
                    "{}: the clock goes back between them, so FREE.toml is BENCH.toml without initial angles",
                    names.len()
                ),
            );
            let benches =
                " --bench BENCH.toml".to_owned() + &" --bench FREE.toml".repeat(names.len() - 1);
            screen.then(
                format!("gyrocal calibrate {}{benches}", names.join(" ")),
                "all parts together",
            );
        }
    }
    let mut answer = Reply::of(screen, format!("{what}\n"));
    for (record, out) in parts.iter().zip(&outputs) {
        let text = record.to_csv(out)?;
        let content = match out.extension().is_some_and(|it| it == "parquet") {
            true => ResultTable::of_record(record).content(out)?,
            false => text.into_bytes(),
        };
        answer.write(Some(out), "the record", |_| Ok(content))?;
    }
    Ok(answer)
}

/// `RECORD.csv` as `RECORD.2.csv`.
fn numbered(path: &Path, part: usize) -> PathBuf {
    let ending = path.extension().map(|it| it.to_string_lossy());
    let ending = ending.map_or_else(|| part.to_string(), |it| format!("{part}.{it}"));
    path.with_extension(ending)
}

/// The record, or its parts, and the number of rows that were read.
fn read(arguments: &TableArguments) -> Result<(Vec<Record>, usize), Failure> {
    if let Some(interval_s) = arguments.average {
        let description = arguments
            .map
            .description()?
            .map_or_else(Description::of_records, Ok)?;
        let averaged = average_file(&arguments.log, &description, interval_s);
        let AveragedRecordFile { record, rows } =
            averaged.map_err(|error| unusable(&arguments.log, error))?;
        return Ok((vec![record], rows));
    }
    let file = arguments.map.read(&arguments.log)?;
    let rows = file.record().len();
    let parts = restarts(&file.record().time_s).filter(|_| arguments.split);
    let record = match parts {
        Some(parts) => {
            let parts = parts.into_iter().map(|rows| file.record().part(rows));
            return Ok((parts.collect(), rows));
        }
        None => RecordFile::into_rising(file)?,
    };
    Ok((vec![record], rows))
}

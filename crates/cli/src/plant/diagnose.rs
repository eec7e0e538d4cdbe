//! `gyrocal plant diagnose`, and `diagnose` of a package for one plant.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_pages::{Part, of_plant, of_result, pictures};
use gyrocal_plant::description::Description;
use gyrocal_plant::{
    ColumnMap, DiagnosedRecords, LoadedPlant, NamedRecord, PlantError, SearchOptions,
    diagnose_records,
};
use gyrocal_record::{Manifest, printable_path};
use gyrocal_words::joined;

use super::warn_of_gaps;
use crate::numbers::probability;
use crate::outputs::{manifest, refuse_itself, write_answer};
use crate::page::Views;
use crate::progress::Progress;
use crate::{Failure, Reply, page};

/// Find what the model of this plant lacks in a record, or in several.
#[derive(Debug, Args)]
pub(super) struct RecordArguments {
    /// The record (CSV), with a header. Several records of one plant are diagnosed together, each with initial
    /// states of its own, and each alone.
    #[arg(value_name = "RECORD.csv", required = true)]
    records: Vec<PathBuf>,
    /// Columns of the records for time, inputs and outputs (TOML).
    #[arg(long, value_name = "MAP.toml")]
    columns: PathBuf,
    /// A later record of the same plant, to measure the gain of what is found.
    #[arg(long, value_name = "LATER.csv")]
    validate: Option<PathBuf>,
    /// Columns of the later record, if they differ.
    #[arg(long, value_name = "MAP.toml", requires = "validate")]
    validate_columns: Option<PathBuf>,
    /// Inputs of a run that could be made next (CSV with time and inputs): says what it would tell apart, and how
    /// much better the parameters would be known. Several are compared.
    #[arg(long, value_name = "RUN.csv", num_args = 1..)]
    next: Vec<PathBuf>,
    #[command(flatten)]
    views: Views,
    /// Family-wise false-alarm probability.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
}

/// Runs the command; `file` is that of the plant, if it is read from one.
pub(super) fn run(
    file: Option<&Path>,
    arguments: &RecordArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    let inputs = checked_inputs(file, arguments)?;
    let plant = plant()?;
    let columns = ColumnMap::read(&arguments.columns)?;
    let all = |paths: &[PathBuf], read: fn(&ColumnMap, &Description, &Path) -> _| {
        let read = paths
            .iter()
            .map(|path| read(&columns, plant.description(), path));
        let read = read.collect::<Result<Vec<NamedRecord>, PlantError>>()?;
        read.iter()
            .for_each(|one| warn_of_gaps(&columns, plant.description(), one));
        Ok::<_, PlantError>(read)
    };
    let records = all(&arguments.records, ColumnMap::named_record)?;
    let next = all(&arguments.next, ColumnMap::named_run)?;
    let later = match &arguments.validate {
        Some(path) => {
            let own = arguments.validate_columns.as_deref().map(ColumnMap::read);
            let columns = own.transpose()?.unwrap_or(columns);
            let later = columns.named_record(plant.description(), path)?;
            warn_of_gaps(&columns, plant.description(), &later);
            Some(later.record)
        }
        None => None,
    };
    let options = SearchOptions {
        false_alarm_probability: arguments.false_alarm,
        ..SearchOptions::default()
    };
    let rows = records.iter().map(|one| one.record.len()).sum();
    let progress = Progress::waiting("diagnosing", rows);
    let mut found = diagnose_records(&plant, records, later, &options)?;
    found.together.forecast(next)?;
    drop(progress);
    let manifest = manifest(plant.hash(), options.seed, &inputs)?;
    found.together.answer.manifest = manifest.clone();
    let answer = &found.together.answer;
    let mut shown = Reply::of_part(&of_result(answer));
    if arguments.views.are_asked() {
        let parts = parts(&found, arguments, &manifest)?;
        let together = |parts: &[Part]| parts.iter().take(1).cloned().flat_map(pictures).collect();
        let (views, record) = (&arguments.views, &arguments.records[0]);
        views.stage_parts(record, parts, together, &mut shown)?;
    }
    write_answer(arguments.views.json(), answer, &mut shown)?;
    Ok(shown)
}

/// All records together, and each alone.
fn parts(
    found: &DiagnosedRecords,
    arguments: &RecordArguments,
    manifest: &Manifest,
) -> Result<Vec<Part>, Failure> {
    let of = &arguments.records[0];
    let part = |one, name: &str| page::part(of, of_plant(one, name, manifest));
    let names = joined(arguments.records.iter().map(|one| file_name(one)), ", ");
    let mut parts = vec![part(&found.together, &names)?];
    for (record, alone) in arguments.records.iter().zip(&found.alone) {
        if let Ok(alone) = alone {
            parts.push(part(alone, &format!("{} alone", file_name(record)))?);
        }
    }
    Ok(parts)
}

/// Name of a record, without folders.
fn file_name(path: &Path) -> String {
    printable_path(Path::new(path.file_name().unwrap_or(path.as_os_str())))
}

/// The files that are read. Arguments that contradict each other are refused before that.
fn checked_inputs<'a>(
    file: Option<&'a Path>,
    arguments: &'a RecordArguments,
) -> Result<Vec<&'a Path>, Failure> {
    let records = arguments.records.iter().map(PathBuf::as_path);
    let mut inputs: Vec<&Path> = records.chain([arguments.columns.as_path()]).collect();
    inputs.extend(file);
    inputs.extend(arguments.validate.as_deref());
    inputs.extend(arguments.validate_columns.as_deref());
    inputs.extend(arguments.next.iter().map(PathBuf::as_path));
    arguments.views.check(&inputs, &[])?;
    let later = arguments.validate.as_deref();
    refuse_itself("--validate", later, &arguments.records)?;
    Ok(inputs)
}

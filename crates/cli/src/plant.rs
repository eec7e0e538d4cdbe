//! `gyrocal plant`: diagnosis of records of any plant. The commands of a package for one plant are here as
//! well.

mod derive;
mod extend;
mod new;

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use gyrocal_diagnosis::prose::{Screen, Standing};
use gyrocal_plant::answer::Diagnosis;
use gyrocal_plant::{ColumnMap, LoadedPlant, PlantError, SearchOptions, diagnose};
use gyrocal_record::write_json;
use gyrocal_statistics::format;
use miette::Report;

use crate::numbers::probability;
use crate::progress::Progress;
use crate::tables::{right, table};
use crate::terminal::Shown;
use crate::{Answer, Failure, outputs};

pub(crate) use new::{NewPlantArguments, run as run_new};

/// Derive, diagnose and extend any plant that a Python script declares.
///
/// docs/any-plant.md leads from an equation and a CSV file to a named cause and its gain.
#[derive(Debug, Args)]
pub(crate) struct PlantArguments {
    #[command(subcommand)]
    command: PlantCommand,
}

#[derive(Debug, Subcommand)]
enum PlantCommand {
    Derive(derive::DeriveArguments),
    Diagnose(PlantDiagnoseArguments),
    Extend(extend::ExtendArguments),
}

/// The commands of a package for one plant.
#[derive(Debug, Parser)]
#[command(about = "Diagnosis of records of one plant: docs/any-plant.md of gyrocal")]
pub(crate) struct PlantCli {
    #[command(flatten)]
    pub(crate) shown: Shown,
    #[command(subcommand)]
    command: OwnCommand,
}

#[derive(Debug, Subcommand)]
enum OwnCommand {
    Diagnose(RecordArguments),
    Extend(extend::ExtendArguments),
}

/// Find what the model of a plant lacks in a record.
#[derive(Debug, Args)]
struct PlantDiagnoseArguments {
    /// The plant: the program file that its Python script writes.
    #[arg(value_name = "PLANT.json")]
    plant: PathBuf,
    #[command(flatten)]
    record: RecordArguments,
}

/// Find what the model of this plant lacks in a record.
#[derive(Debug, Args)]
struct RecordArguments {
    /// The record (CSV), with a header.
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    /// Columns of the record for time, inputs and outputs (TOML).
    #[arg(long, value_name = "MAP.toml")]
    columns: PathBuf,
    /// A later record of the same plant, to measure the gain of what is found.
    #[arg(long, value_name = "LATER.csv")]
    validate: Option<PathBuf>,
    /// Columns of the later record, if they differ.
    #[arg(long, value_name = "MAP.toml", requires = "validate")]
    validate_columns: Option<PathBuf>,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// Family-wise false-alarm probability.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
}

impl From<PlantError> for Failure {
    fn from(error: PlantError) -> Self {
        Self::Work(Report::msg(error.to_string()))
    }
}

impl From<gyrocal_plant_codegen::Error> for Failure {
    fn from(error: gyrocal_plant_codegen::Error) -> Self {
        Self::Work(Report::msg(error.to_string()))
    }
}

/// Runs the command; returns its answer.
pub(crate) fn run(arguments: &PlantArguments) -> Result<Answer, Failure> {
    match &arguments.command {
        PlantCommand::Derive(arguments) => derive::run(arguments),
        PlantCommand::Diagnose(arguments) => {
            run_diagnose(Some(arguments.plant.as_path()), &arguments.record, || {
                LoadedPlant::read(&arguments.plant)
            })
        }
        PlantCommand::Extend(arguments) => extend::run(arguments),
    }
}

/// Runs a command of a package for one plant.
pub(crate) fn run_own(
    cli: &PlantCli,
    plant: Result<LoadedPlant, PlantError>,
) -> Result<Answer, Failure> {
    match &cli.command {
        OwnCommand::Diagnose(arguments) => run_diagnose(None, arguments, || plant),
        OwnCommand::Extend(arguments) => extend::run(arguments),
    }
}

fn run_diagnose(
    file: Option<&Path>,
    arguments: &RecordArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Answer, Failure> {
    let mut inputs = vec![arguments.record.as_path(), arguments.columns.as_path()];
    inputs.extend(file);
    inputs.extend(arguments.validate.as_deref());
    inputs.extend(arguments.validate_columns.as_deref());
    outputs::check(&inputs, arguments.json.as_deref(), None)?;
    let plant = plant()?;
    let columns = ColumnMap::read(&arguments.columns)?;
    let record = columns.record(plant.description(), &arguments.record)?;
    let later = match &arguments.validate {
        Some(path) => {
            let own = arguments.validate_columns.as_deref().map(ColumnMap::read);
            let columns = own.transpose()?.unwrap_or(columns);
            Some(columns.record(plant.description(), path)?)
        }
        None => None,
    };
    let options = SearchOptions {
        false_alarm_probability: arguments.false_alarm,
        ..SearchOptions::default()
    };
    let progress = Progress::waiting("diagnosing", record.len());
    let diagnosed = diagnose(&plant, record, later, &options)?;
    drop(progress);
    let mut answer = Answer::of(screen(&diagnosed.answer), details(&diagnosed.answer));
    if let Some(path) = &arguments.json {
        write_json(path, &diagnosed.answer)?;
        answer.wrote(path, "the result for programs");
    }
    Ok(answer)
}

fn screen(answer: &Diagnosis) -> Screen {
    let (standing, verdict) = if answer.has_findings() {
        (Standing::Bad, "MODEL LACKS SOMETHING")
    } else {
        (Standing::Good, "NOTHING FOUND")
    };
    let mut screen = Screen::new(standing, verdict, answer.verdict());
    for (label, words) in answer.facts() {
        screen.fact(label, words);
    }
    screen
}

fn details(answer: &Diagnosis) -> String {
    let mut shown = String::new();
    let mut parameters = table(vec![
        "",
        "unit",
        "declared",
        "nominal",
        "with findings",
        "sigma",
    ]);
    for one in &answer.parameters {
        let number = |value: f64| right(format::significant(value, 5));
        parameters.add_row(vec![
            one.name.as_str().into(),
            one.unit.as_str().into(),
            number(one.declared),
            number(one.nominal),
            number(one.value),
            right(format::significant(one.sigma, 2)),
        ]);
    }
    shown += &format!("{parameters}\n\n");
    let mut noise = table(vec!["noise", "over the declared one", "95 %"]);
    for one in &answer.noise {
        let [low, high] = one.interval.map(|end| format::significant(end, 3));
        noise.add_row(vec![
            one.of.as_str().into(),
            right(format::significant(one.ratio, 3)),
            right(format!("{low} to {high}")),
        ]);
    }
    shown += &format!("{noise}\n");
    shown
}

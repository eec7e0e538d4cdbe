//! `gyrocal plant`: fits and diagnosis of records of any plant. The commands of a package for one plant are here as
//! well.

mod derive;
mod diagnose;
mod extend;
mod fit;
mod new;
mod simulate;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use gyrocal_plant::description::Description;
use gyrocal_plant::{ColumnMap, LoadedPlant, NamedRecord, PlantError};
use miette::Report;

use crate::{Failure, Reply, terminal};

pub(crate) use new::{NewPlantArguments, run as run_new};

/// Derive, fit, compare, simulate, diagnose and extend any plant that a Python script declares.
///
/// docs/any-plant.md leads from an equation and a CSV file to a named cause and its gain.
#[derive(Debug, Args)]
pub(crate) struct PlantArguments {
    #[command(subcommand)]
    command: PlantCommand,
}

#[derive(Debug, Subcommand)]
enum PlantCommand {
    Compare(fit::CompareArguments),
    Derive(derive::DeriveArguments),
    Diagnose(OfPlant<diagnose::RecordArguments>),
    Extend(extend::ExtendArguments),
    Fit(OfPlant<fit::FitArguments>),
    Simulate(OfPlant<simulate::SimulateArguments>),
}

/// The commands of a package for one plant.
#[derive(Debug, Parser)]
#[command(about = "Diagnosis of records of one plant: docs/any-plant.md of gyrocal")]
pub(crate) struct PlantCli {
    #[command(flatten)]
    pub(crate) shown: terminal::Shown,
    #[command(subcommand)]
    command: OwnCommand,
}

#[derive(Debug, Subcommand)]
enum OwnCommand {
    Diagnose(diagnose::RecordArguments),
    Extend(extend::ExtendArguments),
    Fit(fit::FitArguments),
    Simulate(simulate::SimulateArguments),
}

// A comment of documentation would be the help of each command.
// Arguments of a command with a plant before them.
#[derive(Debug, Args)]
struct OfPlant<T: Args> {
    /// The plant: the program file that its Python script writes.
    #[arg(value_name = "PLANT.json")]
    plant: PathBuf,
    #[command(flatten)]
    own: T,
}

/// Warns of inputs that a record does not tell for a while.
fn warn_of_gaps(columns: &ColumnMap, plant: &Description, record: &NamedRecord) {
    let notes = columns.bridged(plant, record);
    notes.iter().for_each(|note| terminal::warn(note));
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
pub(crate) fn run(arguments: &PlantArguments) -> Result<Reply, Failure> {
    match &arguments.command {
        PlantCommand::Compare(arguments) => fit::run_compare(arguments),
        PlantCommand::Derive(arguments) => derive::run(arguments),
        PlantCommand::Diagnose(OfPlant { plant, own }) => {
            diagnose::run(Some(plant), own, || LoadedPlant::read(plant))
        }
        PlantCommand::Extend(arguments) => extend::run(arguments),
        PlantCommand::Fit(OfPlant { plant, own }) => {
            fit::run(Some(plant), own, || LoadedPlant::read(plant))
        }
        PlantCommand::Simulate(OfPlant { plant, own }) => {
            simulate::run(Some(plant), own, || LoadedPlant::read(plant))
        }
    }
}

/// Runs a command of a package for one plant.
pub(crate) fn run_own(
    cli: &PlantCli,
    plant: Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    match &cli.command {
        OwnCommand::Diagnose(arguments) => diagnose::run(None, arguments, || plant),
        OwnCommand::Extend(arguments) => extend::run(arguments),
        OwnCommand::Fit(arguments) => fit::run(None, arguments, || plant),
        OwnCommand::Simulate(arguments) => simulate::run(None, arguments, || plant),
    }
}

//! The command line.

use std::ffi::OsString;

use clap::{CommandFactory as _, FromArgMatches, Parser, Subcommand};
use gyrocal_record::printable_line;

use crate::allan::AllanArguments;
use crate::calibrate::CalibrateArguments;
use crate::characterise::CharacteriseArguments;
use crate::diagnose::DiagnoseArguments;
use crate::effects::EffectsArguments;
use crate::emit::EmitArguments;
use crate::exit;
use crate::extend::ExtendArguments;
use crate::help;
use crate::import::ImportArguments;
use crate::manual::{CompletionsArguments, ManArguments};
use crate::monte_carlo::MonteCarloArguments;
use crate::plan::PlanArguments;
use crate::plant::{NewPlantArguments, PlantArguments, PlantCli};
use crate::rates::RatesArguments;
use crate::report::ReportArguments;
use crate::simulate::SimulateArguments;
use crate::terminal::{Shown, color_of};
use crate::tumble::TumbleArguments;
use crate::watch::WatchArguments;

/// Calibration and diagnosis of gyro drift of inertially stabilised platforms.
#[derive(Debug, Parser)]
#[command(
    name = "gyrocal",
    version,
    about = "Calibration and diagnosis of gyro drift of inertially stabilised platforms"
)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) shown: Shown,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Allan(AllanArguments),
    Calibrate(CalibrateArguments),
    Characterise(CharacteriseArguments),
    Completions(CompletionsArguments),
    Diagnose(DiagnoseArguments),
    Effects(EffectsArguments),
    Emit(EmitArguments),
    Extend(ExtendArguments),
    Import(ImportArguments),
    Man(ManArguments),
    MonteCarlo(MonteCarloArguments),
    NewPlant(NewPlantArguments),
    Plan(PlanArguments),
    Plant(PlantArguments),
    Rates(RatesArguments),
    Report(ReportArguments),
    Simulate(SimulateArguments),
    Tumble(TumbleArguments),
    Watch(WatchArguments),
}

/// The definition of the command line, with examples and exit codes: that of its parser, its help, its
/// completions and its manual pages.
pub(crate) fn definition() -> clap::Command {
    help::completed(Cli::command())
}

impl Cli {
    /// Parses the arguments of the program, the first of which is its name. An error shows them with control characters escaped.
    pub(crate) fn of_arguments(arguments: &[OsString]) -> Result<Self, clap::Error> {
        parsed(definition(), arguments)
    }
}

impl PlantCli {
    /// As [`Cli::of_arguments`], of the program of a package for one plant.
    pub(crate) fn of_arguments(arguments: &[OsString]) -> Result<Self, clap::Error> {
        parsed(Self::command().after_help(exit::HELP), arguments)
    }
}

fn parsed<P: FromArgMatches>(
    definition: clap::Command,
    arguments: &[OsString],
) -> Result<P, clap::Error> {
    let definition = definition.color(color_of(arguments));
    let parsed = |arguments: &mut dyn Iterator<Item = OsString>| {
        let matches = definition.clone().try_get_matches_from(arguments)?;
        P::from_arg_matches(&matches)
    };
    parsed(&mut arguments.iter().cloned()).map_err(|error| {
        let escaped = arguments.iter().map(|argument| {
            printable_line(&argument.to_string_lossy())
                .into_owned()
                .into()
        });
        // The same arguments with other letters fail as they did.
        parsed(&mut { escaped }).err().unwrap_or(error)
    })
}

//! The command line.

use std::ffi::OsString;

use clap::{CommandFactory as _, FromArgMatches, Parser, Subcommand};
use gyrocal_record::printable_line;

use crate::plant::PlantCli;
use crate::terminal::{Shown, color_of};
use crate::{
    allan, calibrate, characterise, diagnose, effects, emit, exit, extend, help, import, manual,
    monte_carlo, plan, plant, rates, report, simulate, tumble, watch,
};

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
    Allan(allan::AllanArguments),
    Calibrate(calibrate::CalibrateArguments),
    Characterise(characterise::CharacteriseArguments),
    Completions(manual::CompletionsArguments),
    Diagnose(diagnose::DiagnoseArguments),
    Effects(effects::EffectsArguments),
    Emit(emit::EmitArguments),
    Extend(extend::ExtendArguments),
    Import(import::ImportArguments),
    Man(manual::ManArguments),
    MonteCarlo(monte_carlo::MonteCarloArguments),
    NewPlant(plant::NewPlantArguments),
    Plan(plan::PlanArguments),
    Plant(plant::PlantArguments),
    Rates(rates::RatesArguments),
    Report(report::ReportArguments),
    Simulate(simulate::SimulateArguments),
    Tumble(tumble::TumbleArguments),
    Watch(watch::WatchArguments),
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

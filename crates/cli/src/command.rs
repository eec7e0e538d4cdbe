//! The command line.

use std::ffi::OsString;

use clap::{CommandFactory as _, FromArgMatches, Parser, Subcommand};
use gyrocal_record::printable_line;

use crate::plant::PlantCli;
use crate::reply::Reply;
use crate::terminal::{Shown, color_of};
use crate::{
    Failure, allan, calibrate, characterise, diagnose, effects, emit, exit, extend, help, import,
    manual, monte_carlo, plan, plant, rates, report, simulate, tumble, watch,
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

/// The commands, each with its arguments and what runs it.
macro_rules! commands {
    ($($name:ident($arguments:ty) => $run:expr,)+) => {
        #[derive(Debug, Subcommand)]
        pub(crate) enum Command {
            $($name($arguments),)+
        }

        impl Command {
            /// Runs the command.
            pub(crate) fn run(&self) -> Result<Reply, Failure> {
                match self {
                    $(Self::$name(arguments) => ($run)(arguments),)+
                }
            }
        }
    };
}

commands! {
    Allan(allan::AllanArguments) => allan::run,
    Calibrate(calibrate::CalibrateArguments) => calibrate::run,
    Characterise(characterise::CharacteriseArguments) => characterise::run,
    Completions(manual::CompletionsArguments) => |given| manual::completions(given, definition()),
    Diagnose(diagnose::DiagnoseArguments) => diagnose::run,
    Effects(effects::EffectsArguments) => effects::run,
    Emit(emit::EmitArguments) => emit::run,
    Extend(extend::ExtendArguments) => extend::run,
    Import(import::ImportArguments) => import::run,
    Man(manual::ManArguments) => |given| manual::pages(given, definition()),
    MonteCarlo(monte_carlo::MonteCarloArguments) => monte_carlo::run,
    NewPlant(plant::NewPlantArguments) => plant::run_new,
    Plan(plan::PlanArguments) => plan::run,
    Plant(plant::PlantArguments) => plant::run,
    Rates(rates::RatesArguments) => rates::run,
    Report(report::ReportArguments) => report::run,
    Simulate(simulate::SimulateArguments) => simulate::run,
    Tumble(tumble::TumbleArguments) => tumble::run,
    Watch(watch::WatchArguments) => watch::run,
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

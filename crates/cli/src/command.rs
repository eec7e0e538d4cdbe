//! The command line.

use clap::{ArgAction, Parser, Subcommand};

use crate::allan::AllanArguments;
use crate::calibrate::CalibrateArguments;
use crate::characterise::CharacteriseArguments;
use crate::diagnose::DiagnoseArguments;
use crate::extend::ExtendArguments;
use crate::import::ImportArguments;
use crate::monte_carlo::MonteCarloArguments;
use crate::plan::PlanArguments;
use crate::simulate::SimulateArguments;
use crate::tumble::TumbleArguments;

/// Calibration and diagnosis of gyro drift of inertially stabilised platforms.
#[derive(Debug, Parser)]
#[command(
    name = "gyrocal",
    version,
    about,
    after_help = "Exit codes: 0 the result was written, 1 an input or the computation failed, \
                  2 the command line is wrong."
)]
pub(crate) struct Cli {
    /// More messages on stderr; -vv and -vvv for still more.
    #[arg(short, long, action = ArgAction::Count, global = true)]
    pub(crate) verbose: u8,
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Allan(AllanArguments),
    Calibrate(CalibrateArguments),
    Characterise(CharacteriseArguments),
    Diagnose(DiagnoseArguments),
    Extend(ExtendArguments),
    Import(ImportArguments),
    MonteCarlo(MonteCarloArguments),
    Plan(PlanArguments),
    Simulate(SimulateArguments),
    Tumble(TumbleArguments),
}

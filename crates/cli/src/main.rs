//! The command `gyrocal`: calibration and diagnosis of gyro drift from records of an inertially
//! stabilised platform.
//!
//! Each subcommand is a module: arguments, calls of the libraries, tables and text, JSON, pictures.
//! Files are written whole or not at all. Statistics and estimation are in the libraries.
//!
//! Exit codes: 0 the result was written, 1 an input or the computation failed, 2 the command line
//! is wrong.

mod allan;
mod calibrate;
mod characterise;
mod command;
mod diagnose;
mod error_report;
mod extend;
mod import;
mod layout;
mod measured;
mod monte_carlo;
mod noise;
mod numbers;
mod outputs;
mod pictures;
mod plan;
mod progress;
mod simulate;
mod tables;
mod text;
mod tumble;

use std::io::{ErrorKind, IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::Parser as _;
use miette::Report;

use crate::command::{Cli, Command};
use crate::error_report::ErrorReport;

fn main() -> ExitCode {
    let cli = Cli::parse();
    start_logging(cli.verbose);
    show_errors_plainly();
    let outcome = match &cli.command {
        Command::Allan(arguments) => allan::run(arguments).map(Answer::from),
        Command::Calibrate(arguments) => calibrate::run(arguments),
        Command::Characterise(arguments) => characterise::run(arguments),
        Command::Diagnose(arguments) => diagnose::run(arguments),
        Command::Extend(arguments) => extend::run(arguments).map(Answer::from),
        Command::MonteCarlo(arguments) => monte_carlo::run(arguments).map(Answer::from),
        Command::Import(arguments) => import::run(arguments).map(Answer::from),
        Command::Plan(arguments) => plan::run(arguments).map(Answer::from),
        Command::Simulate(arguments) => simulate::run(arguments).map(Answer::from),
        Command::Tumble(arguments) => tumble::run(arguments).map(Answer::from),
    };
    match outcome {
        Ok(answer) => {
            let mut stdout = std::io::stdout();
            let written = stdout.write_all(answer.text.as_bytes());
            match written.and_then(|()| stdout.flush()) {
                // A closed pipe, as in `| head`, is not a failure.
                Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                    let _ = writeln!(std::io::stderr(), "stdout: cannot be written: {error}");
                    ExitCode::from(1)
                }
                _ => ExitCode::from(answer.exit_code),
            }
        }
        Err(Failure::Usage(message)) => {
            use clap::CommandFactory as _;
            let error = Cli::command().error(clap::error::ErrorKind::ArgumentConflict, message);
            let _ = error.print();
            ExitCode::from(2)
        }
        Err(Failure::Work(report)) => {
            let _ = writeln!(anstream::stderr(), "{report:?}");
            ExitCode::from(1)
        }
    }
}

/// Result of a command.
#[derive(Debug)]
struct Answer {
    /// Text for stdout.
    text: String,
    /// 0 unless `--exit-code` asks for another one.
    exit_code: u8,
}

impl From<String> for Answer {
    fn from(text: String) -> Self {
        Self { text, exit_code: 0 }
    }
}

/// Failure of a command.
#[derive(Debug)]
enum Failure {
    /// The command line is contradictory.
    Usage(String),
    /// An input is wrong or an output cannot be written.
    Work(Report),
}

impl From<gyrocal_record::Error> for Failure {
    fn from(error: gyrocal_record::Error) -> Self {
        Self::Work(error.into())
    }
}

fn start_logging(verbose: u8) {
    use tracing::level_filters::LevelFilter;

    let level = match verbose {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        2 => LevelFilter::DEBUG,
        _ => LevelFilter::TRACE,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .init();
}

/// Sets the form of errors.
fn show_errors_plainly() {
    // Fails if a handler is installed already, which is then used.
    let _ = miette::set_hook(Box::new(|_| Box::new(ErrorReport::of_stderr())));
}

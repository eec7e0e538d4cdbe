//! The command `gyrocal`: calibration and diagnosis of gyro drift from records of an inertially
//! stabilised platform.
//!
//! Each subcommand is a module: arguments, calls of the libraries, tables and text, JSON, pictures.
//! Files are written whole or not at all. Statistics and estimation are in the libraries.
//!
//! [`run`] is the whole command; the binary and the Python package call it. [`run_plant`] is that of a
//! package for one plant.
//!
//! `exit.rs` has the exit codes. Text reaches the terminal in `terminal.rs` and errors in
//! `error_report.rs`, without characters that would steer it.

mod advice;
mod allan;
mod calibrate;
mod characterise;
mod command;
mod diagnose;
mod effects;
mod emit;
mod error_report;
mod exit;
mod extend;
mod gyro_axes;
mod help;
mod import;
mod layout;
mod manual;
mod measured;
mod monte_carlo;
mod numbers;
mod outputs;
mod page;
mod pictures;
mod plan;
mod plant;
mod progress;
mod rates;
mod records;
mod reply;
mod report;
mod simulate;
mod terminal;
mod text;
mod tumble;
mod watch;
mod width;

use std::ffi::OsString;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

use gyrocal_document::Words;
use gyrocal_plant::{LoadedPlant, PlantError};
use gyrocal_record::printable_path;
use miette::{Report, miette};

pub use crate::calibrate::NotCalibrated;
use crate::command::{Cli, Command, definition};
pub use crate::diagnose::NotDiagnosed;
use crate::error_report::ErrorReport;
pub use crate::plan::NotPlanned;
use crate::plant::PlantCli;
use crate::reply::Reply;
use crate::terminal::Shown;

/// An answer in words as text for a terminal.
#[must_use]
pub fn text_of(pieces: &[Words]) -> String {
    layout::layout(pieces)
}

/// Runs the command with its arguments, the first of which is the name of the program: reads and
/// writes files, stdout and stderr. Returns the exit code of the process.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    outputs::remember("gyrocal".into(), &arguments);
    match Cli::of_arguments(&arguments) {
        Ok(cli) => {
            start(&cli.shown);
            shown(&cli.shown, answer(cli.command.as_ref()))
        }
        Err(error) => refused(&error),
    }
}

/// Runs the program of a package for one plant: `fit`, `simulate`, `diagnose` and `extend`, as `gyrocal plant` does.
/// Returns the exit code of the process.
pub fn run_plant(
    arguments: impl IntoIterator<Item = OsString>,
    plant: Result<LoadedPlant, PlantError>,
) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    outputs::remember(program(&arguments), &arguments);
    match PlantCli::of_arguments(&arguments) {
        Ok(cli) => {
            start(&cli.shown);
            shown(&cli.shown, plant::run_own(&cli, plant))
        }
        Err(error) => refused(&error),
    }
}

/// Name of the program of a package, without its path.
fn program(arguments: &[OsString]) -> OsString {
    let path = arguments.first().map(Path::new);
    let name = path.and_then(Path::file_stem);
    name.unwrap_or_default().to_owned()
}

/// The commands that write a result for programs with `--json`, each as its words.
#[must_use]
pub fn commands_with_json() -> Vec<String> {
    let mut found = Vec::new();
    let mut waiting = vec![(String::new(), definition())];
    while let Some((words, command)) = waiting.pop() {
        if command
            .get_arguments()
            .any(|one| one.get_long() == Some("json"))
        {
            found.push(words.trim_start().to_owned());
        }
        for own in command.get_subcommands() {
            waiting.push((format!("{words} {}", own.get_name()), own.clone()));
        }
    }
    found.sort();
    found
}

/// Shows help, a version, or what is wrong with a command line.
fn refused(error: &clap::Error) -> u8 {
    // Help and version are among them, and go to stdout.
    let _ = error.print();
    u8::try_from(error.exit_code()).unwrap_or(exit::USAGE)
}

fn start(how: &Shown) {
    how.apply();
    // A command meets a path once: one that is read twice is the same input.
    gyrocal_record::keep_streams();
    start_logging(how.verbose);
    show_errors_plainly();
}

/// Writes the files of an answer, and prints it or a failure; returns the exit code.
fn shown(how: &Shown, answer: Result<Reply, Failure>) -> u8 {
    match answer.and_then(Reply::committed) {
        Ok(answer) => {
            let text = answer.shown(width::columns(), how.verbose > 0);
            let text = if how.quiet { "" } else { &text };
            match terminal::print(text) {
                // A closed pipe, as in `| head`, is not a failure.
                Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                    let _ = writeln!(std::io::stderr(), "stdout: cannot be written: {error}");
                    exit::FAILED
                }
                _ => answer.exit_code,
            }
        }
        Err(Failure::Usage(message)) => {
            let message = gyrocal_record::printable(&message).into_owned();
            let error = definition().error(clap::error::ErrorKind::ArgumentConflict, message);
            let _ = error.print();
            exit::USAGE
        }
        Err(Failure::Work(report)) => {
            let _ = writeln!(anstream::stderr(), "{report:?}");
            exit::FAILED
        }
    }
}

/// The answer of a command; without one, what people do first.
fn answer(command: Option<&Command>) -> Result<Reply, Failure> {
    command.map_or_else(
        || {
            Ok(Reply {
                exit_code: exit::USAGE,
                ..Reply::from(help::WELCOME.to_owned())
            })
        },
        Command::run,
    )
}

/// Failure of a command.
#[derive(Debug)]
enum Failure {
    /// The command line is contradictory.
    Usage(String),
    /// An input is wrong or an output cannot be written.
    Work(Report),
}

impl Failure {
    /// What is wrong with a file, in a sentence of which its path is the beginning.
    fn of(path: &Path, why: impl std::fmt::Display) -> Self {
        Self::Work(miette!("{}: {why}", printable_path(path)))
    }
}

impl From<gyrocal_record::Error> for Failure {
    fn from(error: gyrocal_record::Error) -> Self {
        Self::Work(error.into())
    }
}

fn start_logging(verbose: u8) {
    use tracing::level_filters::LevelFilter;

    let level = match verbose {
        0 | 1 => LevelFilter::WARN,
        2 => LevelFilter::INFO,
        3 => LevelFilter::DEBUG,
        _ => LevelFilter::TRACE,
    };
    // Fails if messages are collected already, by an earlier command of the process.
    let _ = tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(|| terminal::Messages)
        .with_ansi(false)
        .try_init();
}

/// Sets the form of errors.
fn show_errors_plainly() {
    // Fails if a handler is installed already, which is then used.
    let _ = miette::set_hook(Box::new(|_| Box::new(ErrorReport::of_stderr())));
}

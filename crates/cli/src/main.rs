//! The command `gyrocal`.
//!
//! Exit codes: 0 when the answer was written, 1 when an input or the work failed, 2 when the
//! command line is wrong.

mod allan;
mod calibrate;
mod characterise;
mod command;
mod diagnose;
mod extend;
mod import;
mod measured;
mod monte_carlo;
mod noise;
mod numbers;
mod outputs;
mod pictures;
mod plan;
mod progress;
mod rounding;
mod simulate;
mod tables;
mod text;
mod tumble;

use std::io::{ErrorKind, IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::Parser as _;
use miette::{MietteHandlerOpts, Report};

use crate::command::{Cli, Command};

fn main() -> ExitCode {
    let cli = Cli::parse();
    start_logging(cli.verbose);
    show_errors_plainly();
    let outcome = match &cli.command {
        Command::Allan(arguments) => allan::run(arguments).map(Answer::from),
        Command::Calibrate(arguments) => calibrate::run(arguments).map(Answer::from),
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
            let told = stdout.write_all(answer.text.as_bytes());
            match told.and_then(|()| stdout.flush()) {
                // A reader that has gone away, as in `| head`, is no failure of the work.
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
            let _ = writeln!(std::io::stderr(), "{report:?}");
            ExitCode::from(1)
        }
    }
}

/// What a command has to say.
#[derive(Debug)]
struct Answer {
    /// What goes to stdout.
    text: String,
    /// 0 unless the command was asked to speak to scripts.
    exit_code: u8,
}

impl From<String> for Answer {
    fn from(text: String) -> Self {
        Self { text, exit_code: 0 }
    }
}

/// Why a command did not do what it was asked for.
#[derive(Debug)]
enum Failure {
    /// The command line contradicts itself.
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

/// Lines are wrapped for people only: scripts look for `file:line:column` in one piece.
fn show_errors_plainly() {
    let wrap = std::io::stderr().is_terminal();
    // It fails if a handler is there already, and then that one serves.
    let _ = miette::set_hook(Box::new(move |_| {
        let options = MietteHandlerOpts::new()
            .terminal_links(false)
            .break_words(false)
            .wrap_lines(wrap);
        Box::new(options.build())
    }));
}

//! `cargo figures TOPIC` prints every figure that the documentation claims: target, measured
//! value, runs, seeds, and whether it holds. The exit code is 1 if one does not.

mod figure;
mod kernel;
mod main_job;

use std::process::ExitCode;

use clap::{Parser, ValueEnum};

use figure::table;

#[derive(Parser)]
#[command(
    name = "figures",
    about = "Measures and prints the figures that the documentation claims"
)]
struct Arguments {
    /// What to measure.
    topic: Topic,
    /// Fewer runs, and nothing that builds copies of the workspace: what continuous integration
    /// runs. Targets stay as they are.
    #[arg(long)]
    small: bool,
    /// Renew the committed measurements of the topic instead of judging by them (kernel:
    /// instruction counts).
    #[arg(long)]
    write: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Topic {
    /// From symbols to nine drift coefficients.
    MainJob,
    /// The structured kernel: speed, scaling, rounding errors, instructions.
    Kernel,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let figures = match arguments.topic {
        Topic::MainJob => main_job::figures(arguments.small),
        Topic::Kernel => kernel::figures(arguments.small, arguments.write),
    };
    match figures {
        Ok(figures) => {
            println!("{}", table(&figures));
            let failed = figures
                .iter()
                .filter(|figure| figure.holds == Some(false))
                .count();
            if failed == 0 {
                ExitCode::SUCCESS
            } else {
                eprintln!("{failed} of {} figures do not hold", figures.len());
                ExitCode::FAILURE
            }
        }
        Err(error) => {
            eprintln!("figures could not be measured: {error}");
            ExitCode::FAILURE
        }
    }
}

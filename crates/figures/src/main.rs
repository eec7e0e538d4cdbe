//! `cargo figures TOPIC` measures the figures that the documentation claims and prints them with target,
//! number of runs and seeds. The exit code is 1 if a figure does not hold.

mod calibration;
mod cost;
mod diagnosis_ground;
mod error;
mod figure;
mod gain;
mod house;
mod kernel;
mod main_job;
mod measured;
mod naming;
mod page;
mod paper;
mod resumable;
mod truth;
mod values;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};

use figure::table;

#[derive(Parser)]
#[command(
    name = "figures",
    about = "Measures and prints the figures that the documentation claims"
)]
struct Arguments {
    /// Topic to measure.
    topic: Topic,
    /// Fewer runs, and nothing that builds copies of the workspace: what continuous integration
    /// runs. Targets stay as they are.
    #[arg(long)]
    small: bool,
    /// Only these parts of the topic (truth).
    #[arg(long = "part", value_name = "PART")]
    parts: Vec<truth::Part>,
    /// Most records of each population (truth): a part of the full version, which goes on from there.
    #[arg(long, value_name = "COUNT")]
    records: Option<u64>,
    /// Also write the table into this file, with the command that printed it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Renew the committed measurements of the topic instead of judging by them (kernel:
    /// instruction counts; house: results of the records; measured: docs/measured-data.md; paper: docs/paper.md and its
    /// pictures).
    #[arg(long)]
    write: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Topic {
    /// From symbols to nine drift coefficients.
    MainJob,
    /// The batch estimator: consistency over a population, exactness, cost.
    Calibration,
    /// The structured kernel: speed, scaling, rounding errors, instructions.
    Kernel,
    /// Foundations of the diagnosis: the noise audit, and signatures against the simulation.
    DiagnosisGround,
    /// Operating characteristics of the diagnosis on records with injected effects and on clean ones.
    Naming,
    /// Gain of extended models: in cross-validation, in the coefficients, and on a second record.
    Gain,
    /// Structure of the tree, equal results before and after, cost of a build.
    House,
    /// Two recordings of real gyros: docs/measured-data.md.
    Measured,
    /// Truth of the diagnosis outside of the population that its constants were tuned on.
    Truth,
    /// The paper, reproduced and corrected: docs/paper.md and its pictures.
    Paper,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let figures = match arguments.topic {
        Topic::MainJob => main_job::figures(arguments.small),
        Topic::Calibration => calibration::figures(arguments.small),
        Topic::Kernel => kernel::figures(arguments.small, arguments.write),
        Topic::DiagnosisGround => diagnosis_ground::figures(arguments.small),
        Topic::Naming => naming::figures(arguments.small),
        Topic::Gain => gain::figures(arguments.small),
        Topic::House => house::figures(arguments.small, arguments.write),
        Topic::Measured => measured::figures(arguments.write),
        Topic::Truth => {
            let extent = truth::Extent {
                small: arguments.small,
                most: arguments.records,
            };
            truth::figures(extent, &arguments.parts)
        }
        Topic::Paper => paper::figures(arguments.write),
    };
    match figures {
        Ok(figures) => {
            let table = table(&figures);
            println!("{table}");
            if let Some(path) = &arguments.out
                && let Err(error) = write_page(path, &arguments, &table.to_string())
            {
                eprintln!("{error}");
                return ExitCode::FAILURE;
            }
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

/// Writes the printed table as a page of the documentation.
fn write_page(
    path: &std::path::Path,
    arguments: &Arguments,
    table: &str,
) -> Result<(), gyrocal_record::Error> {
    let topic = arguments.topic.to_possible_value();
    let topic = topic.as_ref().map_or("", |value| value.get_name());
    let small = if arguments.small { " --small" } else { "" };
    let processor = gyrocal_testkit::timing::processor();
    let commit = house::commit(&gyrocal_testkit::workspace());
    let page = format!(
        "# Figures: {topic}\n\nPrinted by `cargo figures {topic}{small}` of commit {commit} on \
         {processor}. Times and ratios of times are those of that machine, and instruction counts \
         those of its compiler. All else differs by rounding at most: where the target fuses \
         multiplication and addition, last bits differ.\n\n{table}\n"
    );
    gyrocal_record::write_whole(path, page.as_bytes())
}

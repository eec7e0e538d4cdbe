//! `cargo figures TOPIC` measures the figures that the documentation claims and prints them with target,
//! number of runs and seeds. The exit code is 1 if a figure does not hold.

mod any_plant;
mod calibration;
mod catalogue;
mod comparison;
mod cost;
mod diagnosis_ground;
mod embedded;
mod error;
mod figure;
mod fleet;
mod gain;
mod generator;
mod house;
mod kernel;
mod logs;
mod main_job;
mod measured;
mod naming;
mod page;
mod paper;
mod plant_peers;
mod report;
mod resumable;
mod topic_page;
mod truth;
mod uncertainty;
mod values;
mod watch;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};

use error::Error;
use figure::{Figure, table};
use topic_page::Origin;

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
    /// Most records of each population (truth, naming, logs, any-plant, plant-peers, watch, uncertainty; fleet: without the Python package): a part of the full version, which goes on from there.
    #[arg(long, value_name = "COUNT")]
    records: Option<u64>,
    /// Also write the table into this file, with the command that printed it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Renew the committed measurements of the topic instead of judging by them (kernel:
    /// instruction counts; house: results of the records; measured: docs/measured-data.md; paper
    /// and catalogue: their page and its pictures; truth: the sections of its parts; all others:
    /// docs/figures/TOPIC.md). With --records the page says so.
    #[arg(long, conflicts_with = "small")]
    write: bool,
}

impl Arguments {
    /// The options that leave out a part of the topic, as they are given.
    fn extent(&self) -> String {
        let mut extent = String::new();
        if self.small {
            extent.push_str(" --small");
        }
        for part in &self.parts {
            extent = format!("{extent} --part {}", part.name());
        }
        if let Some(records) = self.records {
            extent = format!("{extent} --records {records}");
        }
        extent
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Topic {
    /// Five simulated plants with hidden effects: alarms, sets, gain, starts, time.
    AnyPlant,
    /// The diagnosis of a plant beside sparse and symbolic regression from PyPI.
    PlantPeers,
    /// From symbols to nine drift coefficients.
    MainJob,
    /// The batch estimator: consistency over a population, exactness, cost.
    Calibration,
    /// The catalogue of effects: docs/catalogue.md and a picture of each signature.
    Catalogue,
    /// The structured kernel: speed, scaling, rounding errors, instructions.
    Kernel,
    /// The generator of Rust against others: speed, instructions, operations, random graphs.
    Generator,
    /// Foundations of the diagnosis: the noise audit, and signatures against the simulation.
    DiagnosisGround,
    /// The filter in a controller: an emulated Cortex-M4F, single precision.
    Embedded,
    /// Operating characteristics of the diagnosis on records with injected effects and on clean ones.
    Naming,
    /// The diagnosis beside the usual tests and selection methods, on the same records.
    Comparison,
    /// Gain of extended models: in cross-validation, in the coefficients, and on a second record.
    Gain,
    /// Structure of the tree, equal results before and after, cost of a build.
    House,
    /// Two recordings of real gyros: docs/measured-data.md.
    Measured,
    /// Instrument tests on simulated logs: noise, positions, stops.
    Logs,
    /// The report: its files, in a browser; pictures of it.
    Report,
    /// Truth of the diagnosis outside of the population that its constants were tuned on.
    Truth,
    /// The watch beside the filter: false alarms, delays, jumps, sets in simulated platform-years.
    Watch,
    /// The paper, reproduced and corrected: docs/paper.md and its pictures.
    Paper,
    /// The uncertainty budget against simulated and calibrated runs.
    Uncertainty,
    /// The Python package: its wheel, a first diagnosis with it, fleets of records.
    Fleet,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let extent = truth::Extent {
        small: arguments.small,
        most: arguments.records,
    };
    let origin = Origin::now(&arguments.topic.name(), &arguments.extent());
    let figures = match arguments.topic {
        Topic::AnyPlant => any_plant::figures(extent),
        Topic::PlantPeers => plant_peers::figures(extent),
        Topic::MainJob => main_job::figures(arguments.small),
        Topic::Calibration => calibration::figures(arguments.small),
        Topic::Catalogue => catalogue::figures(arguments.write),
        Topic::Kernel => kernel::figures(arguments.small, arguments.write),
        Topic::Generator => generator::figures(arguments.small),
        Topic::DiagnosisGround => diagnosis_ground::figures(arguments.small),
        Topic::Embedded => embedded::figures(arguments.small),
        Topic::Naming => naming::figures(extent),
        Topic::Comparison => comparison::figures(arguments.small),
        Topic::Gain => gain::figures(arguments.small),
        Topic::House => house::figures(arguments.small, arguments.write),
        Topic::Measured => measured::figures(arguments.write),
        Topic::Logs => logs::figures(extent),
        Topic::Report => report::figures(arguments.small, arguments.write),
        Topic::Truth => truth::figures(extent, &arguments.parts, |part, figures| {
            let path = topic_page::path(&origin.topic);
            let table = table(figures).to_string();
            match arguments.write {
                true => topic_page::write_part(
                    &path,
                    &origin,
                    &part.name(),
                    &truth::Part::names(),
                    &table,
                ),
                false => Ok(()),
            }
        }),
        Topic::Watch => watch::figures(extent),
        Topic::Uncertainty => uncertainty::figures(extent),
        Topic::Paper => paper::figures(arguments.write),
        Topic::Fleet => fleet::figures(extent),
    };
    match figures {
        Ok(mut figures) => {
            let written = written(&arguments, &origin, &figures);
            if arguments.small {
                figures.extend(compared(arguments.topic, &figures));
            }
            println!("{}", table(&figures));
            if let Err(error) = written {
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

impl Topic {
    /// Its name on the command line.
    fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// `true` if `--write` renews the page of figures as a whole and no other measurements.
    fn writes_its_page(self) -> bool {
        !matches!(
            self,
            Self::Kernel
                | Self::House
                | Self::Measured
                | Self::Paper
                | Self::Catalogue
                | Self::Truth
        )
    }
}

/// Writes the figures into the pages that were asked for.
fn written(arguments: &Arguments, origin: &Origin, figures: &[Figure]) -> Result<(), Error> {
    let topic = arguments.topic;
    let own = (arguments.write && topic.writes_its_page()).then(|| topic_page::path(&topic.name()));
    let introduction = match topic {
        Topic::Comparison => comparison::side_by_side(figures),
        Topic::Generator => generator::INTRODUCTION.trim_end().to_owned(),
        _ => String::new(),
    };
    let table = table(figures).to_string();
    for path in own.iter().chain(&arguments.out) {
        topic_page::write(path, origin, &introduction, &table)?;
    }
    Ok(())
}

/// Comparison of a small run with the committed page of its topic.
fn compared(topic: Topic, figures: &[Figure]) -> Vec<Figure> {
    let name = topic.name();
    let renewed_by = match topic {
        // Their pages are compared as a whole, in any version.
        Topic::Measured | Topic::Paper | Topic::Catalogue => return Vec::new(),
        Topic::Truth => format!("cargo figures {name} --write"),
        _ if topic.writes_its_page() => format!("cargo figures {name} --write"),
        _ => format!("cargo figures {name} --out docs/figures/{name}.md"),
    };
    topic_page::compared(&name, &renewed_by, figures)
}

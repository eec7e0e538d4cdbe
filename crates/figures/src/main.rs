//! `cargo figures TOPIC` measures the figures that the documentation claims and prints them with target, number of
//! runs, seeds and commit. The exit code is 1 if a figure does not hold.

mod answers;
mod any_plant;
mod before;
mod calibration;
mod catalogue;
mod comparison;
mod cost;
mod diagnosis_ground;
mod dialects;
mod embedded;
mod error;
mod facts;
mod field;
mod figure;
mod fleet;
mod gain;
mod gate;
mod generator;
mod harness;
mod house;
mod kernel;
mod logs;
mod measured;
mod naming;
mod page;
mod paper;
mod plant_peers;
mod real_plants;
mod records;
mod report;
mod topics;
mod truth;
mod values;
mod watch;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args as _, Command, FromArgMatches as _};

use error::Error;
use figure::{Figure, table_of};
use gate::Section;
use harness::night::Night;
use harness::sources::JUDGING;
use harness::stamp::Stamp;
use harness::topic::Topic;
use harness::{Context, Seeds, Size, pages};
use topics::topics;

/// How much of a topic is measured, on development seeds.
#[derive(clap::Args, Debug)]
struct Extent {
    /// Only these parts.
    #[arg(long = "part", value_name = "PART")]
    parts: Vec<String>,
    /// Fewer runs, and nothing that builds copies of the workspace: what continuous integration runs.
    #[arg(long)]
    small: bool,
    /// Most records of each population.
    #[arg(long, value_name = "COUNT", conflicts_with = "small")]
    records: Option<u64>,
    /// Only the record of this name (doors, parts before and facts).
    #[arg(long = "record", value_name = "NAME")]
    named: Vec<String>,
    /// Also write the table into this file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Renew documents and committed measurements of the parts instead of judging by them.
    #[arg(long, conflicts_with = "small")]
    write: bool,
}

impl Extent {
    fn context(&self) -> Context {
        let size = match self.records {
            Some(most) => Size::Most(most),
            None if self.small => Size::Small,
            None => Size::Full,
        };
        Context {
            write: self.write,
            named: self.named.clone(),
            store: (!self.small).then(|| gyrocal_testkit::workspace().join("target/figures")),
            ..Context::new(size, Seeds::Development)
        }
    }
}

fn definition(topics: &[Topic]) -> Command {
    let topics = topics.iter().map(|topic| {
        let parts = topic.parts.iter();
        let parts = parts.map(|part| format!("\n  {}: {}", part.name, part.about));
        // The arguments bring a text of their own, which is not that of the topic.
        Extent::augment_args(Command::new(topic.name.clone()))
            .about(topic.about.clone())
            .after_help(format!("Parts:{}", parts.collect::<String>()))
    });
    let night = Night::augment_args(Command::new("night"))
        .about("Every part at full size on report seeds, in pieces; renews the pages");
    let check = Check::augment_args(Command::new("check"))
        .about("The small version of the parts whose sources changed, compared with the pages");
    let section = Section::augment_args(Command::new("section"))
        .about("Slow sections of the gate and their stamps");
    Command::new("figures")
        .about("Measures and prints the figures that the documentation claims")
        .subcommand_required(true)
        .subcommands(topics)
        .subcommands([night, check, section])
}

fn main() -> ExitCode {
    if let Some(arguments) = before::as_command() {
        return ExitCode::from(gyrocal_cli::run(arguments));
    }
    match asked() {
        Ok(figures) => concluded(&figures),
        Err(error) => {
            eprintln!("figures could not be measured: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The figures that the command asks for.
fn asked() -> Result<Vec<Figure>, Error> {
    let topics = topics()?;
    let matches = definition(&topics).get_matches();
    match matches.subcommand() {
        Some(("night", matches)) => Night::from_arg_matches(matches)?.run(&topics),
        Some(("check", matches)) => check(&topics, Check::from_arg_matches(matches)?.all),
        Some(("section", matches)) => {
            Section::from_arg_matches(matches)?.run()?;
            Ok(Vec::new())
        }
        Some((name, matches)) => measured(&topics, name, &Extent::from_arg_matches(matches)?),
        None => Ok(Vec::new()),
    }
}

/// The figures of a topic.
fn measured(topics: &[Topic], name: &str, extent: &Extent) -> Result<Vec<Figure>, Error> {
    let mut topics = topics.iter();
    let topic = topics
        .find(|topic| topic.name == name)
        .ok_or("no topic of this name")?;
    let mut figures = topic.figures(&extent.context(), &extent.parts)?;
    if let Some(path) = &extent.out {
        written(path, topic, extent, &figures)?;
    }
    if extent.small {
        figures.extend(pages::compared(&topic.name, &figures));
    }
    Ok(figures)
}

/// How much is checked.
#[derive(clap::Args, Debug)]
struct Check {
    /// Every part, also one whose sources are as they were when it passed last.
    #[arg(long)]
    all: bool,
}

/// The small version of every part whose sources changed since it passed, beside its page; the figures that do not
/// hold. Each part that passes leaves its stamp.
fn check(topics: &[Topic], all: bool) -> Result<Vec<Figure>, Error> {
    let context = Context::new(Size::Small, Seeds::Development);
    let mut failed = Vec::new();
    let parts = topics
        .iter()
        .flat_map(|topic| topic.parts.iter().map(move |part| (&*topic.name, part)));
    for (topic, part) in parts.filter(|(_, part)| !part.slow) {
        let name = format!("{topic}-{}", part.name);
        let stamp = Stamp::new(&format!("figures/{name}"), &[&part.sources, &JUDGING])?;
        if !all && !stamp.is_stale() {
            println!("{topic}, {}: as it was when it passed", part.name);
            continue;
        }
        let begin = std::time::Instant::now();
        let mut figures = (part.figures)(&context)?;
        figures.extend(pages::compared(topic, &figures));
        let (s, table) = (begin.elapsed().as_secs_f64(), table_of(&figures));
        println!("{topic}, {} ({s:.0} s)\n{table}", part.name);
        figures.retain(|figure| figure.holds == Some(false));
        if figures.is_empty() {
            stamp.write()?;
        }
        failed.extend(figures);
    }
    Ok(failed)
}

/// Writes a table into a file of the user.
fn written(path: &Path, topic: &Topic, extent: &Extent, figures: &[Figure]) -> Result<(), Error> {
    let parts = extent.parts.iter().map(|part| format!(" --part {part}"));
    let small = extent.small.then(|| " --small".to_owned());
    let records = extent.records.map(|most| format!(" --records {most}"));
    let options: String = parts.chain(small).chain(records).collect();
    let (name, table) = (&topic.name, table_of(figures));
    let page =
        format!("# Figures: {name}\n\nPrinted by `cargo figures {name}{options}`.\n\n{table}\n");
    Ok(gyrocal_record::write_whole(path, page.as_bytes())?)
}

/// Prints the figures; a failure if one does not hold.
fn concluded(figures: &[Figure]) -> ExitCode {
    if !figures.is_empty() {
        println!("{}", table_of(figures));
    }
    let failed = figures.iter().filter(|one| one.holds == Some(false));
    let failed = failed.count();
    if failed == 0 {
        return ExitCode::SUCCESS;
    }
    eprintln!("{failed} of {} figures do not hold", figures.len());
    ExitCode::FAILURE
}

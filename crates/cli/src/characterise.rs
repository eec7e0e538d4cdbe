//! `gyrocal characterise`: how often the diagnosis is right, beside other methods.

mod sheet;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_characterise::{Cell, CellReport, CharacteriseReport, Method, campaign, cell_report};
use gyrocal_record::{SCHEMA_VERSION, write_json, write_whole};
use miette::miette;

use crate::monte_carlo::progress::SeedProgress;
use crate::outputs::{manifest, refuse_overlap, refuse_unwritable};
use crate::{Answer, Failure};

/// Judge the diagnosis by many simulated records with hidden causes.
///
/// Prints how often causes are detected, named and measured rightly, what clean records show, and
/// how often the usual methods are right on the same records. The full table takes hours: --cell
/// and --runs measure a part of it, and with --results, a run that was stopped goes on where it was.
/// docs/characteristics.md explains the figures.
#[derive(Debug, Args)]
pub(crate) struct CharacteriseArguments {
    /// Only this cell of the table; may be given several times. One of clean, d5, d6, d8, d12, d5-50,
    /// pair, beyond, step, cubic, azimuth.
    #[arg(long = "cell", value_name = "NAME", value_parser = cell)]
    cells: Vec<Cell>,
    /// Records of each cell instead of 1000 (clean: 2000), on which targets must be met; on fewer
    /// they must not be shown to be missed.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    runs: Option<u64>,
    /// The first seed of each cell.
    #[arg(
        long, value_name = "S", default_value_t = 0,
        value_parser = clap::value_parser!(u64).range(..1_000_000_000_000)
    )]
    seed: u64,
    /// Keep each finished record in CELL.jsonl of this folder and go on from those that are there.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,
    /// Compare with this method; may be given several times. One of nis, ljung-box, bic, stls, none;
    /// all four otherwise.
    #[arg(long = "method", value_name = "NAME", value_parser = method)]
    methods: Vec<Asked>,
    /// Use this many threads instead of one for each core.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// The result to write for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// The tables to write as a page of documentation.
    #[arg(long, value_name = "OUT.md")]
    markdown: Option<PathBuf>,
    /// Exit with 3 if a figure does not hold.
    #[arg(long)]
    exit_code: bool,
}

/// What --method was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Asked {
    Method(Method),
    None,
}

/// Exit code of --exit-code if a figure does not hold.
const MISSED: u8 = 3;

/// Runs the command; returns what is to be said on stdout.
pub(crate) fn run(arguments: &CharacteriseArguments) -> Result<Answer, Failure> {
    check_outputs(arguments)?;
    let methods = methods(&arguments.methods)?;
    if let Some(folder) = &arguments.results {
        std::fs::create_dir_all(folder).map_err(|reason| unusable(folder, &reason))?;
    }
    let cells = if arguments.cells.is_empty() {
        Cell::ALL.to_vec()
    } else {
        arguments.cells.clone()
    };
    let mut reports: Vec<CellReport> = Vec::with_capacity(cells.len());
    for (index, cell) in cells.iter().enumerate() {
        if !cells[..index].contains(cell) {
            reports.push(report(arguments, *cell, &methods)?);
        }
    }
    let mut text = sheet::text(&reports);
    let exit_code = match reports.iter().all(CellReport::holds) {
        false if arguments.exit_code => MISSED,
        _ => 0,
    };
    let manifest = manifest(MODEL_HASH, arguments.seed, &[])?;
    if let Some(path) = &arguments.markdown {
        write_whole(path, sheet::page(&reports, &manifest.command).as_bytes())?;
        text.push_str(&format!("{}: the tables as a page\n", path.display()));
    }
    if let Some(path) = &arguments.json {
        let report = CharacteriseReport {
            schema_version: SCHEMA_VERSION,
            manifest,
            cells: reports,
        };
        write_json(path, &report)?;
        text.push_str(&format!("{}: the result for programs\n", path.display()));
    }
    Ok(Answer { text, exit_code })
}

fn check_outputs(arguments: &CharacteriseArguments) -> Result<(), Failure> {
    let (json, markdown) = (arguments.json.as_deref(), arguments.markdown.as_deref());
    // Also those of cells that are not asked for now.
    let results = arguments.results.iter();
    let kept: Vec<PathBuf> = results
        .flat_map(|folder| Cell::ALL.map(|cell| kept(folder, cell)))
        .collect();
    let mut outputs: Vec<(&str, Option<&Path>)> = kept
        .iter()
        .map(|path| ("--results", Some(&**path)))
        .collect();
    outputs.extend([("--json", json), ("--markdown", markdown)]);
    refuse_overlap(&[], &outputs)?;
    // Hours of work are not to end at a folder that is not there.
    refuse_unwritable(&[json, markdown], arguments.results.as_deref())
}

/// Where the records of a cell are kept.
fn kept(folder: &Path, cell: Cell) -> PathBuf {
    folder.join(format!("{}.jsonl", cell.name()))
}

fn report(
    arguments: &CharacteriseArguments,
    cell: Cell,
    methods: &[Method],
) -> Result<CellReport, Failure> {
    let runs = arguments.runs.unwrap_or(cell.full_runs());
    let seeds: Range<u64> = arguments.seed..arguments.seed + runs;
    let mut campaign = campaign(cell, seeds.clone(), methods);
    if let Some(folder) = &arguments.results {
        campaign = campaign.results(kept(folder, cell));
    }
    if let Some(threads) = arguments.threads {
        campaign = campaign.threads(threads);
    }
    let mut progress = SeedProgress::named(&cell.name());
    let outcome = campaign
        .run(
            |seed| cell.examine(seed, methods),
            |state| progress.reach(state),
        )
        .map_err(|error| Failure::Work(miette!("{error}")))?;
    tracing::info!(
        cell = cell.name(),
        resumed = outcome.resumed(),
        "all seeds done"
    );
    Ok(cell_report(cell, &outcome, &seeds))
}

fn unusable(folder: &Path, reason: &std::io::Error) -> Failure {
    Failure::Work(miette!(
        "{}: the results cannot be kept there: {reason}",
        folder.display()
    ))
}

fn cell(name: &str) -> Result<Cell, String> {
    Cell::of_name(name).map_err(|error| error.to_string())
}

fn method(name: &str) -> Result<Asked, String> {
    if name == "none" {
        return Ok(Asked::None);
    }
    let found = Method::ALL.into_iter().find(|method| method.name() == name);
    found.map(Asked::Method).ok_or_else(|| {
        let known = Method::ALL.map(Method::name).join(", ");
        format!("expected one of {known}, none")
    })
}

/// The methods in their own order, whatever order they were asked for in.
fn methods(asked: &[Asked]) -> Result<Vec<Method>, Failure> {
    let none = asked.contains(&Asked::None);
    if none && asked.iter().any(|asked| *asked != Asked::None) {
        return Err(Failure::Usage(
            "--method none and another method; give either".to_owned(),
        ));
    }
    let is_asked = |method: &Method| asked.is_empty() || asked.contains(&Asked::Method(*method));
    Ok(Method::ALL.into_iter().filter(is_asked).collect())
}

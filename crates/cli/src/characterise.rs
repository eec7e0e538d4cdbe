//! `gyrocal characterise`: operating characteristics of the diagnosis and of baseline methods.

mod markdown;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_evaluation::{
    BaselineMethod, CellReport, CharacteriseReport, PopulationCell, cell_campaign, cell_report,
};
use gyrocal_pages::of_characterise;
use gyrocal_record::SCHEMA_VERSION;
use miette::miette;

use crate::monte_carlo::progress::SeedProgress;
use crate::outputs::{manifest, refuse_overlap, refuse_unwritable};
use crate::{Failure, Reply, exit};

/// Measure the operating characteristics of the diagnosis on simulated records with hidden effects.
///
/// Prints the rates of detection, identification and interval coverage, the false alarms on
/// fault-free records, and the same for baseline methods. The full table takes hours: --cell and
/// --runs measure a part of it, and with --results an interrupted run continues.
/// docs/characteristics.md explains the figures.
#[derive(Debug, Args)]
pub(crate) struct CharacteriseArguments {
    /// Only this cell of the table; may be given several times. One of clean, d5, d6, d8, d12, d5-50,
    /// pair, beyond, step, cubic, azimuth.
    #[arg(long = "cell", value_name = "NAME", value_parser = cell)]
    cells: Vec<PopulationCell>,
    /// Records per cell; default 1000 (clean: 2000), on which targets must be met; on fewer they
    /// must not be significantly missed.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    runs: Option<u64>,
    /// First seed of each cell.
    #[arg(
        long, value_name = "S", default_value_t = 0,
        value_parser = clap::value_parser!(u64).range(..1_000_000_000_000)
    )]
    seed: u64,
    /// Keep each finished record in CELL.jsonl of this folder, and continue from those that exist.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,
    /// Only this baseline method; may be given several times. One of nis, ljung-box, bic, stls,
    /// none; default: all four.
    #[arg(long = "method", value_name = "NAME", value_parser = method)]
    methods: Vec<Asked>,
    /// Number of threads; default: one per core.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "OUT.md")]
    markdown: Option<PathBuf>,
    /// Exit code 3 if a figure misses its target.
    #[arg(long)]
    exit_code: bool,
}

/// Value of `--method`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Asked {
    Method(BaselineMethod),
    None,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &CharacteriseArguments) -> Result<Reply, Failure> {
    check_outputs(arguments)?;
    let methods = methods(&arguments.methods)?;
    if let Some(folder) = &arguments.results {
        std::fs::create_dir_all(folder).map_err(|reason| unusable(folder, &reason))?;
    }
    let cells = if arguments.cells.is_empty() {
        PopulationCell::ALL.to_vec()
    } else {
        arguments.cells.clone()
    };
    let mut reports: Vec<CellReport> = Vec::with_capacity(cells.len());
    for (index, cell) in cells.iter().enumerate() {
        if !cells[..index].contains(cell) {
            reports.push(report(arguments, *cell, &methods)?);
        }
    }
    let report = CharacteriseReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, arguments.seed, &[])?,
        cells: reports,
    };
    let part = of_characterise(&report);
    let mut answer = Reply::of_part(&part);
    if arguments.exit_code && !report.cells.iter().all(CellReport::holds) {
        answer.exit_code = exit::FOUND;
    }
    let markdown = arguments.markdown.as_deref();
    answer.write(markdown, "the tables as Markdown", |_| {
        Ok(markdown::page(&part.sections, &report.manifest.command))
    })?;
    answer.write_json(arguments.json.as_deref(), &report)?;
    Ok(answer)
}

fn check_outputs(arguments: &CharacteriseArguments) -> Result<(), Failure> {
    let (json, markdown) = (arguments.json.as_deref(), arguments.markdown.as_deref());
    // Including cells that are not requested.
    let results = arguments.results.iter();
    let kept: Vec<PathBuf> = results
        .flat_map(|folder| PopulationCell::ALL.map(|cell| kept(folder, cell)))
        .collect();
    let mut outputs: Vec<(&str, Option<&Path>)> = kept
        .iter()
        .map(|path| ("--results", Some(&**path)))
        .collect();
    outputs.extend([("--json", json), ("--markdown", markdown)]);
    refuse_overlap(&[], &outputs)?;
    // A missing folder must not end hours of work.
    refuse_unwritable(&[json, markdown], arguments.results.as_deref())
}

/// File of the kept records of a cell.
fn kept(folder: &Path, cell: PopulationCell) -> PathBuf {
    folder.join(format!("{}.jsonl", cell.name()))
}

fn report(
    arguments: &CharacteriseArguments,
    cell: PopulationCell,
    methods: &[BaselineMethod],
) -> Result<CellReport, Failure> {
    let runs = arguments.runs.unwrap_or(cell.full_runs());
    let seeds: Range<u64> = arguments.seed..arguments.seed + runs;
    let mut campaign = cell_campaign(cell, seeds.clone(), methods);
    if let Some(folder) = &arguments.results {
        campaign = campaign.results(kept(folder, cell));
    }
    if let Some(threads) = arguments.threads {
        campaign = campaign.threads(threads);
    }
    let mut progress = SeedProgress::named(&cell.name());
    let outcome = campaign
        .run(
            |seed| cell.evaluate(seed, methods),
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
    Failure::of(
        folder,
        format_args!("the results cannot be kept there: {reason}"),
    )
}

fn cell(name: &str) -> Result<PopulationCell, String> {
    PopulationCell::of_name(name).map_err(|error| error.to_string())
}

fn method(name: &str) -> Result<Asked, String> {
    if name == "none" {
        return Ok(Asked::None);
    }
    let found = BaselineMethod::ALL
        .into_iter()
        .find(|method| method.name() == name);
    found.map(Asked::Method).ok_or_else(|| {
        let known = BaselineMethod::ALL.map(BaselineMethod::name).join(", ");
        format!("expected one of {known}, none")
    })
}

/// The requested methods in their own order.
fn methods(asked: &[Asked]) -> Result<Vec<BaselineMethod>, Failure> {
    let none = asked.contains(&Asked::None);
    if none && asked.iter().any(|asked| *asked != Asked::None) {
        return Err(Failure::Usage(
            "--method none excludes other methods".to_owned(),
        ));
    }
    let is_asked =
        |method: &BaselineMethod| asked.is_empty() || asked.contains(&Asked::Method(*method));
    Ok(BaselineMethod::ALL.into_iter().filter(is_asked).collect())
}

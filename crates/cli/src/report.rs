//! `gyrocal report`: answers as one HTML file.

use std::io::BufRead;
use std::path::{Path, PathBuf};

use clap::{ArgAction, Args};
use gyrocal::generated::MODEL_HASH;
use gyrocal_answer::read_text;
use gyrocal_calibration::UncertaintyBudget;
use gyrocal_design::PlanResult;
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, Gate, RecordUncertainty, UncertaintyResult, diagnose_gated,
    record_uncertainty,
};
use gyrocal_pages::{
    Part, of_budget, of_calibration, of_diagnosis, of_plan, of_result, of_spread, read_sections,
    uncertainty_screen,
};
use gyrocal_record::{Bench, CalibrationReport, InputRole, RecordFile, SourceText, printable_path};
use gyrocal_setup::PlatformKind;
use miette::miette;
use serde::de::DeserializeOwned;

use crate::diagnose::NotDiagnosed;
use crate::outputs::{manifest, manifest_of, refuse_overlap, refuse_unwritable};
use crate::progress::Progress;
use crate::records::refuse_shared_rows;
use crate::{Failure, Reply, layout, page, records};

/// Make a report of records or results: one HTML file that opens in any browser, offline.
///
/// A record (CSV, with --bench) is diagnosed, and its report has all charts. A result (JSON of diagnose,
/// calibrate or plan) needs no computation; its report has no charts over time, for which the record is
/// needed.
#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// Records (CSV) and results (JSON), in the order of the report.
    #[arg(required = true, value_name = "RECORD.csv|RESULT.json")]
    inputs: Vec<PathBuf>,
    /// The bench description (TOML): one for all records, or one for each in their order.
    #[arg(long = "bench", value_name = "BENCH.toml", action = ArgAction::Append)]
    benches: Vec<PathBuf>,
    #[command(flatten)]
    map: records::Map,
    /// Add the uncertainty budget of the coefficients of each record, by its sources; of several records
    /// also the scatter over them: they are runs of one platform.
    #[arg(long)]
    uncertainty: bool,
    /// Write the uncertainty budgets for programs (JSON).
    #[arg(long, value_name = "OUT.json", requires = "uncertainty")]
    json: Option<PathBuf>,
    /// The report to write (HTML).
    #[arg(long, value_name = "OUT.html", default_value = "report.html")]
    out: PathBuf,
}

/// Runs the command.
pub(crate) fn run(arguments: &ReportArguments) -> Result<Reply, Failure> {
    let records = arguments.inputs.iter().filter(|path| !is_result(path));
    let records = records.count();
    let benches = arguments.benches.len();
    if arguments.uncertainty && records == 0 {
        return Err(Failure::Usage(
            "--uncertainty is of records: give the record (CSV) with --bench".to_owned(),
        ));
    }
    if benches != records && !(benches == 1 && records > 0) {
        return Err(Failure::Usage(format!(
            "{benches} of --bench for {records} of records: give --bench once for all records, or once \
             for each in their order"
        )));
    }
    let all = arguments.inputs.iter().chain(&arguments.benches);
    let all = all.map(PathBuf::as_path).chain(arguments.map.path());
    let all: Vec<&Path> = all.collect();
    let json = arguments.json.as_deref();
    refuse_overlap(&all, &[("--out", Some(&arguments.out)), ("--json", json)])?;
    refuse_unwritable(&[Some(&arguments.out), json], None)?;
    let files = arguments.inputs.iter().map(|path| {
        let file = (!is_result(path)).then(|| arguments.map.read(path));
        Ok((path.as_path(), file.transpose()?))
    });
    let files: Vec<(&Path, Option<RecordFile>)> = files.collect::<Result<_, Failure>>()?;
    if arguments.uncertainty {
        let records = files.iter();
        let records = records.filter_map(|(path, file)| Some((*path, file.as_ref()?.record())));
        refuse_shared_rows(&records.collect::<Vec<_>>())?;
    }
    let mut benches = arguments.benches.iter();
    let mut parts = Vec::with_capacity(files.len());
    let mut budgets = Vec::new();
    for (path, file) in &files {
        parts.push(if let Some(file) = file {
            let bench = benches.next().or(arguments.benches.last());
            let bench = bench.map_or(Path::new(""), PathBuf::as_path);
            let (mut part, budget) = of_record(path, file, bench, arguments)?;
            if let Some(budget) = budget {
                part.sections.push(of_budget(&budget.0));
                budgets.push(budget);
            }
            part
        } else {
            of_file(path)?
        });
    }
    let mut answer = Reply::default();
    if arguments.uncertainty {
        let manifest = manifest(MODEL_HASH, DiagnoseOptions::default().seed, &all)?;
        let found = UncertaintyResult::new(manifest, budgets);
        if let (Some(part), Some(spread)) = (parts.last_mut(), &found.spread) {
            part.sections.push(of_spread(spread));
        }
        let sections = found.records.iter().map(of_budget);
        let sections = sections.chain(found.spread.as_ref().map(of_spread));
        let details = layout::layout(&read_sections(&sections.collect::<Vec<_>>()));
        answer = Reply::of(uncertainty_screen(&found), details);
        answer.write_json(json, &found)?;
    }
    page::write(Some(&arguments.out), parts, &mut answer)?;
    Ok(answer)
}

/// Whether a file is a result, which is JSON; what cannot be read is told where it is read.
fn is_result(path: &Path) -> bool {
    let opened = gyrocal_record::open_content(path).ok();
    opened.is_some_and(|mut content| {
        let first = content.fill_buf().unwrap_or_default();
        first.trim_ascii_start().starts_with(b"{")
    })
}

/// Uncertainty of a record, and the budget that it shows.
type Budget = (RecordUncertainty, UncertaintyBudget);

/// The part of a record, with its uncertainty if that is asked for.
fn of_record(
    path: &Path,
    file: &RecordFile,
    bench_path: &Path,
    arguments: &ReportArguments,
) -> Result<(Part, Option<Budget>), Failure> {
    let bench = Bench::read(bench_path)?;
    let options = DiagnoseOptions::default();
    let pair = [(InputRole::Record, path), (InputRole::Bench, bench_path)];
    let inputs: Vec<(InputRole, &Path)> = pair.into_iter().chain(arguments.map.input()).collect();
    let origin = manifest_of(MODEL_HASH, options.seed, &inputs, [&bench])?;
    let _progress = Progress::waiting("diagnosing", file.record().len());
    let gate = Gate::of_file(PlatformKind::Stabilised, file, &bench, &options.calibration)?;
    match diagnose_gated(gate, &bench, &options) {
        Err(DiagnosisError::Setup { mut result }) => {
            if arguments.uncertainty {
                return Err(Failure::Work(miette!(
                    help = "gyrocal diagnose says what is wrong with it",
                    "{}: the set-up is wrong, so that there is no uncertainty",
                    printable_path(path)
                )));
            }
            result.manifest = origin;
            Ok((of_result(&result), None))
        }
        Err(source) => Err(NotDiagnosed::new(path, &bench, source).into()),
        Ok(mut diagnosis) => {
            diagnosis.result.manifest = origin;
            let names = [path, bench_path].map(|path| path.display().to_string());
            let of = || {
                let names = names.each_ref().map(String::as_str);
                record_uncertainty(names, &diagnosis, &bench, &options.calibration)
            };
            let budget = arguments.uncertainty.then(of).transpose();
            let budget = budget.map_err(|source| NotDiagnosed::new(path, &bench, source))?;
            let part = page::part(path, of_diagnosis(&diagnosis))?;
            Ok((part, budget))
        }
    }
}

/// The part of a written result of any command that has one.
fn of_file(path: &Path) -> Result<Part, Failure> {
    let source = SourceText::read(path)?;
    let has = |key: &str| source.text().contains(&format!("\"{key}\""));
    if has("findings") {
        return Ok(of_result(&read_text(&source)?));
    }
    if has("proposals") {
        let plan: PlanResult = read(path, &source, gyrocal_design::SCHEMA_VERSION)?;
        return Ok(of_plan(&plan));
    }
    if has("verdict_text") {
        let report: CalibrationReport =
            read(path, &source, gyrocal_record::CALIBRATION_SCHEMA_VERSION)?;
        return page::part(path, of_calibration(&report, &[]));
    }
    Err(Failure::Work(miette!(
        help =
            "give the file that --json of one of these commands wrote, or the record with --bench",
        "{}: not a result of diagnose, calibrate or plan",
        path.display()
    )))
}

/// The key that results of any version have.
#[derive(serde::Deserialize)]
struct Versioned {
    schema_version: u32,
}

fn read<T: DeserializeOwned>(
    path: &Path,
    source: &SourceText,
    expected: u32,
) -> Result<T, Failure> {
    let failed = |reason: serde_json::Error| {
        Failure::Work(miette!(
            help = "write it again with --json",
            "{}: not a whole result: {reason}",
            path.display()
        ))
    };
    let found: Versioned = serde_json::from_str(source.text()).map_err(failed)?;
    if found.schema_version != expected {
        return Err(Failure::Work(miette!(
            help = "write it again with this version of gyrocal",
            "{}: schema_version {}, expected {expected}, the version of this program",
            path.display(),
            found.schema_version
        )));
    }
    serde_json::from_str(source.text()).map_err(failed)
}

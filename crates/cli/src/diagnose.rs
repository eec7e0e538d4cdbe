//! `gyrocal diagnose`: deviations of a record from the model, and their causes.

mod failed;
mod several;

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_answer::{Answer, Verdict};
use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, FILTER_EFFECT, Gate, TestedFilter, diagnose_watched,
};
use gyrocal_pages::{of_diagnosis, of_result};
use gyrocal_record::{Bench, InputRole};

use crate::numbers::{Choice, one_of, probability};
use crate::outputs::{manifest_of, refuse_itself, write_answer};
use crate::page::{self, Views};
use crate::progress::Progress;
use crate::records::{Given, with_role};
use crate::{Failure, Reply, exit, gyro_axes};
pub use failed::NotDiagnosed;

/// Show what the model gets wrong about a record, and name the cause.
///
/// Says whether the record contradicts the model and with what probability of error, which effects
/// of the catalogue explain it, which effects are indistinguishable and which experiment would
/// distinguish them, the cross-validated gain, and the residual after them. Several records of one platform
/// are diagnosed together, and each alone.
#[derive(Debug, Args)]
pub(crate) struct DiagnoseArguments {
    #[command(flatten)]
    given: Given,
    /// Write the findings as a table: CSV, or Parquet if the name ends in .parquet.
    #[arg(long, value_name = "OUT.csv")]
    findings: Option<PathBuf>,
    /// Write the coefficients of the nominal and of the extended model as such a table.
    #[arg(long, value_name = "OUT.csv")]
    coefficients: Option<PathBuf>,
    /// A later record of the same platform (CSV), to be predicted with the nominal and with the
    /// extended model.
    #[arg(long, value_name = "LATER.csv", requires = "validate_bench")]
    validate: Option<PathBuf>,
    /// Its bench description (TOML); the attitude in it is that of its own first row.
    #[arg(long, value_name = "BENCH.toml", requires = "validate")]
    validate_bench: Option<PathBuf>,
    /// Axes of the instruments at each row of the later record (CSV).
    #[arg(
        long,
        value_name = "AXES.csv",
        requires = "validate",
        requires = "gyro_axes"
    )]
    validate_gyro_axes: Option<PathBuf>,
    #[command(flatten)]
    views: Views,
    /// Also test these effects, which are not in the default set: gyro_xy.axis_misalignment,
    /// gyro_x.magnetic.
    #[arg(long, value_name = "ID,ID", value_delimiter = ',')]
    effects: Vec<String>,
    /// Family-wise false-alarm probability.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
    /// Also test the consistency of this filter.
    #[arg(long, value_parser = one_of(FILTERS), conflicts_with = "gyro_axes")]
    filter: Option<TestedFilter>,
    /// Exit with 3 if effects were found, with 4 if the residuals are unexplained, with 5 if the
    /// set-up is wrong.
    #[arg(long)]
    exit_code: bool,
}

/// Filters that can be tested.
const FILTERS: &[Choice<TestedFilter>] = &[(
    "euler",
    "The paper's: Euler angles as states, one Euler step a sample",
    TestedFilter::Euler,
)];

impl DiagnoseArguments {
    fn options(&self) -> DiagnoseOptions {
        DiagnoseOptions {
            false_alarm_probability: self.false_alarm,
            also: self.effects.clone(),
            filter: self.filter,
            ..DiagnoseOptions::default()
        }
    }

    /// The files that are read.
    fn inputs(&self) -> Vec<(InputRole, &Path)> {
        let later = with_role(InputRole::LaterRecord, &self.validate);
        let bench = with_role(InputRole::LaterBench, &self.validate_bench);
        let axes = with_role(InputRole::LaterGyroAxes, &self.validate_gyro_axes);
        self.given.inputs(later.chain(bench), axes)
    }
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &DiagnoseArguments) -> Result<Reply, Failure> {
    let inputs = checked_inputs(arguments)?;
    let ([record], [bench_path]) = (&arguments.given.records[..], &arguments.given.benches[..])
    else {
        return several::run(arguments, &inputs);
    };
    let bench = Bench::read(bench_path)?;
    let file = arguments.given.map.read(record)?;
    let later = match (&arguments.validate, &arguments.validate_bench) {
        (Some(path), Some(bench)) => {
            Some((path, arguments.given.map.read(path)?, Bench::read(bench)?))
        }
        _ => None,
    };
    let rows = file.record().len();
    tracing::info!(rows, "read");
    let options = arguments.options();
    let failed = |source| NotDiagnosed::new(record, &bench, source);
    let stop = |result| stopped(arguments, result, &inputs, &bench);
    if arguments.filter.is_some() && bench.initial_angles_deg.is_none() {
        return Err(failed(CalibrationError::NoAttitude.into()).into());
    }
    let mut progress = Progress::waiting("diagnosing", rows);
    let kind = arguments.given.kind();
    let gate = |file, bench| Gate::of_file(kind, file, bench, &options.calibration);
    let axes = gyro_axes::read(&arguments.given.gyro_axes, [file.record()])?.pop();
    let checked = gate(&file, &bench)?.with_gyro_axes(axes);
    let mut diagnosis =
        match diagnose_watched(checked, &bench, &options, |stage| progress.at(stage)) {
            Err(DiagnosisError::Setup { result }) => return stop(*result),
            found => found.map_err(failed)?,
        };
    diagnosis.result.manifest = manifest_of(MODEL_HASH, options.seed, &inputs, [&bench])?;
    if let Some((path, later, later_bench)) = &later {
        let failed = |source| NotDiagnosed::new(path, later_bench, source);
        let axes = arguments.validate_gyro_axes.as_slice();
        let axes = gyro_axes::read(axes, [later.record()])?.pop();
        let checked = gate(later, later_bench)?.with_gyro_axes(axes);
        match diagnosis.validate_gated(checked, later_bench, &options) {
            Err(DiagnosisError::Setup { result }) => return stop(*result),
            validated => validated.map_err(failed)?,
        }
    }
    drop(progress);
    let result = &diagnosis.result;
    tracing::info!(verdict = ?result.verdict, "diagnosed");
    let mut answer = Reply::of_answer(result);
    if arguments.views.are_asked() {
        let part = page::part(record, of_diagnosis(&diagnosis))?;
        arguments.views.stage(record, part, &mut answer)?;
    }
    finished(arguments, result, answer)
}

/// The files that are read. Arguments that contradict each other are refused before that.
fn checked_inputs(arguments: &DiagnoseArguments) -> Result<Vec<(InputRole, &Path)>, Failure> {
    arguments.given.check()?;
    let is_unit = !arguments.given.gyro_axes.is_empty();
    if is_unit && arguments.validate.is_some() && arguments.validate_gyro_axes.is_none() {
        return Err(Failure::Usage(
            "--gyro-axes with --validate: give those of the later record, --validate-gyro-axes AXES.csv"
                .to_owned(),
        ));
    }
    let roles = arguments.inputs();
    let inputs: Vec<&Path> = roles.iter().map(|(_, path)| *path).collect();
    let tables = [
        ("--findings", arguments.findings.as_deref()),
        ("--coefficients", arguments.coefficients.as_deref()),
    ];
    arguments.views.check(&inputs, &tables)?;
    let later = arguments.validate.as_deref();
    refuse_itself("--validate", later, &arguments.given.records)?;
    if arguments.effects.iter().any(|id| id == FILTER_EFFECT) {
        return Err(Failure::Usage(format!(
            "{} is an error of a filter and not of the record: --filter euler tests it",
            FILTER_EFFECT
        )));
    }
    Ok(roles)
}

/// The answer of a record whose set-up is wrong: neither pictures nor tables, as the set-up is wrong.
fn stopped(
    arguments: &DiagnoseArguments,
    mut result: Answer,
    inputs: &[(InputRole, &Path)],
    bench: &Bench,
) -> Result<Reply, Failure> {
    result.manifest = manifest_of(MODEL_HASH, result.manifest.seed, inputs, [bench])?;
    let mut answer = Reply::of_answer(&result);
    let (findings, coefficients) = (&arguments.findings, &arguments.coefficients);
    let (part, tables) = (of_result(&result), [findings, coefficients]);
    arguments.views.leave_out(part, tables, &mut answer)?;
    finished(arguments, &result, answer)
}

/// Adds the files for programs that are asked for, and the exit code; of a wrong set-up there are no tables.
fn finished(
    arguments: &DiagnoseArguments,
    result: &Answer,
    mut answer: Reply,
) -> Result<Reply, Failure> {
    write_answer(arguments.views.json(), result, &mut answer)?;
    let tables = [&arguments.findings, &arguments.coefficients];
    let has_tables = result.verdict != Verdict::Setup;
    let [findings, coefficients] = tables.map(|path| path.as_deref().filter(|_| has_tables));
    answer.write(findings, "the findings", |path| {
        Ok(result.finding_table().content(path)?)
    })?;
    answer.write(coefficients, "the coefficients", |path| {
        Ok(result.coefficient_table().content(path)?)
    })?;
    answer.exit_code = match (arguments.exit_code, result.verdict) {
        (true, Verdict::EffectsFound) => exit::FOUND,
        (true, Verdict::Unexplained) => exit::UNEXPLAINED,
        (true, Verdict::Setup) => exit::SETUP,
        (true, Verdict::NotSettled) => exit::NOT_SETTLED,
        _ => exit::DONE,
    };
    Ok(answer)
}

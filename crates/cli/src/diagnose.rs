//! `gyrocal diagnose`: a record and its bench description in, what the model gets wrong out.

mod apart;
mod blind;
mod channels;
mod failed;
mod figures;
mod filter;
mod json;
mod residuals;
mod tables;
mod words;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use gyrocal::Platform;
use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::{CalibrationError, Run};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, Validation, diagnose, validated};
use gyrocal_record::{Bench, DiagnosisReport, DiagnosisVerdict, Outputs, Record};

use crate::numbers::probability;
use crate::outputs::{self, manifest, same_file};
use crate::pictures;
use crate::progress::Progress;
use crate::{Answer, Failure};
pub(crate) use failed::NotDiagnosed;

/// Show what the model gets wrong about a record, and name the cause.
///
/// Says whether anything is wrong and with what probability of error, which effects of the
/// catalogue explain it, which the record cannot tell apart and what would, how much better the
/// model is with them, and what is left.
#[derive(Debug, Args)]
#[command(
    after_help = "Exit codes: 0 the answer was written, whatever it is; 1 an input or the work \
                        failed; 2 the command line is wrong. With --exit-code also 3 effects found, \
                        4 something is left unexplained."
)]
pub(crate) struct DiagnoseArguments {
    /// The record (CSV): time_s,accel_x_g,accel_y_g,accel_z_g and maybe temperature_c.
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    /// The bench description (TOML).
    #[arg(long, value_name = "BENCH.toml")]
    bench: PathBuf,
    /// The result to write for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// A later record of the same platform (CSV), to be predicted with the nominal and with the
    /// extended model.
    #[arg(long, value_name = "LATER.csv", requires = "validate_bench")]
    validate: Option<PathBuf>,
    /// Its bench description (TOML); the attitude in it is that of its own first row.
    #[arg(long, value_name = "BENCH.toml", requires = "validate")]
    validate_bench: Option<PathBuf>,
    #[arg(long, value_name = "DIR", help = pictures::HELP)]
    figures: Option<PathBuf>,
    /// Look for these effects too, beside those of the usual search: gyro_xy.axis_misalignment,
    /// say, or gyro_x.magnetic.
    #[arg(long, value_name = "ID,ID", value_delimiter = ',')]
    effects: Vec<String>,
    /// Probability that a sound record shows anything.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
    /// Judge this filter on the record too.
    #[arg(long, value_enum)]
    filter: Option<Filter>,
    /// Exit with 3 if effects were found and with 4 if something is left unexplained.
    #[arg(long)]
    exit_code: bool,
}

/// A filter that may be judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Filter {
    /// That of the paper: Euler angles as states, one Euler step a sample.
    Euler,
}

/// What there is to tell.
struct Found<'a> {
    path: &'a Path,
    record: &'a Record,
    bench: &'a Bench,
    diagnosis: Diagnosis<'a>,
    /// Of the later record, if there is one and an effect is in the model.
    validation: Option<Validation>,
    /// The later record.
    later: Option<&'a Path>,
    report: DiagnosisReport,
}

/// Runs the command; returns what is to be said on stdout.
pub(crate) fn run(arguments: &DiagnoseArguments) -> Result<Answer, Failure> {
    let inputs: Vec<&Path> = [&arguments.record, &arguments.bench]
        .into_iter()
        .chain(&arguments.validate)
        .chain(&arguments.validate_bench)
        .map(PathBuf::as_path)
        .collect();
    outputs::check(
        &inputs,
        arguments.json.as_deref(),
        arguments.figures.as_deref(),
    )?;
    if let Some(later) = &arguments.validate
        && same_file(later, &arguments.record)
    {
        return Err(Failure::Usage(format!(
            "--validate {} is the record itself: a later one has had no part in the models",
            later.display()
        )));
    }
    if arguments.effects.iter().any(|id| id == filter::EFFECT) {
        return Err(Failure::Usage(format!(
            "{} is an error of a filter and not of the record: it is looked for with --filter euler",
            filter::EFFECT
        )));
    }
    let bench = Bench::read(&arguments.bench)?;
    let record = Record::read_at_least(&arguments.record, Platform::STATES)?;
    let later = match (&arguments.validate, &arguments.validate_bench) {
        (Some(path), Some(bench)) => Some((
            path.as_path(),
            Record::read_at_least(path, Platform::STATES)?,
            Bench::read(bench)?,
        )),
        _ => None,
    };
    tracing::info!(rows = record.len(), "read");
    let options = DiagnoseOptions {
        false_alarm_probability: arguments.false_alarm,
        also: arguments.effects.clone(),
        ..DiagnoseOptions::default()
    };
    let failed = |source| NotDiagnosed::new(&arguments.record, &bench, source);
    if arguments.filter.is_some() && bench.initial_angles_deg.is_none() {
        return Err(failed(CalibrationError::NoAttitude.into()).into());
    }
    let progress = Progress::waiting("diagnosing", record.len());
    let diagnosis = diagnose(&record, &bench, &options).map_err(failed)?;
    let judged = match arguments.filter {
        Some(Filter::Euler) => {
            Some(filter::judge(&record, &bench).map_err(|source| failed(source.into()))?)
        }
        None => None,
    };
    let validation = match &later {
        Some((path, later, later_bench)) => {
            let failed = |source| NotDiagnosed::new(path, later_bench, source);
            let [first, later] = [(&record, &bench), (later, later_bench)]
                .map(|(record, bench)| Run { record, bench });
            validated(&diagnosis, &first, &later, &options).map_err(failed)?
        }
        None => None,
    };
    drop(progress);
    tracing::info!(verdict = ?diagnosis.verdict, "diagnosed");
    let blind = blind::blind(&diagnosis, &record).map_err(|source| failed(source.into()))?;
    let shown = residuals::report(&diagnosis, &record).map_err(failed)?;
    let report = json::report(
        &diagnosis,
        validation.as_ref(),
        judged,
        blind,
        &bench,
        shown,
        manifest(MODEL_HASH, options.seed, &inputs)?,
    );
    let found = Found {
        path: &arguments.record,
        record: &record,
        bench: &bench,
        diagnosis,
        validation,
        later: later.as_ref().map(|(path, ..)| *path),
        report,
    };
    let mut text = words::summary(&found);
    let mut outputs = Outputs::new();
    if let Some(folder) = &arguments.figures {
        text.push_str(&figures::stage(&found, folder, &mut outputs)?);
    }
    if let Some(path) = &arguments.json {
        outputs.stage_json(path, &found.report)?;
        text.push_str(&format!("\n{}: the result for programs\n", path.display()));
    }
    outputs.commit()?;
    Ok(Answer {
        text,
        exit_code: match (arguments.exit_code, found.report.verdict) {
            (true, DiagnosisVerdict::EffectsFound) => 3,
            (true, DiagnosisVerdict::Unexplained) => 4,
            _ => 0,
        },
    })
}

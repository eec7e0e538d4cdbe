//! `gyrocal calibrate`: nine drift coefficients from records and their bench descriptions.

mod failed;
mod inputs;
mod over_time;

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::{GyroAxes, Options, Run};
use gyrocal_diagnosis::{
    CalibrationRequest, CalibrationStep, DiagnoseOptions, calibrate_and_diagnose, fit_effects,
};
use gyrocal_pages::of_calibration;
use gyrocal_record::{
    CalibrationMethod, CalibrationReport, FittedEffects, InputRole, Manifest, printable_path,
};
use miette::miette;

use crate::numbers::positive;
use crate::outputs::manifest_of;
use crate::page::{self, Views};
use crate::progress::Progress;
use crate::records::{Given, with_role};
use crate::{Failure, Reply, exit, gyro_axes};
pub use failed::NotCalibrated;
use failed::WrongSetup;
use inputs::Measurement;

/// Estimate the nine drift coefficients from one record or several.
///
/// Prints each coefficient with its standard deviation, the consistency test of the innovations, what the
/// diagnosis of each record names (of more than 10 000 rows that are not white, that of their means), unobservable
/// combinations of coefficients, the estimated noise, and the sensitivity to errors of latitude,
/// Earth rate and gravity.
///
/// White rows that come faster than anything moves are read as means of blocks, which loses a thousandth of their
/// information at most; the record line tells it.
///
/// Several records are several turn-ons of one platform, each with its own initial attitude and
/// clock.
#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    #[command(flatten)]
    given: Given,
    /// Write the coefficients as a table: CSV, or Parquet if the name ends in .parquet.
    #[arg(long, value_name = "OUT.csv")]
    coefficients: Option<PathBuf>,
    #[command(flatten)]
    views: Views,
    /// Average over intervals of this length, 600 s at most, also rows whose noise is not white.
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with = "gyro_axes")]
    average: Option<f64>,
    /// Reduce the weight of values whose residual exceeds this many sigmas of the noise (Huber); 3 if
    /// no number is given.
    #[arg(long, value_name = "SIGMAS", num_args = 0..=1, default_missing_value = "3",
          value_parser = sigmas)]
    robust: Option<f64>,
    /// Do not estimate the noise.
    #[arg(long)]
    no_noise: bool,
    /// Use the streaming filter that a controller embeds, instead of the batch estimator.
    #[arg(long, conflicts_with = "gyro_axes")]
    streaming: bool,
    /// Use the paper's filter: Euler angles as states, one Euler step a sample. It is consistent
    /// only with records simulated by the same rule.
    #[arg(long, conflicts_with_all = ["streaming", "gyro_axes"])]
    paper: bool,
    /// Estimate the coefficients with these effects of the catalogue in the model too, and print them beside
    /// the nominal ones; for one record.
    #[arg(long, value_name = "EFFECT,EFFECT", value_delimiter = ',',
          conflicts_with_all = ["streaming", "paper"])]
    with: Vec<String>,
    /// Carry the filter's covariance as factors: slower, for very wide priors; with --streaming or
    /// --paper.
    #[arg(long)]
    factorised: bool,
}

impl CalibrateArguments {
    fn method(&self) -> CalibrationMethod {
        match (self.streaming, self.paper) {
            (true, _) => CalibrationMethod::Streaming,
            (_, true) => CalibrationMethod::Paper,
            _ => CalibrationMethod::Batch,
        }
    }

    /// Whether rows that come faster than anything moves are averaged: filters read rows, `--robust` bounds the
    /// influence of each.
    fn takes_blocks(&self) -> bool {
        let is_batch = self.method() == CalibrationMethod::Batch;
        is_batch && self.robust.is_none() && self.given.gyro_axes.is_empty()
    }

    fn options(&self) -> Options {
        let options = match self.method() {
            CalibrationMethod::Streaming => Options::streaming(),
            CalibrationMethod::Paper => Options::paper_baseline(),
            _ => Options::default(),
        };
        Options {
            factorised: self.factorised,
            noise: self.method() == CalibrationMethod::Batch && !self.no_noise,
            outlier_bound: self.robust,
            ..options
        }
    }

    /// The files that are read.
    fn inputs(&self) -> Vec<(InputRole, &Path)> {
        let mut all: Vec<_> = with_role(InputRole::Record, &self.given.records).collect();
        all.extend(with_role(InputRole::Bench, &self.given.benches));
        all.extend(with_role(InputRole::GyroAxes, &self.given.gyro_axes));
        all.extend(self.given.map.input());
        all
    }

    /// Checks what clap cannot express.
    fn check(&self) -> Result<(), Failure> {
        let usage = |message: String| Err(Failure::Usage(message));
        let records = self.given.records.len();
        self.given.check()?;
        if !self.with.is_empty() && records > 1 {
            return usage(format!(
                "--with goes with one record, {records} are given: calibrate them one by one"
            ));
        }
        let filter = match self.method() {
            CalibrationMethod::Batch if self.factorised => {
                return usage(
                    "--factorised is a form of the filter: it goes with --streaming or --paper"
                        .to_owned(),
                );
            }
            CalibrationMethod::Batch => return Ok(()),
            CalibrationMethod::Paper => "--paper",
            _ => "--streaming",
        };
        if records > 1 {
            return usage(format!(
                "{filter} reads one record, {records} are given: leave it out, or calibrate them \
                 one by one"
            ));
        }
        if self.robust.is_some() {
            return usage(format!(
                "--robust goes with the batch estimator, not with {filter}"
            ));
        }
        if self.no_noise {
            return usage(format!(
                "--no-noise goes with the batch estimator; {filter} does not estimate the noise"
            ));
        }
        Ok(())
    }
}

/// Share of the time of a calibration that has passed after the fit.
const FITTED: f64 = 0.5;

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &CalibrateArguments) -> Result<Reply, Failure> {
    arguments.check()?;
    let inputs = arguments.inputs();
    let paths: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    let (views, table) = (&arguments.views, arguments.coefficients.as_deref());
    views.check(&paths, &[("--coefficients", table)])?;
    let measurements = inputs::read(arguments)?;
    let benches = measurements.iter().map(|one| &one.bench);
    let manifest = manifest_of(MODEL_HASH, 0, &inputs, benches)?;
    if measurements.iter().any(|measurement| measurement.stops) {
        return Err(stopped(arguments, &measurements, manifest)?.into());
    }
    let rows = measurements.iter().map(|m| m.record.len()).sum();
    tracing::info!(records = measurements.len(), rows, "read");
    let options = arguments.options();
    let records = measurements.iter().map(|measurement| &measurement.record);
    let gyro_axes = gyro_axes::read(&arguments.given.gyro_axes, records)?;
    let runs: Vec<Run<'_>> = measurements.iter().map(Measurement::run).collect();
    // First, as it refuses effects that cannot be fitted.
    let with_effects = with_effects(arguments, &runs, gyro_axes.first())?;
    let (method, names) = (arguments.method(), arguments.given.records.iter());
    let names: Vec<String> = names.map(|path| printable_path(path)).collect();
    let mut progress = match method {
        // The number of passes is not known beforehand.
        CalibrationMethod::Batch => Progress::waiting("calibrating", rows),
        _ => Progress::new("calibrating", rows),
    };
    let request = CalibrationRequest {
        method,
        options,
        records: measurements.iter().map(Measurement::calibrated).collect(),
        axes: &gyro_axes,
        with_effects,
        manifest,
    };
    let report = calibrate_and_diagnose(request, |step| match step {
        CalibrationStep::Row(row) => progress.reach(row),
        CalibrationStep::Fitted(fitted) => {
            tracing::info!(fit = ?fitted.fit, iterations = fitted.iterations, "calibrated");
            progress.stage("diagnosis", FITTED);
        }
        CalibrationStep::NotDiagnosed(path, error) => {
            tracing::warn!(%error, %path, "not diagnosed");
        }
        CalibrationStep::FirstNotAlone(error) => {
            tracing::warn!(%error, "the first record alone could not be calibrated");
        }
    });
    drop(progress);
    let report = report.map_err(|source| {
        NotCalibrated::new(&names, &runs, method, arguments.factorised, source)
    })?;
    let mut answer = Reply::of_part(&page::part(
        arguments.given.first(),
        of_calibration(&report, &[]),
    )?);
    if views.are_asked() {
        let record = arguments.given.first();
        let part = over_time::part(record, &report, &measurements, (&gyro_axes, &options))?;
        views.stage(record, part, &mut answer)?;
    }
    answer.write(table, "the coefficients", |path| {
        Ok(report.coefficient_table().content(path)?)
    })?;
    answer.write_json(views.json(), &report)?;
    // Coefficients that mean nothing are no result.
    if !report.usable {
        answer.exit_code = exit::FAILED;
    }
    Ok(answer)
}

/// Writes the result of records whose set-up is wrong; the failure that tells it.
fn stopped(
    arguments: &CalibrateArguments,
    measurements: &[Measurement],
    manifest: Manifest,
) -> Result<WrongSetup, Failure> {
    let problems = measurements.iter().flat_map(|one| &one.setup);
    let problems = problems.cloned().collect();
    let report = CalibrationReport::of_wrong_setup(manifest, arguments.method(), problems);
    let mut written = Reply::default();
    let views = &arguments.views;
    let part = page::part(arguments.given.first(), of_calibration(&report, &[]))?;
    views.leave_out(part, [&arguments.coefficients], &mut written)?;
    written.write_json(views.json(), &report)?;
    let written = written.committed()?.written;
    Ok(WrongSetup::new(&report, &written))
}

/// The coefficients of the first record with the effects of `--with`; `None` without such.
fn with_effects(
    arguments: &CalibrateArguments,
    runs: &[Run<'_>],
    axes: Option<&GyroAxes>,
) -> Result<Option<FittedEffects>, Failure> {
    let Some(run) = runs.first().filter(|_| !arguments.with.is_empty()) else {
        return Ok(None);
    };
    fit_effects(run, axes, &arguments.with, &DiagnoseOptions::default())
        .map(Some)
        .map_err(|error| {
            let given = arguments.with.join(",");
            Failure::Work(miette!(
                help = "`gyrocal diagnose` finds which effects the record shows",
                "--with {given}: {error}"
            ))
        })
}

fn sigmas(text: &str) -> Result<f64, String> {
    positive(text)
        .map_err(|expected| format!("{expected}; put records before --robust, or write --robust=3"))
}

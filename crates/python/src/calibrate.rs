//! Calibration from records.

use std::borrow::Cow;

use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::{GyroAxes, Options, Run, shared_rows};
use gyrocal_cli::NotCalibrated;
use gyrocal_diagnosis::{
    Blocks, CalibratedRecord, CalibrationRequest, CalibrationStep, DiagnoseOptions, Gate,
    calibrate_and_diagnose, fit_effects,
};
use gyrocal_record::{
    AveragedReport, Bench, CalibrationMethod, CalibrationReport, FittedEffects, InputRole,
    Manifest, Record, SetupProblem,
};
use pyo3::prelude::*;

use crate::axes::{Axes, GivenAxes};
use crate::bench::HeldBench;
use crate::diagnose::{Given, of_effects};
use crate::error::{Class, Failure, Outcome};
use crate::job;
use crate::origin::{json, manifest};
use crate::record::HeldRecord;

/// What is asked of a calibration.
struct Request {
    method: CalibrationMethod,
    factorised: bool,
    noise: bool,
    average_s: Option<f64>,
    robust_sigmas: Option<f64>,
    effects: Vec<String>,
}

impl Request {
    /// Whether rows that come faster than anything moves are averaged: filters read rows, and the bound on outliers
    /// is that of each.
    fn takes_blocks(&self) -> bool {
        self.method == CalibrationMethod::Batch && self.robust_sigmas.is_none()
    }

    fn options(&self) -> Options {
        let options = match self.method {
            CalibrationMethod::Streaming => Options::streaming(),
            CalibrationMethod::Paper => Options::paper_baseline(),
            _ => Options::default(),
        };
        Options {
            factorised: self.factorised,
            noise: self.method == CalibrationMethod::Batch && self.noise,
            outlier_bound: self.robust_sigmas,
            ..options
        }
    }
}

/// The result (JSON), and the logarithm of the likelihood of the records, which it does not hold.
type Calibrated = (String, Option<f64>);

/// Estimates the coefficients.
#[pyfunction]
#[pyo3(signature = (runs, axes, method, factorised, noise, average_s, robust_sigmas, effects, command))]
#[expect(
    clippy::too_many_arguments,
    reason = "the module in Python calls it, with defaults"
)]
pub(crate) fn calibrate(
    py: Python<'_>,
    runs: Vec<(Bound<'_, HeldRecord>, Bound<'_, HeldBench>)>,
    axes: Vec<(String, GivenAxes<'_>)>,
    method: &str,
    factorised: bool,
    noise: bool,
    average_s: Option<f64>,
    robust_sigmas: Option<f64>,
    effects: Vec<String>,
    command: &str,
) -> PyResult<Calibrated> {
    let axes = axes.iter().map(|(name, axes)| axes.take(name));
    let axes: Vec<Axes> = axes.collect::<Outcome<_>>()?;
    let given: Vec<Given<'_>> = runs
        .iter()
        .enumerate()
        .map(|(index, (record, bench))| Given {
            record: record.get(),
            bench: bench.get(),
            axes: axes.get(index),
        })
        .collect();
    let request = Request {
        method: method_of(method)?,
        factorised,
        noise,
        average_s,
        robust_sigmas,
        effects,
    };
    job::run(py, || {
        let (report, log_likelihood) = report(&given, &request, command)?;
        Ok((json(&report)?, log_likelihood))
    })
}

fn method_of(name: &str) -> Outcome<CalibrationMethod> {
    Ok(match name {
        "batch" => CalibrationMethod::Batch,
        "streaming" => CalibrationMethod::Streaming,
        "paper" => CalibrationMethod::Paper,
        other => {
            let found = format!("`{other}`");
            return Err(Failure::of_value(
                "method",
                found,
                "batch, streaming or paper",
                "",
            ));
        }
    })
}

/// A record without what gross errors of its set-up spoilt, averaged if that is asked for.
struct Sound<'a> {
    given: Given<'a>,
    record: Cow<'a, Record>,
    bench: Cow<'a, Bench>,
    /// Rows before averaging.
    rows: usize,
    averaged: Option<AveragedReport>,
    /// Record and bench description before fast rows became means of blocks.
    before: Option<(Cow<'a, Record>, Cow<'a, Bench>)>,
    setup: Vec<SetupProblem>,
}

fn report(
    given: &[Given<'_>],
    request: &Request,
    command: &str,
) -> Outcome<(CalibrationReport, Option<f64>)> {
    refuse_differing(given)?;
    let manifest = origin(given, command)?;
    let sound = sound(given, request, &manifest)?;
    let runs: Vec<Run<'_>> = sound.iter().map(Sound::run).collect();
    let axes = gyro_axes(&sound)?;
    let with_effects = with_effects(request, &runs, axes.first())?;
    let names: Vec<String> = given
        .iter()
        .map(|one| one.record.input.path.clone())
        .collect();
    let asked = CalibrationRequest {
        method: request.method,
        options: request.options(),
        records: sound.iter().map(Sound::calibrated).collect(),
        axes: &axes,
        with_effects,
        manifest,
    };
    let mut log_likelihood = None;
    let report = calibrate_and_diagnose(asked, |step| {
        if let CalibrationStep::Fitted(fitted) = step {
            log_likelihood = Some(fitted.fit.log_likelihood());
        }
    });
    let report = report.map_err(|source| {
        let (method, factorised) = (request.method, request.factorised);
        Failure::of_work(&NotCalibrated::new(
            &names, &runs, method, factorised, source,
        ))
    })?;
    Ok((report, log_likelihood))
}

/// Inputs in the order of the command: all records, then each bench description once, then the axes.
fn origin(given: &[Given<'_>], command: &str) -> Outcome<Manifest> {
    let records = given.iter().map(|one| one.record.input.clone());
    let mut inputs: Vec<_> = records
        .map(|input| input.with_role(InputRole::Record))
        .collect();
    let one_bench = given
        .windows(2)
        .all(|pair| pair[0].bench.input == pair[1].bench.input);
    let benches = given.iter().map(|one| one.bench.input.clone());
    let benches = benches.map(|input| input.with_role(InputRole::Bench));
    inputs.extend(benches.take(if one_bench { 1 } else { given.len() }));
    for axes in given.iter().filter_map(|one| one.axes) {
        inputs.push(axes.input()?.with_role(InputRole::GyroAxes));
    }
    Ok(manifest(MODEL_HASH, 0, inputs, command))
}

/// Axes of the instruments in each record, of a strapdown unit.
fn gyro_axes(sound: &[Sound<'_>]) -> Outcome<Vec<GyroAxes>> {
    let given = sound.iter().filter_map(|one| Some((one, one.given.axes?)));
    given.map(|(one, axes)| axes.of(&one.record)).collect()
}

impl<'a> Sound<'a> {
    fn run(&self) -> Run<'_> {
        Run {
            record: &self.record,
            bench: &self.bench,
        }
    }

    fn calibrated(&self) -> CalibratedRecord<'_> {
        CalibratedRecord {
            name: self.given.record.input.path.clone(),
            bench_name: self.given.bench.input.path.clone(),
            run: self.run(),
            diagnosed: match &self.before {
                Some((record, bench)) => Run { record, bench },
                None => self.run(),
            },
            rows: self.rows,
            averaged: self.averaged,
            setup: &self.setup,
        }
    }

    /// Takes means in the place of rows: over intervals that are asked for, or of blocks where rows come faster than
    /// anything moves.
    fn averaged(self, request: &Request) -> Outcome<Self> {
        let blocks =
            match request.average_s {
                Some(interval_s) => Some(Blocks::every(&self.run(), interval_s).map_err(
                    |error| Failure {
                        message: format!("{}: {error}", self.given.record.input.path),
                        advice: Some("choose average_s between these, or leave it out".to_owned()),
                        ..Failure::default()
                    },
                )?),
                None if request.takes_blocks() && self.given.axes.is_none() => {
                    Blocks::of(&self.run(), None)
                }
                None => None,
            };
        Ok(match blocks {
            Some(blocks) => Self {
                averaged: Some(blocks.report),
                bench: Cow::Owned(blocks.bench),
                record: Cow::Owned(blocks.record),
                before: request
                    .average_s
                    .is_none()
                    .then_some((self.record, self.bench)),
                ..self
            },
            None => self,
        })
    }
}

/// The records without what gross errors of the set-ups spoilt.
fn sound<'a>(
    given: &[Given<'a>],
    request: &Request,
    manifest: &Manifest,
) -> Outcome<Vec<Sound<'a>>> {
    let mut problems = Vec::new();
    let mut sound = Vec::with_capacity(given.len());
    for one in given {
        let gate: Gate<'a> = one.gate(&DiagnoseOptions::default())?;
        problems.extend(gate.problems.iter().cloned());
        if let Some(record) = gate.usable {
            sound.push(Sound {
                given: *one,
                rows: record.len(),
                record,
                bench: Cow::Borrowed(&one.bench.bench),
                averaged: None,
                before: None,
                setup: gate.problems,
            });
        }
    }
    if sound.len() < given.len() {
        let manifest = manifest.clone();
        let report = CalibrationReport::of_wrong_setup(manifest, request.method, problems);
        return Err(Failure {
            class: Class::Setup,
            message: report.verdict_text.clone(),
            code: Some("gyrocal::calibrate::setup".to_owned()),
            advice: Some("mend the record or its bench description".to_owned()),
            result: Some(json(&report)?),
            ..Failure::default()
        });
    }
    refuse_shared_rows(&sound)?;
    let sound = sound.into_iter();
    sound.map(|one| one.averaged(request)).collect()
}

/// Refuses benches with different priors, as the coefficients are shared, and with different
/// uncertainties of one site.
fn refuse_differing(given: &[Given<'_>]) -> Outcome<()> {
    for (index, one) in given.iter().enumerate() {
        for earlier in &given[..index] {
            let (bench, other) = (&one.bench.bench, &earlier.bench.bench);
            let (name, other_name) = (&one.bench.input.path, &earlier.bench.input.path);
            let same = format!("the same as in {other_name}");
            if bench.prior != other.prior {
                return Err(Failure::of_value(
                    name,
                    "another [prior]",
                    same,
                    "the coefficients are those of one platform: give [prior] the same values",
                ));
            }
            let site = |bench: &Bench| (bench.latitude_deg, bench.gravity);
            if site(bench) == site(other) && bench.uncertainty != other.uncertainty {
                return Err(Failure::of_value(
                    name,
                    "other uncertainties of the same site",
                    same,
                    "both give the same latitude and gravity: give them the same sigmas",
                ));
            }
        }
    }
    Ok(())
}

fn refuse_shared_rows(sound: &[Sound<'_>]) -> Outcome<()> {
    for (index, one) in sound.iter().enumerate() {
        for earlier in &sound[..index] {
            let Some(shared) = shared_rows(&earlier.record, &one.record) else {
                continue;
            };
            let name = |sound: &Sound<'_>| sound.given.record.input.path.clone();
            return Err(Failure::of_value(
                &name(one),
                format!(
                    "{} consecutive rows that {} has too, from row {} on",
                    shared.rows,
                    name(earlier),
                    shared.first
                ),
                "rows of its own: they would count twice",
                "leave one of them out, or cut the rows that both have from one",
            ));
        }
    }
    Ok(())
}

/// The coefficients of the first record with the effects asked for; `None` without such.
fn with_effects(
    request: &Request,
    runs: &[Run<'_>],
    axes: Option<&GyroAxes>,
) -> Outcome<Option<FittedEffects>> {
    let Some(run) = runs.first().filter(|_| !request.effects.is_empty()) else {
        return Ok(None);
    };
    if runs.len() > 1 {
        return Err(Failure::of_value(
            "effects",
            format!("{} records", runs.len()),
            "one record",
            "calibrate the records one by one",
        ));
    }
    let fitted = fit_effects(run, axes, &request.effects, &DiagnoseOptions::default());
    fitted.map(Some).map_err(|error| {
        of_effects(&error).unwrap_or_else(|| Failure::of_text(&format!("effects: {error}")))
    })
}

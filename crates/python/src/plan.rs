//! The next run for a record.

use gyrocal::generated::MODEL_HASH;
use gyrocal_answer::Answer;
use gyrocal_calibration::Run;
use gyrocal_cli::NotPlanned;
use gyrocal_design::{Aim, DesignError, Goal, Known, NotKnown, PlanOptions, plan as design};
use gyrocal_diagnosis::{RecordToDiagnose, diagnose_gated};
use gyrocal_record::{AXES, GimbalLimits, InputRole, SourceText};
use pyo3::prelude::*;

use crate::axes::{Axes, GivenAxes};
use crate::bench::HeldBench;
use crate::diagnose::{Given, options};
use crate::error::{Failure, Outcome};
use crate::job;
use crate::origin::{json, manifest};
use crate::record::HeldRecord;

/// What is asked of a plan.
struct Request {
    /// A diagnosis of the record (JSON).
    diagnosis: Option<String>,
    effects: Vec<String>,
    false_alarm: f64,
    options: PlanOptions,
}

/// Plans the next run.
#[pyfunction]
#[pyo3(signature = (record, bench, axes, diagnosis, hours, limits_deg, aim, sigmas, one_name, effects, false_alarm, command))]
#[expect(
    clippy::too_many_arguments,
    reason = "the module in Python calls it, with defaults"
)]
pub(crate) fn plan(
    py: Python<'_>,
    record: &Bound<'_, HeldRecord>,
    bench: &Bound<'_, HeldBench>,
    axes: Option<GivenAxes<'_>>,
    diagnosis: Option<String>,
    hours: Vec<f64>,
    limits_deg: Vec<(String, [f64; 2])>,
    aim: Option<&str>,
    sigmas: Vec<(String, f64)>,
    one_name: bool,
    effects: Vec<String>,
    false_alarm: f64,
    command: &str,
) -> PyResult<String> {
    let axes = axes.map(|axes| axes.take("gyro_axes")).transpose()?;
    let given = Given {
        record: record.get(),
        bench: bench.get(),
        axes: axes.as_ref(),
    };
    let request = Request {
        diagnosis,
        effects,
        false_alarm,
        options: PlanOptions {
            durations_s: durations_s(&hours)?,
            limits: limits(&limits_deg, given.bench.bench.gimbal_limits)?,
            aim: aim.map(aim_of).transpose()?,
            goal: Goal { sigmas, one_name },
            ..PlanOptions::default()
        },
    };
    job::run(py, || answer(given, &request, command))
}

fn answer(given: Given<'_>, request: &Request, command: &str) -> Outcome<String> {
    let known = match &request.diagnosis {
        Some(diagnosis) => written(given, diagnosis)?,
        None => made(given, request)?,
    };
    let run = Run {
        record: &known.record,
        bench: &known.bench,
    };
    let options = &request.options;
    let mut planned = design(&known.fitted, &run, &known.named, options)
        .map_err(|source| no_plan(given, source))?;
    planned.record = known.summary;
    planned.setup.clone_from(&known.setup);
    let mut inputs = vec![
        given.record.input.clone().with_role(InputRole::Record),
        given.bench.input.clone().with_role(InputRole::Bench),
    ];
    let axes = given.axes.map(Axes::input).transpose()?;
    inputs.extend(axes.map(|axes| axes.with_role(InputRole::GyroAxes)));
    planned.manifest = manifest(MODEL_HASH, options.seed, inputs, command);
    json(&planned)
}

fn no_plan(given: Given<'_>, source: DesignError) -> Failure {
    Failure::of_work(&NotPlanned::new(&[&given.record.input.path], source))
}

/// Diagnoses the record.
fn made<'a>(given: Given<'a>, request: &Request) -> Outcome<Known<'a>> {
    let options = options(request.effects.clone(), request.false_alarm, false)?;
    let found = diagnose_gated(
        given.gate_with_axes(&options)?,
        &given.bench.bench,
        &options,
    )
    .map_err(|source| given.no_diagnosis(source))?;
    Ok(found.into())
}

/// Takes a diagnosis of the record.
fn written<'a>(given: Given<'a>, diagnosis: &str) -> Outcome<Known<'a>> {
    let source = SourceText::new(diagnosis, "diagnosis")?;
    let diagnosis = gyrocal_answer::read_platform_text(&source)?;
    refuse(given, &diagnosis)?;
    check_inputs(given, &diagnosis)?;
    let options = options(Vec::new(), diagnosis.false_alarm_probability, false)?;
    let record = RecordToDiagnose {
        name: given.record.input.path.clone(),
        gate: given.gate_with_axes(&options)?,
        bench: &given.bench.bench,
    };
    Known::written(&diagnosis, vec![record]).map_err(|error| match error {
        NotKnown::Record(source) => given.no_diagnosis(source),
        NotKnown::Fit(source) => no_plan(given, source),
    })
}

/// Refuses a diagnosis of several records, and one with axes where none are given, or without.
fn refuse(given: Given<'_>, diagnosis: &Answer) -> Outcome<()> {
    if !diagnosis.records.is_empty() {
        return Err(Failure::of_value(
            "diagnosis",
            format!("that of {} records", diagnosis.records.len()),
            "that of one",
            "the command plans after several: gyrocal plan --diagnosis",
        ));
    }
    match (diagnosis.is_strapdown(), given.axes) {
        (true, None) => Err(Failure::of_value(
            "diagnosis",
            "that of a strapdown unit, with gyro_axes",
            "that of a stabilised platform, as no gyro_axes are given",
            "give the gyro_axes of the record",
        )),
        (false, Some(_)) => Err(Failure::of_value(
            "diagnosis",
            "that of a stabilised platform, without gyro_axes",
            "that of a strapdown unit, as gyro_axes are given",
            "leave gyro_axes out, or diagnose with them",
        )),
        _ => Ok(()),
    }
}

/// A diagnosis is of the record, the bench description and the axes that are given.
fn check_inputs(given: Given<'_>, diagnosis: &Answer) -> Outcome<()> {
    let inputs = &diagnosis.manifest.inputs;
    let mut pairs = vec![
        (given.record.input.clone(), inputs.first()),
        (given.bench.input.clone(), inputs.get(1)),
    ];
    if let Some(axes) = given.axes {
        pairs.push((axes.input()?, diagnosis.axes_inputs().first()));
    }
    for (expected, found) in pairs {
        if found.is_none_or(|found| found.sha256 != expected.sha256) {
            return Err(Failure::of_value(
                "diagnosis",
                found.map_or("no input", |found| found.path.as_str()),
                format!("{}, with SHA-256 {}", expected.path, expected.sha256),
                "diagnose this record with this bench description and these axes, from a file or from memory \
                 as here, or leave diagnosis out",
            ));
        }
    }
    Ok(())
}

/// Each duration once, in the order given.
fn durations_s(hours: &[f64]) -> Outcome<Vec<f64>> {
    let mut durations_s: Vec<f64> = Vec::with_capacity(hours.len());
    for hours in hours {
        if !(*hours > 0.0 && hours.is_finite()) {
            let found = format!("{hours}");
            return Err(Failure::of_value("hours", found, "a positive number", ""));
        }
        let duration_s = 3600.0 * hours;
        if !durations_s.contains(&duration_s) {
            durations_s.push(duration_s);
        }
    }
    Ok(durations_s)
}

/// Limits that are given, then those of the bench.
fn limits(given: &[(String, [f64; 2])], of_bench: GimbalLimits) -> Outcome<GimbalLimits> {
    let mut limits = of_bench;
    for (axis, ends) in given {
        let place = AXES.iter().position(|key| key == axis);
        match place.filter(|_| GimbalLimits::is_sound(*ends)) {
            Some(place) => limits.deg[place] = Some(*ends),
            None => {
                return Err(Failure::of_value(
                    "limits_deg",
                    format!("{axis}: {ends:?}"),
                    format!("x, y or z with {}", GimbalLimits::EXPECTED),
                    "",
                ));
            }
        }
    }
    Ok(limits)
}

fn aim_of(name: &str) -> Outcome<Aim> {
    match name {
        "set" => Ok(Aim::Set),
        "sigmas" => Ok(Aim::Sigmas),
        other => Err(Failure::of_value(
            "aim",
            format!("`{other}`"),
            "set or sigmas",
            "",
        )),
    }
}

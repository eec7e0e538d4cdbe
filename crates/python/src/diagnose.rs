//! Diagnosis of a record.

use gyrocal::generated::MODEL_HASH;
use gyrocal_answer::Answer;
use gyrocal_calibration::CalibrationError;
use gyrocal_cli::NotDiagnosed;
use gyrocal_diagnosis::{
    DiagnoseOptions, Diagnosis, DiagnosisError, FILTER_EFFECT, Gate, TestedFilter, diagnose_gated,
};
use gyrocal_record::InputRole;
use gyrocal_setup::PlatformKind;
use pyo3::prelude::*;

use crate::axes::{Axes, GivenAxes};
use crate::bench::HeldBench;
use crate::error::{Failure, Outcome};
use crate::job;
use crate::origin::{answer_text, manifest};
use crate::record::HeldRecord;

/// A record with its bench description.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) record: &'a HeldRecord,
    pub(crate) bench: &'a HeldBench,
    /// Axes of the instruments, of a strapdown unit.
    pub(crate) axes: Option<&'a Axes>,
}

impl<'a> Given<'a> {
    /// The check of the set-up.
    pub(crate) fn gate(&self, options: &DiagnoseOptions) -> Outcome<Gate<'a>> {
        let kind = match self.axes {
            None => PlatformKind::Stabilised,
            Some(_) => PlatformKind::Computed,
        };
        let bench = &self.bench.bench;
        Ok(Gate::of_file(
            kind,
            &self.record.file,
            bench,
            &options.calibration,
        )?)
    }

    /// The same with the axes of the instruments.
    pub(crate) fn gate_with_axes(&self, options: &DiagnoseOptions) -> Outcome<Gate<'a>> {
        let axes = self.axes.map(|axes| axes.of(self.record.file.record()));
        Ok(self.gate(options)?.with_gyro_axes(axes.transpose()?))
    }

    pub(crate) fn no_diagnosis(&self, source: DiagnosisError) -> Failure {
        if let Some(failure) = of_effects(&source) {
            return failure;
        }
        let path = self.record.input.path.as_ref();
        Failure::of_work(&NotDiagnosed::new(path, &self.bench.bench, source))
    }
}

/// The failure of the argument `effects`; `None` if the error is another one.
pub(crate) fn of_effects(error: &DiagnosisError) -> Option<Failure> {
    let found = match error {
        DiagnosisError::UnknownEffect { id, .. } => id,
        DiagnosisError::Unavailable { effect, .. }
        | DiagnosisError::NotTogether { effect, .. }
        | DiagnosisError::NoTerm { effect } => *effect,
        _ => return None,
    };
    Some(Failure {
        message: format!("effects: {error}"),
        found: Some(found.to_owned()),
        expected: Some("effects of the catalogue that the record can show".to_owned()),
        advice: Some(
            "`gyrocal effects` lists them; `diagnose` finds which the record shows".to_owned(),
        ),
        ..Failure::default()
    })
}

/// The result (JSON) and the scores of the record as bytes, of a record that was searched.
pub(crate) type Scored = (String, Option<Vec<u8>>);

/// Diagnoses a record.
#[pyfunction]
#[pyo3(signature = (record, bench, later, axes, later_axes, effects, false_alarm, euler_filter, command))]
#[expect(
    clippy::too_many_arguments,
    reason = "the module in Python calls it, with defaults"
)]
pub(crate) fn diagnose(
    py: Python<'_>,
    record: &Bound<'_, HeldRecord>,
    bench: &Bound<'_, HeldBench>,
    later: Option<(Bound<'_, HeldRecord>, Bound<'_, HeldBench>)>,
    axes: Option<GivenAxes<'_>>,
    later_axes: Option<GivenAxes<'_>>,
    effects: Vec<String>,
    false_alarm: f64,
    euler_filter: bool,
    command: &str,
) -> PyResult<Scored> {
    let take = |axes: Option<GivenAxes<'_>>, name| axes.map(|axes| axes.take(name)).transpose();
    let axes = take(axes, "gyro_axes")?;
    let later_axes = take(later_axes, "later_gyro_axes")?;
    let given = Given {
        record: record.get(),
        bench: bench.get(),
        axes: axes.as_ref(),
    };
    let later = later.as_ref().map(|(record, bench)| Given {
        record: record.get(),
        bench: bench.get(),
        axes: later_axes.as_ref(),
    });
    let options = options(effects, false_alarm, euler_filter)?;
    job::run(py, || answer(given, later, &options, command))
}

/// Settings of a diagnosis.
pub(crate) fn options(
    effects: Vec<String>,
    false_alarm: f64,
    euler_filter: bool,
) -> Outcome<DiagnoseOptions> {
    let false_alarm = Failure::unless_probability("false_alarm", false_alarm)?;
    if effects.iter().any(|id| id == FILTER_EFFECT) {
        return Err(Failure::of_value(
            "effects",
            format!("{FILTER_EFFECT}, an error of a filter and not of the record"),
            "effects of the catalogue",
            "give filter=\"euler\", which tests it",
        ));
    }
    Ok(DiagnoseOptions {
        false_alarm_probability: false_alarm,
        also: effects,
        filter: euler_filter.then_some(TestedFilter::Euler),
        ..DiagnoseOptions::default()
    })
}

fn answer(
    given: Given<'_>,
    later: Option<Given<'_>>,
    options: &DiagnoseOptions,
    command: &str,
) -> Outcome<Scored> {
    let (mut result, scores) = result(given, later, options)?;
    use InputRole::{Bench, GyroAxes, LaterBench, LaterGyroAxes, LaterRecord, Record};
    let later = later.map(|later| (later, [LaterRecord, LaterBench, LaterGyroAxes]));
    let both = || {
        [Some((given, [Record, Bench, GyroAxes])), later]
            .into_iter()
            .flatten()
    };
    let pairs = both().flat_map(|(one, [record, bench, _])| {
        [(&one.record.input, record), (&one.bench.input, bench)]
    });
    let mut inputs: Vec<_> = pairs
        .map(|(input, role)| input.clone().with_role(role))
        .collect();
    for (one, [.., role]) in both() {
        if let Some(axes) = one.axes {
            inputs.push(axes.input()?.with_role(role));
        }
    }
    result.manifest = manifest(MODEL_HASH, options.seed, inputs, command);
    Ok((answer_text(&result)?, scores))
}

/// The result and the scores. A gross error of the set-up is an answer too.
fn result(
    given: Given<'_>,
    later: Option<Given<'_>>,
    options: &DiagnoseOptions,
) -> Outcome<(Answer, Option<Vec<u8>>)> {
    if options.filter.is_some() && given.bench.bench.initial_angles_deg.is_none() {
        return Err(given.no_diagnosis(CalibrationError::NoAttitude.into()));
    }
    let gate = given.gate_with_axes(options)?;
    // What is wrong with the later record is told before the work.
    let later = later.map(|later| -> Outcome<_> { Ok((later, later.gate_with_axes(options)?)) });
    let later = later.transpose()?;
    let diagnosed: Result<Diagnosis<'_>, _> = diagnose_gated(gate, &given.bench.bench, options);
    let mut diagnosis = match diagnosed {
        Err(DiagnosisError::Setup { result }) => return Ok((*result, None)),
        found => found.map_err(|source| given.no_diagnosis(source))?,
    };
    if let Some((later, gate)) = later {
        match diagnosis.validate_gated(gate, &later.bench.bench, options) {
            Err(DiagnosisError::Setup { result }) => return Ok((*result, None)),
            validated => validated.map_err(|source| later.no_diagnosis(source))?,
        }
    }
    let scores = gyrocal_fleet::to_bytes(&diagnosis.scores);
    Ok((diagnosis.result, Some(scores)))
}

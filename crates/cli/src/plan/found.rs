//! Findings of the record: read from a diagnosis file, or by a diagnosis.

use std::borrow::Cow;
use std::path::Path;

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_design::{NamedCause, noise_of};
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisResult, Gate, diagnose_watched, result};
use gyrocal_record::{Bench, Input, Record, RecordFile, SetupProblem, printable_path};
use gyrocal_setup::PlatformKind;

use super::PlanArguments;
use super::failed::{NotPlanned, OtherInput};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::progress::Progress;

/// Starting point of a plan.
pub(super) struct Known<'a> {
    /// The record without what gross errors of the set-up spoilt.
    pub(super) record: Cow<'a, Record>,
    /// Gross errors that were mended.
    pub(super) setup: Vec<SetupProblem>,
    pub(super) fitted: FittedPlatform<'a>,
    pub(super) noise: NoiseModel,
    pub(super) named: Vec<NamedCause>,
}

pub(super) fn known<'a>(
    arguments: &PlanArguments,
    file: &'a RecordFile,
    bench: &'a Bench,
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let kind = PlatformKind::Stabilised;
    let checked = Gate::of_file(kind, file, bench, &Options::default())?;
    match &arguments.diagnosis {
        Some(path) => written(path, arguments, checked, bench),
        None => made(arguments, checked, bench, progress),
    }
}

fn made<'a>(
    arguments: &PlanArguments,
    checked: Gate<'a>,
    bench: &'a Bench,
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let options = DiagnoseOptions {
        false_alarm_probability: arguments.false_alarm,
        also: arguments.effects.clone(),
        ..DiagnoseOptions::default()
    };
    let found = diagnose_watched(checked, bench, &options, |stage| progress.at(stage))
        .map_err(|source| NotDiagnosed::new(&arguments.record, bench, source))?;
    Ok(Known {
        named: NamedCause::all(&found.result),
        noise: found.noise_model,
        fitted: found.extended.unwrap_or(found.nominal),
        record: found.record,
        setup: found.result.setup,
    })
}

fn written<'a>(
    path: &Path,
    arguments: &PlanArguments,
    checked: Gate<'a>,
    bench: &'a Bench,
) -> Result<Known<'a>, Failure> {
    let diagnosis = result::read(path)?;
    if !diagnosis.records.is_empty() {
        return Err(Failure::Usage(format!(
            "{} is a result of {} records: a run is planned from one, give the diagnosis of that one",
            printable_path(path),
            diagnosis.records.len()
        )));
    }
    if diagnosis.strapdown {
        return Err(Failure::Usage(format!(
            "{} is of a strapdown unit (--gyro-axes): a run is planned of a stabilised platform. The next log \
             of a unit is best one in another attitude",
            printable_path(path)
        )));
    }
    check_inputs(path, &diagnosis, arguments)?;
    let named = NamedCause::all(&diagnosis);
    let noise = noise_of(&diagnosis);
    let (record, setup) = checked
        .sound(&DiagnoseOptions::default())
        .map_err(|source| NotDiagnosed::new(&arguments.record, bench, source))?;
    let fitted = {
        let run = Run {
            record: &record,
            bench,
        };
        let fitted = NamedCause::fitted(&named, &run, &noise, &Options::default())
            .map_err(|source| NotPlanned::new(&arguments.record, source))?;
        fitted.into_owned()
    };
    Ok(Known {
        record,
        setup,
        fitted,
        noise,
        named,
    })
}

/// The inputs of a diagnosis are its record and bench file; a later record and its bench file may
/// follow.
fn check_inputs(
    path: &Path,
    diagnosis: &DiagnosisResult,
    arguments: &PlanArguments,
) -> Result<(), Failure> {
    let given = [
        (&arguments.record, "of another record"),
        (&arguments.bench, "with another bench file"),
    ];
    for (place, (given, other)) in given.into_iter().enumerate() {
        let expected = Input::of(given)?.sha256;
        let found = diagnosis.manifest.inputs.get(place);
        if found.is_none_or(|input| input.sha256 != expected) {
            return Err(OtherInput {
                diagnosis: printable_path(path),
                other,
                given: printable_path(given),
                found: found.map_or_else(|| "none".to_owned(), |input| input.sha256.clone()),
                expected,
            }
            .into());
        }
    }
    Ok(())
}

//! Findings of the record: read from a diagnosis file, or by a diagnosis.

use std::path::Path;

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_design::{NamedCause, noise_of};
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisResult, diagnose, result};
use gyrocal_record::Input;

use super::PlanArguments;
use super::failed::{NotPlanned, OtherInput};
use crate::Failure;
use crate::diagnose::NotDiagnosed;

/// Starting point of a plan.
pub(super) struct Known<'a> {
    pub(super) fitted: FittedPlatform<'a>,
    pub(super) noise: NoiseModel,
    pub(super) named: Vec<NamedCause>,
}

pub(super) fn known<'a>(arguments: &PlanArguments, run: &Run<'a>) -> Result<Known<'a>, Failure> {
    match &arguments.diagnosis {
        Some(path) => written(path, arguments, run),
        None => made(arguments, run),
    }
}

fn made<'a>(arguments: &PlanArguments, run: &Run<'a>) -> Result<Known<'a>, Failure> {
    let options = DiagnoseOptions {
        false_alarm_probability: arguments.false_alarm,
        also: arguments.effects.clone(),
        ..DiagnoseOptions::default()
    };
    let found = diagnose(run.record, run.bench, &options)
        .map_err(|source| NotDiagnosed::new(&arguments.record, run.bench, source))?;
    Ok(Known {
        named: NamedCause::all(&found.result),
        noise: found.noise_model,
        fitted: found.extended.unwrap_or(found.nominal),
    })
}

fn written<'a>(
    path: &Path,
    arguments: &PlanArguments,
    run: &Run<'a>,
) -> Result<Known<'a>, Failure> {
    let diagnosis = result::read(path)?;
    check_inputs(path, &diagnosis, arguments)?;
    let named = NamedCause::all(&diagnosis);
    let noise = noise_of(&diagnosis);
    let fitted = NamedCause::fitted(&named, run, &noise, &Options::default())
        .map_err(|source| NotPlanned::new(&arguments.record, source))?;
    Ok(Known {
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
                diagnosis: path.display().to_string(),
                other,
                given: given.display().to_string(),
                found: found.map_or_else(|| "none".to_owned(), |input| input.sha256.clone()),
                expected,
            }
            .into());
        }
    }
    Ok(())
}

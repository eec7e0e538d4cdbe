//! What was found in the record: from a diagnosis that was written, or by making one.

use std::path::Path;

use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_diagnosis::plan::Named;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::{DiagnosisReport, FindingReport, Input};

use super::PlanArguments;
use super::failed::{NotPlanned, OtherInput};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::extend::diagnosis::read;

/// What a plan starts from.
pub(super) struct Known<'a> {
    pub(super) fitted: Extended<'a>,
    pub(super) noise: NoiseModel,
    pub(super) named: Vec<Named>,
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
        named: found.findings.iter().map(Named::of).collect(),
        noise: found.noise_model,
        fitted: found.extended.unwrap_or(found.nominal),
    })
}

fn written<'a>(
    path: &Path,
    arguments: &PlanArguments,
    run: &Run<'a>,
) -> Result<Known<'a>, Failure> {
    let report = read(path)?;
    check_inputs(path, &report, arguments)?;
    let named: Vec<Named> = report
        .findings
        .iter()
        .filter(|finding| Named::is_cause(&finding.effect))
        .map(of_finding)
        .collect();
    let noise = noise(&report);
    let fitted = Named::fitted(&named, run, &noise, &Options::default())
        .map_err(|source| NotPlanned::new(&arguments.record, source))?;
    Ok(Known {
        fitted,
        noise,
        named,
    })
}

/// A diagnosis names its record first and the bench file of it second; a later record and its
/// bench file may follow.
fn check_inputs(
    path: &Path,
    report: &DiagnosisReport,
    arguments: &PlanArguments,
) -> Result<(), Failure> {
    let given = [
        (&arguments.record, "of another record"),
        (&arguments.bench, "with another bench file"),
    ];
    for (place, (given, other)) in given.into_iter().enumerate() {
        let expected = Input::of(given)?.sha256;
        let found = report.manifest.inputs.get(place);
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

fn of_finding(finding: &FindingReport) -> Named {
    let walk = finding.effect.ends_with(".random_walk");
    let shape = finding.parameters.iter().find(|parameter| {
        matches!(parameter.name.as_str(), "onset_s" | "time_constant_h")
            || (walk && parameter.name == "size")
    });
    Named {
        effect: finding.effect.clone(),
        shape: shape.map(|parameter| parameter.estimate),
        rivals: finding
            .rivals
            .iter()
            .map(|rival| (rival.effect.clone(), rival.log_likelihood_deficit))
            .collect(),
    }
}

/// Noise other than declared, where the diagnosis found it.
fn noise(report: &DiagnosisReport) -> NoiseModel {
    let ratio = |sensor: &str, axis: usize| {
        let effect = format!("{sensor}_{}.noise", ["x", "y", "z"][axis]);
        let found = report.findings.iter().find(|f| f.effect == effect);
        found
            .and_then(|finding| finding.parameters.first())
            .map_or(1.0, |parameter| parameter.estimate)
    };
    NoiseModel {
        accel_ratio: core::array::from_fn(|axis| ratio("accel", axis)),
        gyro_ratio: core::array::from_fn(|axis| ratio("gyro", axis)),
        weights: None,
    }
}

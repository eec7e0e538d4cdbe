//! What was found in the record: from a diagnosis that was written, or by making one.

use std::path::Path;

use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_diagnosis::plan::Named;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::{DiagnosisReport, FindingReport, Input};

use super::PlanArguments;
use super::failed::{NotPlanned, OtherRecord};
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
        Some(path) => written(path, &arguments.record, run),
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
        .map_err(|source| NotDiagnosed::new(&arguments.record, source))?;
    Ok(Known {
        named: found.findings.iter().map(Named::of).collect(),
        noise: found.noise_model,
        fitted: found.extended.unwrap_or(found.nominal),
    })
}

fn written<'a>(path: &Path, record: &Path, run: &Run<'a>) -> Result<Known<'a>, Failure> {
    let report = read(path)?;
    let expected = Input::of(record)?.sha256;
    if !report.manifest.inputs.iter().any(|i| i.sha256 == expected) {
        let found: Vec<_> = report.manifest.inputs.iter().map(|i| &*i.sha256).collect();
        return Err(OtherRecord {
            diagnosis: path.display().to_string(),
            record: record.display().to_string(),
            found: found.join(" and "),
            expected,
        }
        .into());
    }
    let named: Vec<Named> = report
        .findings
        .iter()
        .filter(|finding| Named::is_cause(&finding.effect))
        .map(of_finding)
        .collect();
    let noise = noise(&report);
    let fitted = Named::fitted(&named, run, &noise, &Options::default())
        .map_err(|source| NotPlanned::new(record, source))?;
    Ok(Known {
        fitted,
        noise,
        named,
    })
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

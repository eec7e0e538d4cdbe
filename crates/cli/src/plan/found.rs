//! Findings of the record: read from a diagnosis file, or by a diagnosis.

use std::path::Path;

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal_calibration::{Extended, NoiseModel, Options, Run};
use gyrocal_diagnosis::plan::Named;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::{DiagnosisReport, FindingReport, Input};

use super::PlanArguments;
use super::failed::{NotPlanned, OtherInput};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::extend::diagnosis::read;

/// Starting point of a plan.
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

/// The inputs of a diagnosis are its record and bench file; a later record and its bench file may
/// follow.
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
    let row = EFFECTS.iter().find(|row| row.id == finding.effect);
    // Of a random walk its size.
    let wanted = row.and_then(|row| {
        let is_walk = row.kind == EffectKind::RandomWalk;
        row.shape().or(row.parameters.first().filter(|_| is_walk))
    });
    let mut found = finding.parameters.iter();
    let shape = found.find(|parameter| Some(parameter.name.as_str()) == wanted.map(|p| p.name));
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

/// Noise model with the ratios that the diagnosis found.
fn noise(report: &DiagnosisReport) -> NoiseModel {
    let ratio = |enters: &dyn Fn(Enters) -> bool| {
        let level = EffectKind::Noise(NoiseProperty::Level);
        let effect = EFFECTS.iter().find(|e| e.kind == level && enters(e.enters));
        let mut findings = report.findings.iter();
        let found = findings.find(|f| effect.is_some_and(|effect| effect.id == f.effect));
        found
            .and_then(|finding| finding.parameters.first())
            .map_or(1.0, |parameter| parameter.estimate)
    };
    NoiseModel {
        accel_ratio: core::array::from_fn(|axis| {
            ratio(&|enters| matches!(enters, Enters::Outputs([at]) if *at == axis))
        }),
        gyro_ratio: core::array::from_fn(|axis| {
            ratio(&|enters| matches!(enters, Enters::Rates([at]) if *at == axis))
        }),
        weights: None,
    }
}

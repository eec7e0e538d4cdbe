//! Diagnoses and calibrations of records against those of an earlier build.

use std::path::Path;

use gyrocal_calibration::{Options, calibrate};
use gyrocal_diagnosis::result::{DiagnosisResult, Finding};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::{Bench, Record};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;

/// Results of an earlier build, from the root of the workspace.
const RESULTS: &str = "tests/data/before/diagnoses.json";

/// Largest difference of a number, in its standard deviations.
const LARGEST: f64 = 1e-6;

#[derive(Deserialize, Serialize)]
struct Before {
    /// The commit of the earlier build.
    commit: String,
    diagnoses: Vec<DiagnosisBefore>,
}

/// Diagnosis of one record by an earlier build.
#[derive(Deserialize, Serialize)]
struct DiagnosisBefore {
    record: String,
    bench: String,
    verdict: String,
    findings: Vec<FindingBefore>,
    coefficients: Vec<ParameterBefore>,
}

#[derive(Deserialize, Serialize)]
struct FindingBefore {
    effect: String,
    z: f64,
    parameters: Vec<ParameterBefore>,
    alternatives: Vec<AlternativeBefore>,
    gain_nats: Option<f64>,
}

#[derive(Deserialize, Serialize)]
struct ParameterBefore {
    name: String,
    estimate: f64,
    sigma: Option<f64>,
}

#[derive(Deserialize, Serialize)]
struct AlternativeBefore {
    effect: String,
    log_likelihood_deficit: f64,
}

pub(crate) fn figures(root: &Path) -> Result<[Figure; 2], Error> {
    let text = std::fs::read_to_string(root.join(RESULTS))?;
    let before: Before = serde_json::from_str(&text)?;
    let mut differ = Vec::new();
    let mut largest: f64 = 0.0;
    for one in &before.diagnoses {
        let record = Record::read(&root.join(&one.record))?;
        let bench = Bench::read(&root.join(&one.bench))?;
        let now = diagnose(&record, &bench, &DiagnoseOptions::default())?.result;
        if !same_names(one, &now) {
            differ.push(one.record.clone());
            continue;
        }
        for (before, now) in one.findings.iter().zip(&now.findings) {
            largest = largest.max(difference(before, now));
        }
        let calibration = calibrate(&record, &bench, &Options::default(), |_| ())?;
        for before in &one.coefficients {
            let now = calibration.coefficients();
            let now = now.iter().find(|now| now.id == before.name);
            let sigma = before.sigma.unwrap_or(f64::NAN);
            largest = largest.max(now.map_or(f64::INFINITY, |now| {
                (now.estimate - before.estimate)
                    .abs()
                    .max((now.sigma - sigma).abs())
                    / sigma
            }));
        }
    }
    let (count, commit) = (before.diagnoses.len(), &before.commit);
    let mut names = Figure::truth(
        &format!("verdicts, names and confidence sets equal to those of commit {commit}"),
        differ.is_empty(),
    );
    if !differ.is_empty() {
        names.measured = format!("no: {}", differ.join(", "));
    }
    let mut numbers = Figure::within(
        &format!("largest difference of a number from commit {commit}"),
        [0.0, LARGEST],
        largest,
    );
    numbers.target = format!("<= {LARGEST:e} σ");
    numbers.measured = format!("{largest:.1e} σ");
    let seeds = "the records of examples and sealed cases";
    Ok([names.over(count, seeds), numbers.over(count, seeds)])
}

/// Renews the results by this build, after a change of a method.
pub(crate) fn write(root: &Path) -> Result<(), Error> {
    let path = root.join(RESULTS);
    let before: Before = serde_json::from_str(&std::fs::read_to_string(&path)?)?;
    let mut diagnoses = Vec::with_capacity(before.diagnoses.len());
    for one in before.diagnoses {
        let record = Record::read(&root.join(&one.record))?;
        let bench = Bench::read(&root.join(&one.bench))?;
        let now = diagnose(&record, &bench, &DiagnoseOptions::default())?.result;
        let calibration = calibrate(&record, &bench, &Options::default(), |_| ())?;
        let verdict = serde_json::to_value(now.verdict)?;
        diagnoses.push(DiagnosisBefore {
            verdict: verdict.as_str().unwrap_or_default().to_owned(),
            findings: now.findings.iter().map(FindingBefore::of).collect(),
            coefficients: calibration
                .coefficients()
                .iter()
                .map(|coefficient| ParameterBefore {
                    name: coefficient.id.to_owned(),
                    estimate: coefficient.estimate,
                    sigma: Some(coefficient.sigma),
                })
                .collect(),
            ..one
        });
    }
    let renewed = Before {
        commit: crate::harness::pages::commit(root),
        diagnoses,
    };
    Ok(gyrocal_record::write_json(&path, &renewed)?)
}

impl FindingBefore {
    fn of(finding: &Finding) -> Self {
        Self {
            effect: finding.effect.clone(),
            z: finding.z,
            parameters: finding
                .parameters
                .iter()
                .map(|parameter| ParameterBefore {
                    name: parameter.name.clone(),
                    estimate: parameter.estimate,
                    sigma: parameter.sigma,
                })
                .collect(),
            alternatives: finding
                .alternatives
                .iter()
                .map(|other| AlternativeBefore {
                    effect: other.effect.clone(),
                    log_likelihood_deficit: other.log_likelihood_deficit,
                })
                .collect(),
            gain_nats: finding.gain_nats,
        }
    }
}

fn same_names(before: &DiagnosisBefore, now: &DiagnosisResult) -> bool {
    let verdict = serde_json::to_value(now.verdict);
    let same_set = |(before, now): (&FindingBefore, &Finding)| {
        before.effect == now.effect
            && before.parameters.len() == now.parameters.len()
            && before.alternatives.len() == now.alternatives.len()
            && before
                .alternatives
                .iter()
                .zip(&now.alternatives)
                .all(|(before, now)| before.effect == now.effect)
    };
    verdict.is_ok_and(|verdict| verdict == before.verdict)
        && before.findings.len() == now.findings.len()
        && before.findings.iter().zip(&now.findings).all(same_set)
}

/// The largest difference of a finding's numbers: parameters in their standard deviations, z,
/// deficits and gain, whose standard deviation is about one.
fn difference(before: &FindingBefore, now: &Finding) -> f64 {
    let parameters = before.parameters.iter().zip(&now.parameters);
    let parameters = parameters.map(|(before, now)| {
        let sigma = before.sigma.unwrap_or(before.estimate.abs());
        (before.estimate - now.estimate).abs() / sigma
    });
    let deficits = before.alternatives.iter().zip(&now.alternatives);
    let deficits = deficits
        .map(|(before, now)| (before.log_likelihood_deficit - now.log_likelihood_deficit).abs());
    let gain = match (before.gain_nats, now.gain_nats) {
        (Some(before), Some(now)) => (before - now).abs(),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    };
    parameters
        .chain(deficits)
        .chain([(before.z - now.z).abs(), gain])
        .fold(0.0, f64::max)
}

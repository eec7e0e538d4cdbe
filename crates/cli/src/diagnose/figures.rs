//! Pictures of a diagnosis.

mod convergence;
mod model;
mod residual;

use std::path::Path;

use gyrocal_answer::{FindingKind, Verdict};
use gyrocal_diagnosis::DiagnosisError;
use gyrocal_record::Outputs;
use gyrocal_report::Picture;
use miette::miette;

use super::DiagnosisRun;
use crate::Failure;
use crate::pictures::{self, Named};

/// Writes all pictures, to be committed with the other outputs; returns the text for stdout.
pub(super) fn stage(
    found: &DiagnosisRun<'_>,
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<String, Failure> {
    let drawn = pictures(found).map_err(|reason| {
        Failure::Work(miette!("{}: no pictures: {reason}", found.path.display()))
    })?;
    pictures::stage(found.path, &drawn, folder, outputs)
}

/// A record that is too short for one picture leaves that out.
fn pictures(found: &DiagnosisRun<'_>) -> Result<Vec<Named>, gyrocal_calibration::CalibrationError> {
    let runs = residual::OpenLoopRuns::of(found)?;
    let mut pictures: Vec<Named> = vec![
        ("residuals", Box::new(runs.residuals(found))),
        ("free-run", Box::new(runs.open_loop(found))),
        (
            "residual-against-force",
            Box::new(runs.against_force(found)),
        ),
    ];
    let mut add =
        |name: &'static str, picture: Result<Box<dyn Picture>, DiagnosisError>| match picture {
            Ok(picture) => pictures.push((name, picture)),
            Err(reason) => tracing::warn!(%reason, "no picture {name}"),
        };
    add("periodogram", residual::periodograms(found));
    add("autocorrelation", residual::autocorrelations(found));
    add("norm", residual::norm(found));
    if let Some(ranking) = model::ranking(found) {
        pictures.push(("ranking", Box::new(ranking)));
    }
    if let Some(gain) = &found.diagnosis.result.gain {
        pictures.push(("gain", Box::new(model::gain(found, gain))));
    }
    if let Some(coefficients) = model::coefficients(found) {
        pictures.push(("coefficients", Box::new(coefficients)));
    }
    if let Some(convergence) = convergence::convergence(found)? {
        pictures.push(("convergence", Box::new(convergence)));
    }
    Ok(pictures)
}

/// Effects in the extended model, for titles: `gyro_y.g_z and gyro_x.ramp`.
fn causes(found: &DiagnosisRun<'_>) -> Option<String> {
    let causes = found.diagnosis.result.causes();
    let accepted = causes.filter(|cause| cause.accepted == Some(true));
    listed(&accepted.map(|cause| &*cause.effect).collect::<Vec<_>>())
}

fn listed(ids: &[&str]) -> Option<String> {
    match ids {
        [] => None,
        [one] => Some((*one).to_owned()),
        [head @ .., last] => Some(format!("{} and {last}", head.join(", "))),
    }
}

/// Record and verdict, below every title.
fn subtitle(found: &DiagnosisRun<'_>) -> String {
    let result = &found.diagnosis.result;
    let verdict = match result.verdict {
        Verdict::EffectsFound | Verdict::NotSettled => {
            // The pictures are of the record and not of another filter.
            let findings = result.findings.iter();
            let findings = findings.filter(|finding| finding.kind != FindingKind::Filter);
            let ids: Vec<&str> = findings.map(|finding| &*finding.effect).collect();
            let found = match ids.is_empty() {
                true => "no effects found".to_owned(),
                false => format!("effects found: {}", ids.join(", ")),
            };
            match result.is_settled() {
                true => found,
                false => format!("not settled, {found}"),
            }
        }
        Verdict::Unexplained => "unexplained residual".to_owned(),
        _ => "no effects found".to_owned(),
    };
    let name = found.path.file_name().unwrap_or(found.path.as_os_str());
    format!("{}; {verdict}", name.display())
}

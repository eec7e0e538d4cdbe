//! Gross errors of the set-up, before anything is fitted.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_record::{Bench, Record, SetupProblem};
use gyrocal_setup::{SetupCheck, SetupFinding};

use super::DiagnoseOptions;
use super::answer::{manifest, record_summary};
use crate::error_budget::shares;
use crate::result::{DiagnosisResult, ResidualTest, ResidualVerdict, SCHEMA_VERSION, Verdict};

/// Rows that a record is thinned to before it is fitted as given and as corrected: enough to tell a
/// mean NIS of 3 from one of 4, and fitted in a tenth of a second.
const FITTED_ROWS: usize = 288;

/// The problems of a check; of those that a correction of axes or latitude removes, the mean NIS of
/// both is in the evidence.
pub(super) fn problems(check: &SetupCheck, run: &Run<'_>, options: &Options) -> Vec<SetupProblem> {
    let findings = check.findings.iter();
    findings
        .map(|finding| {
            let mut problem = finding.problem();
            if let Some(text) = corrected_fit(finding, run, options) {
                problem.evidence = format!("{}; {text}", problem.evidence);
            }
            problem
        })
        .collect()
}

/// Mean NIS as given and with the correction, in words.
fn corrected_fit(finding: &SetupFinding, run: &Run<'_>, options: &Options) -> Option<String> {
    let correction = finding.correction?;
    let thin = thinned(run.record);
    let given = nis_mean(&thin, run.bench, options);
    let (record, bench) = correction.apply(&thin, run.bench);
    let corrected = nis_mean(&record, &bench, options);
    let text = |nis: Option<f64>| nis.map_or("no fit".to_owned(), |nis| format!("{nis:.3}"));
    Some(format!(
        "mean NIS of {} rows, 3 is expected: {} as given, {} corrected ({} at {:.4} deg)",
        thin.len(),
        text(given),
        text(corrected),
        correction.axes.describe(),
        correction.latitude_deg,
    ))
}

fn nis_mean(record: &Record, bench: &Bench, options: &Options) -> Option<f64> {
    let run = Run { record, bench };
    let fitted = FittedPlatform::nominal(&run, options, &NoiseModel::default()).ok()?;
    Some(fitted.nis_mean())
}

fn thinned(record: &Record) -> Record {
    let step = record.len().div_ceil(FITTED_ROWS).max(1);
    let temperature_c = record.temperature_c.as_ref();
    Record {
        time_s: record.time_s.iter().copied().step_by(step).collect(),
        accel_g: record.accel_g.iter().copied().step_by(step).collect(),
        temperature_c: temperature_c.map(|column| column.iter().copied().step_by(step).collect()),
    }
}

/// The result of a record of whose set-up nothing sound is left: nothing was fitted.
pub(super) fn stopped(
    record: &Record,
    options: &DiagnoseOptions,
    setup: Vec<SetupProblem>,
) -> DiagnosisResult {
    DiagnosisResult {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(options.seed),
        record: record_summary(record),
        later_record: None,
        verdict: Verdict::Setup,
        false_alarm_probability: options.false_alarm_probability,
        false_alarm_shares: shares(options.false_alarm_probability),
        setup,
        norm: None,
        residuals: None,
        findings: Vec::new(),
        coefficients: None,
        gain: None,
        remainder: ResidualTest {
            verdict: ResidualVerdict::NotTested,
            p_value: 1.0,
            description: "the set-up is wrong: nothing was fitted".to_owned(),
            line: None,
            correlation: None,
            unmodelled: Vec::new(),
        },
        cannot_tell: Vec::new(),
        ranking: Vec::new(),
        threshold: None,
        power: Vec::new(),
        noise: None,
        noise_audit: None,
        allan: None,
        not_searched: Vec::new(),
        filter: None,
    }
}

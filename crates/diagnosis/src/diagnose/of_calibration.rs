//! The diagnosis of a record that is calibrated.

use gyrocal_answer::{Answer, Finding, FindingKind, ResidualVerdict};
use gyrocal_calibration::{GyroAxes, Run};
use gyrocal_record::{EffectTest, NamedCause, SetupProblem};

use super::{DiagnoseOptions, Diagnosis, diagnose_in_blocks, diagnose_rows};
use crate::blocks::Blocks;
use crate::error::DiagnosisError;
use crate::stage::Stage;

/// A record with more rows that are not white is averaged before it is diagnosed.
const MOST_ROWS: usize = 10_000;

/// Longest interval of such means, s: only attitude jumps lose power by it.
const LONGEST_MEAN_S: f64 = 600.0;

/// What [`super::diagnose`] says of a record whose set-up was checked; `file` is its name. Of a record of many rows that
/// are not white, means are diagnosed, unless it has the axes of the instruments of a strapdown unit.
///
/// # Errors
/// [`DiagnosisError`].
pub(crate) fn diagnose_calibrated(
    file: &str,
    run: &Run<'_>,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
) -> Result<EffectTest, DiagnosisError> {
    let (setup, watch): (Vec<SetupProblem>, &mut dyn FnMut(Stage)) = (Vec::new(), &mut |_| ());
    let found = if let Some(blocks) = Blocks::of(run, axes) {
        diagnose_in_blocks(&blocks, run, options, setup, watch)
    } else {
        let interval_s = mean_interval_s(run).filter(|_| axes.is_none());
        let means = interval_s.and_then(|length_s| Blocks::every(run, length_s).ok());
        let means = means.as_ref().map(Blocks::run);
        let Run { record, bench } = means.as_ref().unwrap_or(run);
        let found = diagnose_rows(record, bench, axes, options, setup, watch);
        found.map(Diagnosis::into_owned)
    };
    found.map(|found| effect_test(file, &found.result))
}

/// The interval of means, if the record has many rows.
fn mean_interval_s(run: &Run<'_>) -> Option<f64> {
    let record = run.record;
    let span_s = record.time_s.last()? - record.time_s.first()?;
    let interval_s = span_s / MOST_ROWS as f64;
    (record.len() > MOST_ROWS).then_some(interval_s.ceil().min(LONGEST_MEAN_S))
}

fn effect_test(file: &str, answer: &Answer) -> EffectTest {
    let cause = |one: &Finding| NamedCause {
        effect: one.effect.clone(),
        alternatives: one
            .alternatives
            .iter()
            .map(|other| other.effect.clone())
            .collect(),
        z: one.z,
        p_value: one.p_value,
    };
    let noise = answer.of_kind(FindingKind::Noise);
    let white = match answer.remainder.verdict {
        ResidualVerdict::NotTested => None,
        verdict => Some(verdict == ResidualVerdict::White),
    };
    EffectTest {
        record: file.to_owned(),
        causes: answer.causes().map(cause).collect(),
        noise: noise.map(|one| one.effect.clone()).collect(),
        white,
        residual_p_value: white.and(answer.remainder.p_value),
        settled: answer.is_settled(),
    }
}

//! The cheap part of a diagnosis: whether a record contradicts the nominal model at all.

use gyrocal_calibration::{GyroAxes, NoiseModel, Run, average_record, rows};
use gyrocal_hypothesis::{FittedModel, Screened, screen};
use gyrocal_record::EffectTest;

use super::gyro_noise::gyro_noise_findings;
use super::noise_audited_fit::noise_audited_fit;
use super::{DiagnoseOptions, search_options};
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::noise::AuditOptions;
use crate::request;
use crate::residual_test::{decorrelated, residual_test, whitened};
use gyrocal_answer::ResidualVerdict;

/// A record with more rows is averaged before it is tested.
const MOST_ROWS: usize = 10_000;

/// Longest interval of such means, s: only attitude jumps lose power by it.
const LONGEST_MEAN_S: f64 = 600.0;

/// What the first tests say of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenedRecord {
    /// The detection test of the search.
    pub effects: Screened,
    /// What differs from the declared noise, without an effect in the model, by the ids of a diagnosis.
    pub noise: Vec<&'static str>,
    /// Whether the innovations are white, without an effect in the model; `None` of a record too short for
    /// the test.
    pub is_white: Option<bool>,
    /// p-value of that test.
    pub residual_p_value: Option<f64>,
}

impl ScreenedRecord {
    /// The same as results tell it; `file` is the record.
    #[must_use]
    pub fn test(&self, file: &str) -> EffectTest {
        EffectTest {
            record: file.to_owned(),
            effect: self.effects.effect.map(str::to_owned),
            z: self.effects.z,
            p_value: self.effects.p_value,
            significant: self.effects.is_significant,
            noise: self.noise.iter().map(|id| (*id).to_owned()).collect(),
            white: self.is_white,
            residual_p_value: self.is_white.and(self.residual_p_value),
        }
    }
}

/// Tests a record for the effects of the default search: the first detection tests of
/// [`super::diagnose`], with the same noise audit, the test of whether the innovations are white, and the
/// same probability of a false alarm. Of a record of many rows means are tested, unless it has the axes of the
/// instruments of a strapdown unit.
///
/// # Errors
/// [`DiagnosisError`].
pub fn screen_record(
    run: &Run<'_>,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
) -> Result<ScreenedRecord, DiagnosisError> {
    let interval_s = mean_interval_s(run);
    if let Some(interval_s) = interval_s
        && axes.is_none()
        && let Ok(means) = average_record(run.record, interval_s)
    {
        let bench = means.bench(run.bench);
        let run = Run {
            record: &means.record,
            bench: &bench,
        };
        return screen_rows(&run, None, options);
    }
    screen_rows(run, axes, options)
}

/// The interval of means, if the record has many rows.
fn mean_interval_s(run: &Run<'_>) -> Option<f64> {
    let record = run.record;
    let span_s = record.time_s.last()? - record.time_s.first()?;
    let interval_s = span_s / MOST_ROWS as f64;
    (record.len() > MOST_ROWS).then_some(interval_s.ceil().min(LONGEST_MEAN_S))
}

fn screen_rows(
    run: &Run<'_>,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
) -> Result<ScreenedRecord, DiagnosisError> {
    let shares = shares(options.false_alarm_probability);
    let declared = NoiseModel::default();
    let audited = noise_audited_fit(
        run,
        axes,
        &declared,
        &AuditOptions::with_share(shares.noise_audit),
        &options.calibration,
    )?;
    let also: Vec<&str> = options.also.iter().map(String::as_str).collect();
    let selection = request::selection(run.record, run.bench, &also);
    let nominal = audited.nominal;
    let rows = rows(run.record, nominal.covariates());
    // Noise of a gyro other than declared correlates innovations; the search has it estimated.
    let noise = nominal.fit_rate_noise(&[], &[])?;
    let fitted = nominal.with_rate_noise(&noise.noise)?;
    let audit = &audited.audit;
    let mut found: Vec<&'static str> = audit.findings.iter().map(|one| one.effect).collect();
    let of_gyros = gyro_noise_findings(&fitted, &noise, audit, shares.gyro_noise)?;
    found.extend(of_gyros.iter().map(|one| one.effect));
    let innovations = decorrelated(&whitened(&fitted, run.record)?, audit.cleaned.correlation);
    let residuals = residual_test(&run.record.time_s, &innovations, &[], shares.residual_test);
    let search = search_options(options, &shares, 0);
    Ok(ScreenedRecord {
        effects: screen(nominal, rows, &selection, &search)?,
        noise: found,
        is_white: match residuals.verdict {
            ResidualVerdict::NotTested => None,
            verdict => Some(verdict == ResidualVerdict::White),
        },
        residual_p_value: residuals.p_value,
    })
}

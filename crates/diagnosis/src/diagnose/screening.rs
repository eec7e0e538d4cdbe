//! The cheap part of a diagnosis: whether a record contradicts the nominal model at all.

use gyrocal_calibration::{GyroAxes, NoiseModel, Run, average_record, rows};
use gyrocal_hypothesis::{FittedModel, Screened, screen};

use super::noise_audited_fit::noise_audited_fit;
use super::{DiagnoseOptions, search_options};
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::noise::AuditOptions;
use crate::request;

/// A record with more rows is averaged before it is tested.
const MOST_ROWS: usize = 10_000;

/// Longest interval of such means, s: only attitude jumps lose power by it.
const LONGEST_MEAN_S: f64 = 600.0;

/// Tests a record for the effects of the default search: the first detection tests of
/// [`super::diagnose`], with the same noise audit and the same probability of a false alarm. Of a
/// record of many rows means are tested, unless it has the axes of the instruments of a strapdown unit.
///
/// # Errors
/// [`DiagnosisError`].
pub fn screen_record(
    run: &Run<'_>,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
) -> Result<Screened, DiagnosisError> {
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
) -> Result<Screened, DiagnosisError> {
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
    let search = search_options(options, &shares, 0);
    Ok(screen(nominal, rows, &selection, &search)?)
}

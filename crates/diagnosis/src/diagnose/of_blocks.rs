//! The diagnosis of a record whose rows come faster than anything moves: that of means of blocks, where it holds.

use gyrocal_answer::{FindingKind, RecordSummary};
use gyrocal_calibration::{GyroAxes, Run};
use gyrocal_record::{Bench, Record, SetupProblem};

use super::answer::record_summary;
use super::{DiagnoseOptions, Diagnosis, diagnose_rows};
use crate::blocks::Blocks;
use crate::error::DiagnosisError;
use crate::stage::Stage;

/// Difference of the noise of means and of rows, each over what is declared for it, beyond which it is none of the rows:
/// twice its scatter over blocks.
const OTHER_NOISE: f64 = 0.02;

/// Diagnoses a record without gross errors; `setup` are those that it had, `axes` those of the instruments
/// of a strapdown unit. Rows that come faster than anything moves are diagnosed as means of blocks, unless a filter is
/// tested, which reads rows.
pub(super) fn diagnose_sound<'a>(
    record: &'a Record,
    bench: &'a Bench,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
    setup: Vec<SetupProblem>,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'a>, DiagnosisError> {
    let run = Run { record, bench };
    let reads_rows = options.filter.is_some();
    match (!reads_rows).then(|| Blocks::of(&run, axes)).flatten() {
        Some(blocks) => diagnose_in_blocks(&blocks, &run, options, setup, watch),
        None => diagnose_rows(record, bench, axes, options, setup, watch),
    }
}

/// The diagnosis of the blocks of a record, or that of its rows if that of the blocks does not hold.
pub(super) fn diagnose_in_blocks<'a>(
    blocks: &Blocks,
    Run { record, bench }: &Run<'a>,
    options: &DiagnoseOptions,
    setup: Vec<SetupProblem>,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'a>, DiagnosisError> {
    let means = blocks.run();
    let found = diagnose_rows(
        means.record,
        means.bench,
        None,
        options,
        setup.clone(),
        watch,
    );
    if let Ok(mut found) = found
        && holds(blocks, &found)
    {
        found.result.record = RecordSummary {
            averaged: Some(blocks.report),
            ..record_summary(record)
        };
        return Ok(found.into_owned());
    }
    diagnose_rows(record, bench, None, options, setup, watch)
}

/// Whether a diagnosis of the means holds for the rows. Rows without outliers have means without: what stands out is a
/// block in which the drift changes by much, or an end. Noise that the rows have not is the walk of noisy gyros within
/// blocks. Beside a second cause an onset within a block is not told from a jump.
fn holds(blocks: &Blocks, found: &Diagnosis<'_>) -> bool {
    let ratios = found.noise_model.accel_ratio.into_iter();
    let mut ratios = ratios.zip(blocks.accel_ratio);
    let names_noise = found.result.of_kind(FindingKind::Noise).next().is_some();
    let has_other_noise =
        names_noise && ratios.any(|(means, rows)| (means / rows - 1.0).abs() > OTHER_NOISE);
    found.audit.outliers.is_empty() && !has_other_noise && found.result.causes().count() <= 1
}

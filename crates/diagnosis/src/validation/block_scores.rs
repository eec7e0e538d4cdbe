//! Predictive log scores under contiguous blocked cross-validation.

use core::ops::Range;

use gyrocal_calibration::{CalibrationError, FittedPlatform};

/// Contiguous blocks of one record that are left out in turn. A last-block hold-out would misjudge
/// effects at the start of a record.
const BLOCKS: usize = 6;

/// The rows of the blocks: parts of one record, or each of several records.
fn blocks(fit: &FittedPlatform<'_>) -> Vec<Range<usize>> {
    let records = fit.record_rows();
    if records.len() > 1 {
        return records;
    }
    let rows = fit.points().len();
    let end = |block: usize| block * rows / BLOCKS;
    (0..BLOCKS)
        .map(|block| end(block)..end(block + 1))
        .collect()
}

/// Logarithm of the density of each block of the record given the others, nats; of several records that
/// of each given the others.
///
/// # Errors
/// As [`FittedPlatform::log_evidence_without`].
pub(crate) fn block_log_scores(fit: &FittedPlatform<'_>) -> Result<Vec<f64>, CalibrationError> {
    let whole = fit.log_evidence_without(0..0)?;
    let left_out = blocks(fit).into_iter();
    left_out
        .map(|rows| Ok(whole - fit.log_evidence_without(rows)?))
        .collect()
}

/// Logarithm of the density of each block but the first given those before it, nats; zero for the
/// first. The noise of the gyros is that of the rows before the block. A random walk joins a block that is
/// left out from both sides, and no drift gains beside it.
///
/// # Errors
/// As [`FittedPlatform::log_evidence_of_first`].
pub(crate) fn forward_log_scores(fit: &FittedPlatform<'_>) -> Result<Vec<f64>, CalibrationError> {
    let mut scores = vec![0.0];
    for block in blocks(fit).into_iter().skip(1) {
        // Rows that tell nothing of the noise leave what is believed of it.
        let told = fit.fit_rate_noise_to_first(block.start);
        let noise = told.map_or_else(|_| fit.rate_noise(), |told| told.noise);
        let [before, until] =
            [block.start, block.end].map(|rows| fit.log_evidence_of_first(rows, &noise));
        scores.push(until? - before?);
    }
    Ok(scores)
}

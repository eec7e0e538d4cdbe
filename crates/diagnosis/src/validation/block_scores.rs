//! Predictive log scores under contiguous blocked cross-validation.

use gyrocal_calibration::{CalibrationError, FittedPlatform};

/// Contiguous blocks that are left out in turn. A last-block hold-out would misjudge effects at
/// the start of a record.
pub(crate) const BLOCKS: usize = 6;

/// Logarithm of the density of each block of the record given the others, nats.
///
/// # Errors
/// As [`FittedPlatform::log_evidence_without`].
pub(crate) fn block_log_scores(
    fit: &FittedPlatform<'_>,
) -> Result<[f64; BLOCKS], CalibrationError> {
    let rows = fit.points().len();
    let whole = fit.log_evidence_without(0..0)?;
    let mut scores = [0.0; BLOCKS];
    for (block, score) in scores.iter_mut().enumerate() {
        let left_out = block * rows / BLOCKS..(block + 1) * rows / BLOCKS;
        *score = whole - fit.log_evidence_without(left_out)?;
    }
    Ok(scores)
}

/// Logarithm of the density of each block but the first given those before it, nats; zero for the
/// first. The noise of the gyros is that of the rows before the block. A random walk joins a block that is
/// left out from both sides, and no drift gains beside it.
///
/// # Errors
/// As [`FittedPlatform::log_evidence_of_first`].
pub(crate) fn forward_log_scores(
    fit: &FittedPlatform<'_>,
) -> Result<[f64; BLOCKS], CalibrationError> {
    let rows = fit.points().len();
    let mut scores = [0.0; BLOCKS];
    for (block, score) in scores.iter_mut().enumerate().skip(1) {
        let [first, end] = [block, block + 1].map(|block| block * rows / BLOCKS);
        // Rows that tell nothing of the noise leave what is believed of it.
        let told = fit.fit_rate_noise_to_first(first);
        let noise = told.map_or_else(|_| fit.rate_noise(), |told| told.noise);
        let [before, until] = [first, end].map(|rows| fit.log_evidence_of_first(rows, &noise));
        *score = until? - before?;
    }
    Ok(scores)
}

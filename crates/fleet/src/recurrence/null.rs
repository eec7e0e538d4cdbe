//! Probability of as large an evidence without the cause.
//!
//! Small probabilities need no millions of draws: scores are drawn *with* the cause, as the evidence
//! averages over it, and each draw counts with 1/E, the density without the cause over that with it. The
//! value observed counts as one of the draws, so that the p-value is valid however few they are
//! (Harrison, Biometrika 99, 57, 2012).

use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::exp;

use super::mixture::{Evidence, Pooled, draw_with_cause};
use super::scores::UnitScores;

/// P-value of an evidence. Without evidence it is one, an upper bound.
pub(crate) fn p_value(units: &[UnitScores], ln_e: f64, draws: usize, draw: &mut Draw) -> f64 {
    if ln_e <= 0.0 {
        return 1.0;
    }
    let pooled = Pooled::of(units);
    let mut drawn = units.to_vec();
    let mut sum = exp(-ln_e);
    for _ in 0..draws {
        draw_with_cause(&mut drawn, pooled.as_ref(), draw);
        let reached = Evidence::of(&drawn).ln_e;
        if reached >= ln_e {
            sum += exp(-reached);
        }
    }
    (sum / (draws as f64 + 1.0)).min(1.0)
}

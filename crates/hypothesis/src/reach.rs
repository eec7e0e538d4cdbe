//! How far a hypothesis may lie behind the best and still belong to the set.
//!
//! Among hypotheses that are nearly the same in a record, one that is wrong and fits the noise is often the
//! best: the more of them there are, the farther the true one falls behind. Under a hypothesis h with the
//! signal d = √l_h, the normalised scores are z ~ N(d R_h, R) with R the correlation of the signatures, and
//! its deficit is max_b (z_b² − q_b) − (z_h² − q_h). A hypothesis belongs to the set if its own deficit lies
//! within the 95 % quantile of this, drawn; this inverts the test of each hypothesis.
//!
//! Where many belong to the set by that, most of them for the same record are unlikely together: of those the
//! set has the smallest part that holds nearly all of the likelihood, all effects being as probable before
//! the record. That is the smallest set of its coverage, averaged over effects.

use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::exp;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::bank::ScoreBank;
use crate::finding::{Alternative, CONFIDENCE_SET_DEVIANCE};
use crate::hypothesis::Hypothesis;
use crate::score::Scores;

/// Deficit beyond which a hypothesis is in no set: the 95 % point of chi-square with three degrees of
/// freedom. Signatures that are left beside those of nominal parameters seldom fill more dimensions.
const FARTHEST: f64 = 7.8;

/// Draws: the standard deviation of the share below a 95 % quantile is 0.7 %.
const DRAWS: usize = 1000;

/// Probability that a true hypothesis is in the set.
const COVERAGE: f64 = 0.95;

/// Purpose of the deviates.
const PURPOSE: u64 = 7;

/// Share of the likelihood of all members that the set holds: over 144 simulated records of five plants, at
/// seeds that no figure has, it took one true effect of 139 out of its set.
const MASS: f64 = 0.97;

/// Deficits of the log-likelihood that differ by less are those of the same signature.
const SAME: f64 = 1e-6;

/// Leaves of the alternatives, the most likely first, those that the likelihood of the set needs; the named
/// effect lacks nothing.
pub(crate) fn keep_likely(alternatives: &mut Vec<Alternative>) {
    let likelihood = |other: &Alternative| exp(-other.log_likelihood_deficit);
    let all = 1.0 + alternatives.iter().map(likelihood).sum::<f64>();
    let (mut held, mut last) = (1.0, 0.0);
    let mut kept = 0;
    for other in alternatives.iter() {
        if held >= MASS * all && other.log_likelihood_deficit > last + SAME {
            break;
        }
        held += likelihood(other);
        last = other.log_likelihood_deficit;
        kept += 1;
    }
    alternatives.truncate(kept);
}

/// The largest deficit with which each hypothesis belongs to the set of the named one: never less than
/// [`CONFIDENCE_SET_DEVIANCE`].
pub(crate) fn reaches(
    bank: &ScoreBank,
    hypotheses: &[Hypothesis],
    scores: &Scores<'_>,
    seed: u64,
) -> Vec<f64> {
    let mut reaches = vec![CONFIDENCE_SET_DEVIANCE; hypotheses.len()];
    let column = |index: usize| {
        let best = scores.best[index].as_ref()?;
        match hypotheses[index].variants.get(best.variant)?.columns[..] {
            [column] if best.statistic > 0.0 => Some((index, column)),
            _ => None,
        }
    };
    let all: Vec<(usize, usize)> = (0..hypotheses.len()).filter_map(column).collect();
    let best = all
        .iter()
        .map(|(index, _)| scores.penalised(*index))
        .fold(f64::NEG_INFINITY, f64::max);
    let near: Vec<(usize, usize)> = all
        .into_iter()
        .filter(|(index, _)| best - scores.penalised(*index) < FARTHEST)
        .collect();
    let count = near.len();
    let information = &bank.information;
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        let (a, b) = (near[i].1, near[j].1);
        information[(a, b)] / (information[(a, a)] * information[(b, b)]).sqrt()
    });
    // Signatures that are the same leave it singular.
    let SymmetricEigen {
        mut eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(correlation.clone());
    for (mut vector, value) in eigenvectors.column_iter_mut().zip(eigenvalues.iter()) {
        vector *= value.max(0.0).sqrt();
    }
    let mut draw = Draw::new(seed, PURPOSE);
    let drawn = DMatrix::from_fn(count, DRAWS, |_, _| draw.normal());
    let drawn = eigenvectors * drawn;
    let statistic = |index: usize| scores.best[index].map_or(0.0, |best| best.statistic);
    let penalty: Vec<f64> = near
        .iter()
        .map(|(index, _)| statistic(*index) - scores.penalised(*index))
        .collect();
    for (own, (index, _)) in near.iter().enumerate() {
        if best - scores.penalised(*index) < CONFIDENCE_SET_DEVIANCE {
            continue;
        }
        let mean: DVector<f64> = correlation.column(own) * statistic(*index).sqrt();
        let mut deficits: Vec<f64> = drawn
            .column_iter()
            .map(|noise| {
                let each = noise.iter().zip(mean.iter()).zip(&penalty);
                let each: Vec<f64> = each
                    .map(|((noise, mean), penalty)| (mean + noise).powi(2) - penalty)
                    .collect();
                each.iter().copied().fold(f64::NEG_INFINITY, f64::max) - each[own]
            })
            .collect();
        deficits.sort_unstable_by(f64::total_cmp);
        let quantile = deficits[(COVERAGE * DRAWS as f64) as usize];
        reaches[*index] = reaches[*index].max(quantile.min(FARTHEST));
    }
    reaches
}

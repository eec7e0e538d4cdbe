//! None of these: whether something outside of the catalogue is in a record, beside or in the place of
//! what is named.
//!
//! The rich alternative adds a sum of smooth functions with random amplitudes in one channel to the model:
//! functions of a covariate or of a regressor, products of covariates, covariates times functions of
//! time, switches at zero, and the memory of a covariate. A wrong name leaves what it cannot follow to
//! them. Functions of time alone are left out: no record tells them from a random walk. Each block of
//! functions has amplitudes b ~ N(0, τ² K), and its marginal likelihood over that of the model without
//! it is
//!
//! ```text
//! ln B(τ) = ½ sᵀ (J + K⁻¹/τ²)⁻¹ s − ½ ln |1 + τ² K J|
//! ```
//!
//! with s and J of equations (1) and (2). The prior of τ is that a cause outside of the catalogue leaves
//! at least eight standard deviations beside what is named: along the direction that is seen best, τ²
//! times the information is one of [`RATIOS`]. What leaves less cannot be told apart. B is the mean over
//! these and over all blocks. With the effects h that could be named in the place of a, by (6),
//!
//! ```text
//! P(none) = B / (B + Σ_h exp ½ [(l_h − q_h) − (l_a − q_a)])
//! ```
//!
//! at prior odds of one to one.

use std::sync::Arc;

use gyrocal_statistics::math::{exp, ln, ln_1p};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

use crate::bank::ScoreBank;
use crate::context::SearchContext;
use crate::finding::{Finding, NoneOfThese};
use crate::fitted_stage::FittedStage;
use crate::model::FittedModel;
use crate::pattern::{ChannelIndex, Unmodelled};
use crate::plant::Plant;
use crate::result::ConditionalResult;
use crate::rows::Rows;
use crate::smooth_functions::{Sampling, families};
use gyrocal_inference::Column;

/// Distance over which such functions are correlated, in knots.
const SMOOTH_KNOTS: f64 = 1.5;

/// Squares of the standard deviations that a cause outside of the catalogue leaves: 8, 16 and 32.
const RATIOS: [f64; 3] = [64.0, 256.0, 1024.0];

/// Least information along a direction, over the largest of a function of its block before anything was
/// projected out: less is rounding.
const VISIBLE: f64 = 1e-9;

/// The rich alternative to what is in a fitted model.
struct RichAlternative {
    blocks: Vec<Vec<Direction>>,
}

/// A direction of the amplitudes of a block, independent of the others before and after the record.
struct Direction {
    /// Variance of its prior times its information, over the largest of the block.
    share: f64,
    /// Its score statistic.
    statistic: f64,
}

impl RichAlternative {
    fn new<F: FittedModel>(fitted: &F, rows: &Rows) -> Result<Self, F::Error> {
        let plant = fitted.plant();
        let mut blocks = Vec::new();
        // One sampling, and one channel, after the other: functions and columns of outputs are large.
        for sampling in [Sampling::steps(rows), Sampling::rows(rows)] {
            let families = families(rows, &sampling);
            let channels = ChannelIndex::all(plant).into_iter();
            for channel in channels.filter(|channel| sampling.is_that_of(*channel)) {
                let all = families.iter().flat_map(|family| &family.functions);
                let columns: Vec<Column> =
                    all.map(|values| column(plant, channel, values)).collect();
                if columns.is_empty() {
                    continue;
                }
                let bank = ScoreBank::conditional(fitted, &columns)?;
                let mut first = 0;
                for family in &families {
                    let places: Vec<usize> = (first..first + family.functions.len()).collect();
                    first += places.len();
                    blocks.push(directions(&bank, &places, family.is_smooth));
                }
            }
        }
        Ok(Self { blocks })
    }

    /// Logarithm of its marginal likelihood over that of the model without it.
    fn ln_evidence(&self) -> f64 {
        let all: Vec<f64> = self.blocks.iter().map(|block| ln_evidence(block)).collect();
        ln_mean_exp(&all)
    }
}

/// The directions of a block of functions.
fn directions(bank: &ScoreBank, places: &[usize], is_smooth: bool) -> Vec<Direction> {
    let (information, score) = bank.part(places);
    let lower = factor(places.len(), is_smooth);
    let inner = lower.tr_mul(&information) * &lower;
    let eigen = SymmetricEigen::new(0.5 * (&inner + inner.transpose()));
    let most = eigen.eigenvalues.max();
    let along = eigen.eigenvectors.tr_mul(&lower.tr_mul(&score));
    let whole = places.iter().map(|place| bank.raw[*place]);
    let least = VISIBLE * whole.fold(0.0, f64::max);
    let all = eigen.eigenvalues.iter().zip(along.iter());
    all.filter(|(value, _)| **value > least)
        .map(|(value, along)| Direction {
            share: value / most,
            statistic: along * along / value,
        })
        .collect()
}

fn ln_evidence(block: &[Direction]) -> f64 {
    ln_mean_exp(&RATIOS.map(|ratio| {
        let each = block.iter().map(|direction| {
            let expected = ratio * direction.share;
            0.5 * (direction.statistic * expected / (1.0 + expected) - ln_1p(expected))
        });
        each.sum()
    }))
}

/// Adds what speaks for a cause outside of the catalogue to the findings of a search.
pub(crate) fn add_none_of_these<F: FittedModel>(
    context: &SearchContext<'_>,
    (stage, unmodelled): (&FittedStage<F>, &[Unmodelled]),
    effects: &mut [ConditionalResult],
    walks: &mut [Finding],
) -> Result<(), F::Error> {
    // One set of columns is always paid for, but not beside what a search had only begun to find.
    if effects.is_empty() && walks.is_empty() || context.budget.has_ended_selection() {
        return Ok(());
    }
    let beside = RichAlternative::new(&stage.fitted, &context.rows)?.ln_evidence();
    // Unmodelled terms are such causes, and in the model already.
    let found = unmodelled.iter().map(|found| 0.5 * found.equivalent());
    let ln_rich = found.fold(beside, f64::max);
    // So short a record has none of the functions: nothing was tried that could speak for such a cause.
    if ln_rich == f64::NEG_INFINITY {
        return Ok(());
    }
    for effect in effects {
        effect.finding.none_of_these = Some(over(ln_rich, effect.ln_others));
    }
    for walk in walks {
        walk.none_of_these = Some(over(ln_rich, 0.0));
    }
    Ok(())
}

/// The rich alternative over what is named.
fn over(ln_rich: f64, ln_others: f64) -> NoneOfThese {
    NoneOfThese {
        log_likelihood_ratio: ln_rich - ln_others,
    }
}

fn ln_mean_exp(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most == f64::NEG_INFINITY {
        return most;
    }
    let sum: f64 = values.iter().map(|value| exp(value - most)).sum();
    most + ln(sum / values.len() as f64)
}

/// Factor of the correlation of amplitudes: independent, or smooth from one to the next.
fn factor(count: usize, is_smooth: bool) -> DMatrix<f64> {
    if !is_smooth {
        return DMatrix::identity(count, count);
    }
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        let apart = (i as f64 - j as f64) / SMOOTH_KNOTS;
        exp(-0.5 * apart * apart) + if i == j { 1e-6 } else { 0.0 }
    });
    Cholesky::new(correlation).map_or_else(
        || DMatrix::identity(count, count),
        |cholesky| cholesky.unpack(),
    )
}

fn column(plant: &Plant, channel: ChannelIndex, values: &Arc<[f64]>) -> Column {
    let values = Arc::clone(values);
    match channel {
        ChannelIndex::Rate(rate) => Column::TimeProfile {
            parameter: plant.rates[rate].constant,
            steps: values,
        },
        ChannelIndex::Output(output) => Column::Output {
            output,
            change: values,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_of_one_function_is_the_ratio_of_two_normal_densities() {
        // Information 4 and score 10: the estimate is 2.5, its variance ¼. Under a prior of variance τ² it
        // is N(0, ¼ + τ²), with 4 τ² one of the ratios.
        let bank = ScoreBank {
            score: nalgebra::DVector::from_element(1, 10.0),
            information: DMatrix::from_element(1, 1, 4.0),
            raw: nalgebra::DVector::from_element(1, 4.0),
        };
        let ln_density = |variance: f64| -0.5 * (6.25 / variance + ln(variance));
        let of = |ratio: f64| ln_density(0.25 + ratio / 4.0) - ln_density(0.25);
        let expected = ln_mean_exp(&RATIOS.map(of));
        let difference = ln_evidence(&directions(&bank, &[0], false)) - expected;
        assert!(difference.abs() < 1e-12, "{difference}");
    }

    #[test]
    fn functions_that_the_model_takes_up_are_no_evidence() {
        // All that is left of the function is rounding, whatever its score.
        let bank = ScoreBank {
            score: nalgebra::DVector::from_element(1, 1e-3),
            information: DMatrix::from_element(1, 1, 1e-12),
            raw: nalgebra::DVector::from_element(1, 1.0),
        };
        assert!(directions(&bank, &[0], false).is_empty());
        assert!(ln_evidence(&[]).abs() < 1e-15);
    }

    #[test]
    fn equal_evidence_is_an_even_chance() {
        assert!((over(3.0, 3.0).probability() - 0.5).abs() < 1e-15);
        assert!(over(-800.0, 800.0).probability() < 1e-300);
        assert!((over(900.0, -900.0).probability() - 1.0).abs() < 1e-15);
        // Where the probability rounds to one, the likelihood still tells by how much.
        assert_eq!(over(900.0, -900.0).log_likelihood_ratio, 1800.0);
    }
}

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
//! times the information is one of [`RATIOS`]. What leaves less cannot be told apart. B is the mean over these and
//! over all blocks. With the effects h that could be named in the place of a, by (6),
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
use crate::column::Column;
use crate::context::SearchContext;
use crate::model::FittedModel;
use crate::pattern::{ChannelIndex, Unmodelled};
use crate::plant::Plant;
use crate::result::{ConditionalResult, Finding, FittedStage};
use crate::rows::Rows;

/// Knots of functions of a covariate and of time.
const KNOTS: usize = 7;

/// Distance over which such functions are correlated, in knots.
const SMOOTH_KNOTS: f64 = 1.5;

/// Half-widths of dead zones and plays over half the range of a covariate.
const WIDTHS: [f64; 3] = [0.08, 0.2, 0.45];

/// Lags, h.
const LAGS_H: [f64; 3] = [0.5, 2.0, 8.0];

/// Squares of the standard deviations that a cause outside of the catalogue leaves: 8, 16 and 32.
const RATIOS: [f64; 3] = [64.0, 256.0, 1024.0];

/// Smallest eigenvalue of a correlation over its largest.
const FLOOR: f64 = 1e-9;

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

/// A family of functions: values of each in time, and how their amplitudes are correlated.
struct Family {
    functions: Vec<Vec<f64>>,
    is_smooth: bool,
}

impl RichAlternative {
    fn new<F: FittedModel>(fitted: &F, rows: &Rows) -> Result<Self, F::Error> {
        let plant = fitted.plant();
        let at_rows = families(rows, &Sampling::rows(rows));
        let in_steps = families(rows, &Sampling::steps(rows));
        let mut blocks = Vec::new();
        // One channel after the other: columns of outputs are large.
        for channel in ChannelIndex::all(plant) {
            let families = match channel {
                ChannelIndex::Rate(_) => &in_steps,
                ChannelIndex::Output(_) => &at_rows,
            };
            let all = families.iter().flat_map(|family| family.functions.iter());
            let columns: Vec<Column> = all.map(|values| column(plant, channel, values)).collect();
            if columns.is_empty() {
                continue;
            }
            let bank = ScoreBank::conditional(fitted, &columns)?;
            let mut first = 0;
            for family in families {
                let places: Vec<usize> = (first..first + family.functions.len()).collect();
                first += places.len();
                blocks.push(directions(&bank, &places, family.is_smooth));
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
    let all = eigen.eigenvalues.iter().zip(along.iter());
    all.filter(|(value, _)| **value > 0.0 && **value > FLOOR * most)
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

/// Adds the probability that nothing of the catalogue is the cause to the findings of a search.
pub(crate) fn add_none_of_these<F: FittedModel>(
    context: &SearchContext<'_>,
    (stage, unmodelled): (&FittedStage<F>, &[Unmodelled]),
    effects: &mut [ConditionalResult],
    walks: &mut [Finding],
) -> Result<(), F::Error> {
    if effects.is_empty() && walks.is_empty() || context.budget.is_spent(&stage.fitted) {
        return Ok(());
    }
    let beside = RichAlternative::new(&stage.fitted, &context.rows)?.ln_evidence();
    // Unmodelled terms are such causes, and in the model already.
    let found = unmodelled.iter().map(|found| 0.5 * found.equivalent());
    let ln_rich = found.fold(beside, f64::max);
    for effect in effects {
        effect.finding.none_of_these = Some(probability(ln_rich, effect.ln_others));
    }
    for walk in walks {
        walk.none_of_these = Some(probability(ln_rich, 0.0));
    }
    Ok(())
}

/// Logarithm of the sum of the likelihoods of an effect and of all that could be in its place over its
/// own; `statistics` have the search penalties subtracted.
pub(crate) fn ln_likelihood_of_all(own: f64, statistics: impl Iterator<Item = f64>) -> f64 {
    let others: f64 = statistics
        .map(|other| exp(0.5 * (other - own).min(0.0)))
        .sum();
    ln(1.0 + others)
}

/// Probability of the rich alternative, the prior odds being one to one.
fn probability(ln_rich: f64, ln_others: f64) -> f64 {
    1.0 / (1.0 + exp(ln_others - ln_rich))
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

fn column(plant: &Plant, channel: ChannelIndex, values: &[f64]) -> Column {
    let values: Arc<[f64]> = values.into();
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

/// Times at which functions are sampled: at the rows, or in the middle of the steps.
struct Sampling {
    time_s: Vec<f64>,
    in_steps: bool,
}

impl Sampling {
    fn rows(rows: &Rows) -> Self {
        Self {
            time_s: (0..rows.len()).map(|row| rows.since_first_s(row)).collect(),
            in_steps: false,
        }
    }

    fn steps(rows: &Rows) -> Self {
        let middle = |step: usize| 0.5 * (rows.since_first_s(step) + rows.since_first_s(step + 1));
        Self {
            time_s: (0..rows.len().saturating_sub(1)).map(middle).collect(),
            in_steps: true,
        }
    }

    /// A series over the rows at these times.
    fn of(&self, values: &[f64]) -> Vec<f64> {
        if self.in_steps {
            values
                .windows(2)
                .map(|pair| 0.5 * (pair[0] + pair[1]))
                .collect()
        } else {
            values.to_vec()
        }
    }
}

/// All families of functions.
fn families(rows: &Rows, sampling: &Sampling) -> Vec<Family> {
    let mut families = Vec::new();
    if sampling.time_s.len() < 2 {
        return families;
    }
    let covariates = rows.covariates.iter();
    let moving: Vec<Vec<f64>> = covariates
        .filter(|covariate| range(&covariate.values) >= covariate.least_range)
        .map(|covariate| sampling.of(&covariate.values))
        .collect();
    let regressors = rows.regressors.iter();
    let regressors: Vec<Vec<f64>> = regressors
        .filter(|values| range(values) > 0.0)
        .map(|values| sampling.of(values))
        .collect();
    let smooth = |functions| Family {
        functions,
        is_smooth: true,
    };
    let independent = |functions| Family {
        functions,
        is_smooth: false,
    };
    let times = hats(&sampling.time_s);
    for values in moving.iter().chain(&regressors) {
        families.push(smooth(hats(values)));
    }
    for values in &moving {
        families.push(smooth(
            times.iter().map(|time| product(time, values)).collect(),
        ));
        families.push(independent(switches(values)));
        families.push(independent(memory(&sampling.time_s, values)));
    }
    if moving.len() > 1 {
        families.push(independent(products(&moving)));
    }
    for values in &regressors {
        let with = moving.iter().map(|other| product(values, other));
        families.push(independent(
            with.chain(memory(&sampling.time_s, values)).collect(),
        ));
    }
    families.retain(|family| !family.functions.is_empty());
    families
}

fn ends(values: &[f64]) -> [f64; 2] {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[least, most], value| [least.min(*value), most.max(*value)],
    )
}

fn range(values: &[f64]) -> f64 {
    let [least, most] = ends(values);
    most - least
}

fn product(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter()
        .zip(other)
        .map(|(one, other)| one * other)
        .collect()
}

/// Piecewise linear functions of a variable, from its least to its largest value.
fn hats(values: &[f64]) -> Vec<Vec<f64>> {
    let [least, most] = ends(values);
    let spacing = (most - least) / (KNOTS - 1) as f64;
    let hat =
        |knot: usize, value: f64| (1.0 - ((value - least) / spacing - knot as f64).abs()).max(0.0);
    (0..KNOTS)
        .map(|knot| values.iter().map(|value| hat(knot, *value)).collect())
        .collect()
}

/// Functions that switch about zero, of a variable that changes its sign: the sign, the magnitude, dead
/// zones.
fn switches(values: &[f64]) -> Vec<Vec<f64>> {
    let [least, most] = ends(values);
    if least >= 0.0 || most <= 0.0 {
        return Vec::new();
    }
    let half = 0.5 * (most - least);
    let of = |function: &dyn Fn(f64) -> f64| values.iter().map(|value| function(*value)).collect();
    let mut all: Vec<Vec<f64>> = vec![of(&f64::signum), of(&f64::abs)];
    for width in WIDTHS {
        let width = width * half;
        all.push(of(&|value| value - value.clamp(-width, width)));
    }
    all
}

/// Functions of the past of a variable: its direction, what a play lags behind, what a low-pass lags
/// behind.
fn memory(time_s: &[f64], values: &[f64]) -> Vec<Vec<f64>> {
    let half = 0.5 * range(values);
    let plays = WIDTHS.map(|width| play(values, width * half));
    // The narrowest play tells the direction.
    let first = direction(values, &plays[0]);
    let mut all = vec![first];
    all.extend(plays.iter().map(|play| difference(values, play)));
    all.extend(LAGS_H.map(|lag_h| difference(values, &low_pass(time_s, values, lag_h))));
    all
}

fn difference(values: &[f64], other: &[f64]) -> Vec<f64> {
    values
        .iter()
        .zip(other)
        .map(|(one, other)| one - other)
        .collect()
}

/// Sign of the difference; zero where there is none.
fn direction(values: &[f64], other: &[f64]) -> Vec<f64> {
    let differences = difference(values, other);
    let sign = |value: &f64| if *value == 0.0 { 0.0 } else { value.signum() };
    differences.iter().map(sign).collect()
}

/// Output of a play of this half-width.
fn play(values: &[f64], half_width: f64) -> Vec<f64> {
    let mut state = values.first().copied().unwrap_or(0.0);
    let next = |value: &f64| {
        state = state.clamp(value - half_width, value + half_width);
        state
    };
    values.iter().map(next).collect()
}

/// A first-order low-pass of a series.
fn low_pass(time_s: &[f64], values: &[f64], lag_h: f64) -> Vec<f64> {
    let mut state = values.first().copied().unwrap_or(0.0);
    let mut before = time_s.first().copied().unwrap_or(0.0);
    let pairs = time_s.iter().zip(values);
    pairs
        .map(|(time, value)| {
            let kept = exp(-(time - before) / 3600.0 / lag_h);
            before = *time;
            state = value + kept * (state - value);
            state
        })
        .collect()
}

/// Products of two and of three covariates.
fn products(values: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for i in 0..values.len() {
        for j in i..values.len() {
            let two = product(&values[i], &values[j]);
            all.extend((j..values.len()).map(|k| product(&two, &values[k])));
            all.push(two);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_play_follows_outside_of_its_width() {
        // By hand: a play of half-width one stays until the input is one away, then follows.
        let inputs = [0.0, 0.5, 2.0, 1.5, 0.0, -1.0];
        assert_eq!(play(&inputs, 1.0), vec![0.0, 0.0, 1.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn hats_add_up_to_one_and_bend_at_their_knots() {
        let values = [-1.0, 0.2, 3.0];
        let hats = hats(&values);
        for place in 0..values.len() {
            let sum: f64 = hats.iter().map(|hat| hat[place]).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }

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
    fn equal_evidence_is_an_even_chance() {
        assert!((probability(3.0, 3.0) - 0.5).abs() < 1e-15);
        assert!(probability(-800.0, 800.0) < 1e-300);
        assert!((probability(900.0, -900.0) - 1.0).abs() < 1e-15);
        // One other effect that is as likely.
        assert!((ln_likelihood_of_all(7.0, [7.0].into_iter()) - ln(2.0)).abs() < 1e-15);
    }
}

//! The null distribution of the maximum statistic, drawn from the joint normal distribution of the
//! scores (equations (4) and (5) of the crate).

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use gyrocal_statistics::deviates::polar;
use gyrocal_statistics::{CHI_SQUARE_99, two_sided_p, z_of_two_sided_p};
use nalgebra::{Cholesky, DMatrix, DMatrixView};

use crate::bank::ScoreBank;
use crate::hypothesis::Hypothesis;

/// Draws from the joint distribution: the 1 % point of the largest statistic then rests on 40.
const DRAWS: usize = 4096;

/// Added to the diagonal of the correlations: signatures that are one and the same have a
/// singular matrix. It moves a statistic by a millionth of itself.
const JITTER: f64 = 1e-6;

/// Quantile at which search penalties are equalised: there every hypothesis has the quantile of
/// chi-square with one degree of freedom.
const PENALTY_QUANTILE: f64 = 0.99;

/// What the same quantile of chi-square gains by a second degree of freedom: the penalty of an effect whose fit moves
/// its knee. The detection test takes the knee where it is declared, and subtracts none of it.
const KNEE_PENALTY: f64 = 2.575_443_770_962_76;

/// Fraction of the search penalty that the detection test subtracts; ranking subtracts all of it. A step of
/// five standard deviations would exceed a threshold of 14.5 raised by 6, what searching an onset
/// reaches, with a probability of 0.68, where a constant term exceeds 14.5 with 0.88 (normal
/// distribution about 5): this brings them nearer. The threshold is drawn with it, so that the
/// probability of a false alarm does not depend on it.
pub const DETECTION_PENALTY_FRACTION: f64 = 0.6;

/// A tail of fewer draws says little: beyond these it is that of one degree of freedom.
const TAIL: usize = 10;

/// Signatures whose scores are drawn in one product: the triangle's empty half costs little then.
const PANEL: usize = 32;

/// The null distribution of the maximum statistic, with the search penalties of all hypotheses.
#[derive(Clone, Debug)]
pub(crate) struct NullDistribution {
    /// Excess of each hypothesis over a single signature, from the search over its variants:
    /// hypotheses are ranked after subtracting it.
    pub(crate) penalties: Vec<f64>,
    /// Part of it that is subtracted in the detection test.
    pub(crate) detection_penalties: Vec<f64>,
    /// Maximum statistic of each draw, in rising order.
    max_statistics: Vec<f64>,
}

/// Standard normal deviates that all draws of one search share: [`DRAWS`] for each signature.
pub(crate) struct GaussianDraws {
    /// ChaCha8: see [`gyrocal_statistics::deviates`].
    generator: ChaCha8Rng,
    values: Vec<f64>,
}

impl GaussianDraws {
    pub(crate) fn new(seed: u64) -> Self {
        let mut draws = Self {
            generator: ChaCha8Rng::seed_from_u64(seed),
            values: Vec::new(),
        };
        draws.grow(1);
        draws
    }

    fn grow(&mut self, signatures: usize) {
        while self.values.len() < signatures * DRAWS {
            self.values.push(polar(&mut self.generator));
        }
    }

    /// Independent deviates: a column for each of `count` variables.
    pub(crate) fn normal(&mut self, count: usize) -> DMatrix<f64> {
        self.grow(count + 1);
        DMatrix::from_column_slice(DRAWS, count, &self.values[DRAWS..(count + 1) * DRAWS])
    }

    /// Deviates of the jump hypothesis, drawn independently.
    fn jump(&self) -> &[f64] {
        &self.values[..DRAWS]
    }

    /// Scores of signatures with a correlation of this lower triangular factor: a column each.
    fn scores(&mut self, lower: &DMatrix<f64>) -> DMatrix<f64> {
        let count = lower.nrows();
        self.grow(count + 1);
        let deviates =
            DMatrixView::from_slice(&self.values[DRAWS..(count + 1) * DRAWS], DRAWS, count);
        let mut scores = DMatrix::zeros(DRAWS, count);
        for first in (0..count).step_by(PANEL) {
            let size = PANEL.min(count - first);
            // The factor is zero above its diagonal.
            let known = first + size;
            let factor = lower.view((first, 0), (size, known)).transpose();
            let mut panel = scores.columns_mut(first, size);
            panel.gemm(1.0, &deviates.columns(0, known), &factor, 0.0);
        }
        scores
    }
}

/// Draws of the scores of all signatures.
struct DrawnScores {
    /// Columns of the bank, rising.
    columns: Vec<usize>,
    correlation: DMatrix<f64>,
    /// A row for each draw, a column for each signature.
    scores: DMatrix<f64>,
}

impl DrawnScores {
    /// `None` if the correlation is not positive definite.
    fn new(bank: &ScoreBank, hypotheses: &[Hypothesis], draws: &mut GaussianDraws) -> Option<Self> {
        let mut columns: Vec<usize> = hypotheses
            .iter()
            .flat_map(|hypothesis| hypothesis.variants.iter().flat_map(|v| v.columns.iter()))
            .copied()
            .filter(|column| bank.visible(*column))
            .collect();
        columns.sort_unstable();
        columns.dedup();
        let count = columns.len();
        let scale: Vec<f64> = columns
            .iter()
            .map(|column| bank.information[(*column, *column)].sqrt().recip())
            .collect();
        let mut correlation = DMatrix::from_fn(count, count, |i, j| {
            bank.information[(columns[i], columns[j])] * scale[i] * scale[j]
        });
        for i in 0..count {
            correlation[(i, i)] += JITTER;
        }
        let cholesky = Cholesky::new(correlation.clone())?;
        Some(Self {
            scores: draws.scores(&cholesky.l()),
            columns,
            correlation,
        })
    }

    /// Places of some columns of the bank; `None` if one is not visible.
    fn places(&self, columns: &[usize]) -> Option<Vec<usize>> {
        let place = |column: &usize| self.columns.binary_search(column).ok();
        columns.iter().map(place).collect()
    }

    /// The statistic of a hypothesis in each draw: that of its best variant.
    fn statistics(&self, hypothesis: &Hypothesis) -> Vec<f64> {
        let mut reached = vec![f64::NEG_INFINITY; DRAWS];
        let mut statistic = vec![0.0; DRAWS];
        for variant in &hypothesis.variants {
            let Some(places) = self.places(&variant.columns) else {
                continue;
            };
            let size = places.len();
            let own = DMatrix::from_fn(size, size, |i, j| self.correlation[(places[i], places[j])]);
            let Some(own) = Cholesky::new(own) else {
                continue;
            };
            let inverse = own.inverse();
            statistic.fill(0.0);
            for (i, one) in places.iter().enumerate() {
                for (j, other) in places.iter().enumerate() {
                    let (one, other) = (self.scores.column(*one), self.scores.column(*other));
                    for ((sum, one), other) in statistic.iter_mut().zip(&one).zip(&other) {
                        *sum += inverse[(i, j)] * one * other;
                    }
                }
            }
            for (best, statistic) in reached.iter_mut().zip(&statistic) {
                *best = best.max(*statistic);
            }
        }
        reached
    }
}

impl NullDistribution {
    pub(crate) fn draw(
        bank: &ScoreBank,
        hypotheses: &[Hypothesis],
        draws: &mut GaussianDraws,
    ) -> Self {
        let mut penalties = vec![0.0; hypotheses.len()];
        let Some(drawn) = DrawnScores::new(bank, hypotheses, draws) else {
            return Self {
                detection_penalties: penalties.clone(),
                penalties,
                max_statistics: vec![f64::INFINITY],
            };
        };
        let mut max_statistics = vec![f64::NEG_INFINITY; DRAWS];
        for (hypothesis, penalty) in hypotheses.iter().zip(&mut penalties) {
            let reached = drawn.statistics(hypothesis);
            // The distribution of one signature is known.
            let single =
                matches!(hypothesis.variants.as_slice(), [only] if only.columns.len() == 1);
            if !single {
                let mut sorted = reached.clone();
                let at = (DRAWS as f64 * PENALTY_QUANTILE) as usize;
                let (_, quantile, _) = sorted.select_nth_unstable_by(at, f64::total_cmp);
                if quantile.is_finite() {
                    *penalty = *quantile - CHI_SQUARE_99;
                }
            }
            for (maximum, reached) in max_statistics.iter_mut().zip(&reached) {
                *maximum = maximum.max(reached - DETECTION_PENALTY_FRACTION * *penalty);
            }
        }
        // The jump hypothesis comes with its own p-value, as one more signature.
        if hypotheses.iter().any(|hypothesis| hypothesis.is_jump) {
            for (maximum, deviate) in max_statistics.iter_mut().zip(draws.jump()) {
                *maximum = maximum.max(deviate * deviate);
            }
        }
        max_statistics.sort_unstable_by(f64::total_cmp);
        let detection_penalties = penalties.iter();
        let detection_penalties =
            detection_penalties.map(|penalty| DETECTION_PENALTY_FRACTION * penalty);
        let detection_penalties = detection_penalties.collect();
        for (hypothesis, penalty) in hypotheses.iter().zip(&mut penalties) {
            if hypothesis.effect.has_knee() {
                *penalty += KNEE_PENALTY;
            }
        }
        Self {
            detection_penalties,
            penalties,
            max_statistics,
        }
    }

    /// Without penalties.
    pub(crate) fn without_search(hypotheses: usize) -> Self {
        Self {
            penalties: vec![0.0; hypotheses],
            detection_penalties: vec![0.0; hypotheses],
            max_statistics: vec![0.0],
        }
    }

    /// Quantile of the maximum statistic: it is exceeded with a probability. Beyond what draws can
    /// tell, its tail falls like that of chi-square with one degree of freedom.
    pub(crate) fn threshold(&self, probability: f64) -> f64 {
        let count = self.max_statistics.len() as f64;
        if probability * count < TAIL as f64 {
            let (at, share) = self.join();
            return z_of_two_sided_p(tail(at) * probability / share).powi(2);
        }
        let at = ((1.0 - probability) * count).floor();
        let index = (at.max(0.0) as usize).min(self.max_statistics.len() - 1);
        self.max_statistics[index]
    }

    /// Probability that the largest statistic exceeds a value.
    pub(crate) fn probability(&self, value: f64) -> f64 {
        let below = self
            .max_statistics
            .partition_point(|maximum| *maximum < value);
        let above = self.max_statistics.len() - below;
        if above >= TAIL {
            return above as f64 / self.max_statistics.len() as f64;
        }
        let (at, share) = self.join();
        (share * tail(value) / tail(at)).min(share)
    }

    /// Beginning of the tail beyond the draws, and the probability to be beyond it.
    fn join(&self) -> (f64, f64) {
        let largest = TAIL.min(self.max_statistics.len());
        let share = largest as f64 / self.max_statistics.len() as f64;
        (
            self.max_statistics[self.max_statistics.len() - largest],
            share,
        )
    }
}

/// Upper tail of chi-square with one degree of freedom.
pub(crate) fn tail(value: f64) -> f64 {
    two_sided_p(value.max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_is_exceeded_with_its_probability_however_small() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let mut max_statistics: Vec<f64> =
            (0..DRAWS).map(|_| polar(&mut generator).powi(2)).collect();
        max_statistics.sort_unstable_by(f64::total_cmp);
        let null = NullDistribution {
            penalties: Vec::new(),
            detection_penalties: Vec::new(),
            max_statistics,
        };
        let mut before = 0.0;
        for probability in [0.5, 0.01, 3e-3, 2e-3, 1e-4, 1e-8, 1e-15] {
            let threshold = null.threshold(probability);
            assert!(threshold > before, "{probability}: {threshold}");
            before = threshold;
            // To a draw of 4096, and where there are none to rounding.
            let error = null.probability(threshold) - probability;
            let allowed = if probability > 2.5e-3 {
                1.0 / 4096.0
            } else {
                1e-9 * probability
            };
            assert!(error.abs() <= allowed, "{probability}: {error}");
        }
    }

    #[test]
    fn scores_of_panels_are_the_whole_product() {
        // Two panels and a part of one.
        let count = 2 * PANEL + 5;
        let lower = DMatrix::from_fn(count, count, |i, j| {
            if j <= i {
                1.0 / (1.0 + i as f64 + j as f64)
            } else {
                0.0
            }
        });
        let mut draws = GaussianDraws::new(7);
        let scores = draws.scores(&lower);
        let drawn =
            DMatrix::from_column_slice(DRAWS, count, &draws.values[DRAWS..(count + 1) * DRAWS]);
        let difference = (scores - drawn * lower.transpose()).amax();
        // Sums of 69 products of order one in another order.
        assert!(difference < 1e-13, "{difference}");
        // More signatures do not change the deviates of the first.
        let before = draws.values[..DRAWS].to_vec();
        draws.grow(count + 10);
        assert_eq!(draws.jump(), before);
    }
}

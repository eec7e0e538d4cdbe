//! What the statistics reach if the model is right: drawn from their joint distribution.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use gyrocal_statistics::deviates::polar;
use gyrocal_statistics::{CHI_SQUARE_99, two_sided_p, z_of_two_sided_p};
use nalgebra::{Cholesky, DMatrix, DMatrixView};

use super::bank::Bank;
use super::family::Family;
use super::walk::Walk;

/// Draws from the joint distribution: the 1 % point of the largest statistic then rests on 40.
const DRAWS: usize = 4096;

/// Added to the diagonal of the correlations: signatures that are one and the same have a
/// singular matrix. It moves a statistic by a millionth of itself.
const JITTER: f64 = 1e-6;

/// At this level families are made equal.
const EQUAL_LEVEL: f64 = 0.99;

/// Its quantile of chi-square with one degree of freedom: a family of one signature.
const EQUAL_SINGLE: f64 = CHI_SQUARE_99;

/// The share of its penalty that a family pays in the test of whether anything is there. A step of
/// five standard deviations would exceed a threshold of 14.5 raised by 6, what searching an onset
/// reaches, with a probability of 0.68, where a constant term exceeds 14.5 with 0.88 (normal
/// distribution about 5): this brings them nearer. The threshold is drawn with it, so that the
/// probability of a false alarm does not depend on it.
pub(crate) const DETECTION_PENALTY_FRACTION: f64 = 0.6;

/// A tail of fewer draws says little: beyond these it is that of one degree of freedom.
const TAIL: usize = 10;

/// Signatures whose scores are drawn in one product: the triangle's empty half costs little then.
const PANEL: usize = 32;

/// Null distributions of all families.
#[derive(Clone, Debug)]
pub(crate) struct Null {
    /// What each family reaches more than a single signature would, by searching: families are
    /// compared after subtracting it.
    pub(crate) penalties: Vec<f64>,
    /// What is subtracted in the test of whether anything is there.
    pub(crate) paid: Vec<f64>,
    /// The largest statistic less what its family pays, of each draw, rising.
    maxima: Vec<f64>,
}

/// Normal deviates that all draws of one search share: a row of [`DRAWS`] for each signature.
pub(crate) struct Normals {
    generator: ChaCha8Rng,
    values: Vec<f64>,
}

impl Normals {
    pub(crate) fn new(seed: u64) -> Self {
        let mut normals = Self {
            generator: ChaCha8Rng::seed_from_u64(seed),
            values: Vec::new(),
        };
        normals.grow(1);
        normals
    }

    fn grow(&mut self, signatures: usize) {
        while self.values.len() < signatures * DRAWS {
            self.values.push(polar(&mut self.generator));
        }
    }

    /// Of a knock, which is drawn by itself.
    fn knock(&self) -> &[f64] {
        &self.values[..DRAWS]
    }

    /// Scores of signatures with a correlation of this lower triangular factor: a column each.
    fn scores(&mut self, lower: &DMatrix<f64>) -> DMatrix<f64> {
        let count = lower.nrows();
        self.grow(count + 1);
        let normals =
            DMatrixView::from_slice(&self.values[DRAWS..(count + 1) * DRAWS], DRAWS, count);
        let mut scores = DMatrix::zeros(DRAWS, count);
        for first in (0..count).step_by(PANEL) {
            let size = PANEL.min(count - first);
            // Above the diagonal there is nothing.
            let known = first + size;
            let factor = lower.view((first, 0), (size, known)).transpose();
            let mut panel = scores.columns_mut(first, size);
            panel.gemm(1.0, &normals.columns(0, known), &factor, 0.0);
        }
        scores
    }
}

impl Null {
    pub(crate) fn draw(bank: &Bank, families: &[Family], normals: &mut Normals) -> Self {
        let mut columns: Vec<usize> = families
            .iter()
            .flat_map(|family| {
                let candidates = family.candidates.iter().flat_map(|c| c.columns.iter());
                candidates.chain(family.walk.iter().flatten())
            })
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
        let Some(cholesky) = Cholesky::new(correlation.clone()) else {
            return Self {
                penalties: vec![0.0; families.len()],
                paid: vec![0.0; families.len()],
                maxima: vec![f64::INFINITY],
            };
        };
        let scores = normals.scores(&cholesky.l());
        let place = |column: &usize| columns.binary_search(column).ok();
        let mut penalties = vec![0.0; families.len()];
        let mut maxima = vec![f64::NEG_INFINITY; DRAWS];
        let mut statistic = vec![0.0; DRAWS];
        for (family, penalty) in families.iter().zip(&mut penalties) {
            let mut reached = vec![f64::NEG_INFINITY; DRAWS];
            if let Some(steps) = &family.walk {
                let places: Option<Vec<usize>> = steps.iter().map(place).collect();
                let Some(places) = places else { continue };
                let walk = Walk::new(bank.part(steps).0);
                let mut own = scores.select_columns(&places);
                for (mut column, place) in own.column_iter_mut().zip(&places) {
                    column /= scale[*place];
                }
                reached = walk.best_of_each(&own);
            }
            for candidate in &family.candidates {
                let places: Option<Vec<usize>> = candidate.columns.iter().map(place).collect();
                let Some(places) = places else { continue };
                let size = places.len();
                let own = DMatrix::from_fn(size, size, |i, j| correlation[(places[i], places[j])]);
                let Some(own) = Cholesky::new(own) else {
                    continue;
                };
                let inverse = own.inverse();
                statistic.fill(0.0);
                for (i, one) in places.iter().enumerate() {
                    for (j, other) in places.iter().enumerate() {
                        let (one, other) = (scores.column(*one), scores.column(*other));
                        for ((sum, one), other) in statistic.iter_mut().zip(&one).zip(&other) {
                            *sum += inverse[(i, j)] * one * other;
                        }
                    }
                }
                for (best, statistic) in reached.iter_mut().zip(&statistic) {
                    *best = best.max(*statistic);
                }
            }
            // One signature needs no draws to know its distribution.
            let single = matches!(family.candidates.as_slice(), [only] if only.columns.len() == 1);
            if !single {
                let mut sorted = reached.clone();
                let at = (DRAWS as f64 * EQUAL_LEVEL) as usize;
                let (_, quantile, _) = sorted.select_nth_unstable_by(at, f64::total_cmp);
                if quantile.is_finite() {
                    *penalty = *quantile - EQUAL_SINGLE;
                }
            }
            for (maximum, reached) in maxima.iter_mut().zip(&reached) {
                *maximum = maximum.max(reached - DETECTION_PENALTY_FRACTION * *penalty);
            }
        }
        // A knock comes with its own probability, as one more signature.
        if families.iter().any(|family| family.knock) {
            for (maximum, normal) in maxima.iter_mut().zip(normals.knock()) {
                *maximum = maximum.max(normal * normal);
            }
        }
        maxima.sort_unstable_by(f64::total_cmp);
        Self {
            paid: penalties
                .iter()
                .map(|penalty| DETECTION_PENALTY_FRACTION * penalty)
                .collect(),
            penalties,
            maxima,
        }
    }

    /// Nothing is reached by searching.
    #[cfg(test)]
    pub(crate) fn of_no_search(families: usize) -> Self {
        Self {
            penalties: vec![0.0; families],
            paid: vec![0.0; families],
            maxima: vec![0.0],
        }
    }

    /// What the largest statistic exceeds with a probability. Beyond what draws can
    /// tell, its tail falls like that of chi-square with one degree of freedom.
    pub(crate) fn threshold(&self, probability: f64) -> f64 {
        let count = self.maxima.len() as f64;
        if probability * count < TAIL as f64 {
            let (at, share) = self.join();
            return z_of_two_sided_p(tail(at) * probability / share).powi(2);
        }
        let at = ((1.0 - probability) * count).floor();
        let index = (at.max(0.0) as usize).min(self.maxima.len() - 1);
        self.maxima[index]
    }

    /// Probability that the largest statistic exceeds a value.
    pub(crate) fn probability(&self, value: f64) -> f64 {
        let below = self.maxima.partition_point(|maximum| *maximum < value);
        let above = self.maxima.len() - below;
        if above >= TAIL {
            return above as f64 / self.maxima.len() as f64;
        }
        let (at, share) = self.join();
        (share * tail(value) / tail(at)).min(share)
    }

    /// Where the tail begins that no draws tell, and the probability to be beyond.
    fn join(&self) -> (f64, f64) {
        let largest = TAIL.min(self.maxima.len());
        let share = largest as f64 / self.maxima.len() as f64;
        (self.maxima[self.maxima.len() - largest], share)
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
        let mut maxima: Vec<f64> = (0..DRAWS).map(|_| polar(&mut generator).powi(2)).collect();
        maxima.sort_unstable_by(f64::total_cmp);
        let null = Null {
            penalties: Vec::new(),
            paid: Vec::new(),
            maxima,
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
        let mut normals = Normals::new(7);
        let scores = normals.scores(&lower);
        let drawn =
            DMatrix::from_column_slice(DRAWS, count, &normals.values[DRAWS..(count + 1) * DRAWS]);
        let difference = (scores - drawn * lower.transpose()).amax();
        // Sums of 69 products of order one in another order.
        assert!(difference < 1e-13, "{difference}");
        // More signatures do not change the deviates of the first.
        let before = normals.values[..DRAWS].to_vec();
        normals.grow(count + 10);
        assert_eq!(normals.knock(), before);
    }
}

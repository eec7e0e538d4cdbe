//! What the statistics reach if the model is right: drawn from their joint distribution.

use nalgebra::{Cholesky, DMatrix};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

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
const EQUAL_SINGLE: f64 = 6.634_896_601_021_214;

/// The share of its penalty that a family pays in the test of whether anything is there. A step of
/// five standard deviations would exceed a threshold of 14.5 raised by 6, what searching an onset
/// reaches, with a probability of 0.68, where a constant term exceeds 14.5 with 0.88 (normal
/// distribution about 5): this brings them nearer. The threshold is drawn with it, so that the
/// probability of a false alarm does not depend on it.
const PAID: f64 = 0.6;

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

impl Null {
    pub(crate) fn draw(bank: &Bank, families: &[Family], seed: u64) -> Self {
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
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let normals = DMatrix::from_fn(count, DRAWS, |_, _| normal(&mut generator));
        let scores = cholesky.l() * normals;
        let place = |column: usize| columns.binary_search(&column).ok();
        // For each candidate, what turns its scores into its statistic.
        let mut reached = DMatrix::from_element(families.len(), DRAWS, f64::NEG_INFINITY);
        for (index, family) in families.iter().enumerate() {
            if let Some(steps) = &family.walk {
                let places: Option<Vec<usize>> =
                    steps.iter().map(|column| place(*column)).collect();
                let Some(places) = places else { continue };
                let walk = Walk::new(bank.part(steps).0);
                let own = DMatrix::from_fn(places.len(), DRAWS, |i, draw| {
                    scores[(places[i], draw)] / scale[places[i]]
                });
                for (draw, statistic) in walk.best_of_each(&own).into_iter().enumerate() {
                    reached[(index, draw)] = statistic;
                }
                continue;
            }
            for candidate in &family.candidates {
                let places: Option<Vec<usize>> = candidate
                    .columns
                    .iter()
                    .map(|column| place(*column))
                    .collect();
                let Some(places) = places else { continue };
                let size = places.len();
                let own = DMatrix::from_fn(size, size, |i, j| correlation[(places[i], places[j])]);
                let Some(own) = Cholesky::new(own) else {
                    continue;
                };
                let inverse = own.inverse();
                for draw in 0..DRAWS {
                    let mut statistic = 0.0;
                    for i in 0..size {
                        for j in 0..size {
                            statistic += inverse[(i, j)]
                                * scores[(places[i], draw)]
                                * scores[(places[j], draw)];
                        }
                    }
                    let best = &mut reached[(index, draw)];
                    *best = best.max(statistic);
                }
            }
        }
        let mut penalties = Vec::with_capacity(families.len());
        for index in 0..families.len() {
            let mut row: Vec<f64> = reached.row(index).iter().copied().collect();
            row.retain(|statistic| statistic.is_finite());
            row.sort_unstable_by(f64::total_cmp);
            let at = ((row.len() as f64) * EQUAL_LEVEL) as usize;
            let quantile = row.get(at).copied().unwrap_or(f64::NEG_INFINITY);
            penalties.push(if quantile.is_finite() {
                quantile - EQUAL_SINGLE
            } else {
                0.0
            });
        }
        // One signature needs no draws to know its distribution.
        for (penalty, family) in penalties.iter_mut().zip(families) {
            if let ([only], None) = (family.candidates.as_slice(), &family.walk)
                && only.columns.len() == 1
            {
                *penalty = 0.0;
            }
        }
        let paid: Vec<f64> = penalties.iter().map(|penalty| PAID * penalty).collect();
        let mut maxima: Vec<f64> = (0..DRAWS)
            .map(|draw| {
                (0..families.len())
                    .map(|index| reached[(index, draw)] - paid[index])
                    .fold(f64::NEG_INFINITY, f64::max)
            })
            // A knock comes with its own probability, as one more signature.
            .map(|maximum: f64| {
                if families.iter().any(|family| family.knock) {
                    maximum.max(normal(&mut generator).powi(2))
                } else {
                    maximum
                }
            })
            .collect();
        maxima.sort_unstable_by(f64::total_cmp);
        Self {
            penalties,
            paid,
            maxima,
        }
    }

    /// What the largest statistic exceeds with a probability. Beyond what draws can
    /// tell, its tail falls like that of chi-square with one degree of freedom.
    pub(crate) fn threshold(&self, probability: f64) -> f64 {
        let count = self.maxima.len() as f64;
        let at = ((1.0 - probability) * count).floor();
        let index = (at.max(0.0) as usize).min(self.maxima.len() - 1);
        self.maxima[index]
    }

    /// Probability that the largest statistic exceeds a value.
    pub(crate) fn probability(&self, value: f64) -> f64 {
        let below = self.maxima.partition_point(|maximum| *maximum < value);
        let above = self.maxima.len() - below;
        if above >= 10 {
            return above as f64 / self.maxima.len() as f64;
        }
        // Beyond the draws: the tail of one degree of freedom, joined at the tenth largest.
        let join = self.maxima.len().saturating_sub(10);
        let at = self.maxima[join];
        let share = 10.0 / self.maxima.len() as f64;
        (share * tail(value) / tail(at)).min(share)
    }
}

/// Upper tail of chi-square with one degree of freedom.
pub(crate) fn tail(value: f64) -> f64 {
    crate::two_sided_p(value.max(0.0).sqrt())
}

/// A normal deviate by the polar method (Marsaglia).
pub(crate) fn normal(generator: &mut ChaCha8Rng) -> f64 {
    let mut uniform = || (generator.next_u64() >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0;
    loop {
        let (x, y) = (uniform(), uniform());
        let square = x * x + y * y;
        if square < 1.0 && square > 0.0 {
            return x * (-2.0 * square.ln() / square).sqrt();
        }
    }
}

//! The grid of levels of noise between stops.

use gyrocal_statistics::math::{exp, ln};

use super::between_stops::ln_sum;

/// Kinds of noise between stops: scatter, flicker, walk.
pub(super) const DIMENSIONS: usize = 3;

/// Levels of scatter, flicker and walk, in standard errors of a stop.
pub(super) type Levels = [f64; DIMENSIONS];

/// Least levels that are not zero: half a standard error of a stop widens no sigma by more than an eighth.
const LEAST: f64 = 0.5;

/// Largest ratio of the largest level to the least: what is so much less makes no difference beside it.
const RANGE: f64 = 500.0;

/// Ratios of successive levels of scatter, flicker and walk. Twenty stops of three gyros tell the logarithm of their
/// scatter to an eighth; the levels of the two others are told less well, and grids of three to a decade gave the same
/// share of false terms.
const RATIOS: Levels = [1.2, 2.0, 2.0];

/// Spread of the levels of the gyros of one unit, as a standard deviation of their logarithm, and the share of gyros
/// whose levels have nothing to do with those of the others.
const SPREAD: f64 = 0.35;
const APART: f64 = 0.2;

/// All combinations of levels.
#[derive(Clone)]
pub(super) struct Grid {
    axes: [Vec<f64>; DIMENSIONS],
    /// Probability of each level of one gyro given that which is common to the gyros: row by common level.
    kernels: [Vec<Vec<f64>>; DIMENSIONS],
}

impl Grid {
    /// Up to a level, with scatter or without.
    pub(super) fn new(largest: f64, has_scatter: bool) -> Self {
        let axes = core::array::from_fn(|dimension| {
            let mut axis = vec![0.0];
            if dimension == 0 && !has_scatter {
                return axis;
            }
            let largest = if largest.is_finite() {
                largest.max(LEAST)
            } else {
                LEAST
            };
            let mut level = LEAST.max(largest / RANGE);
            while level <= largest {
                axis.push(level);
                level *= RATIOS[dimension];
            }
            axis
        });
        Self::of_axes(axes)
    }

    fn of_axes(axes: [Vec<f64>; DIMENSIONS]) -> Self {
        let kernels = core::array::from_fn(|dimension| kernel(&axes[dimension], RATIOS[dimension]));
        Self { axes, kernels }
    }

    /// The levels of this grid from a least to a largest one of each kind.
    pub(super) fn within(&self, ranges: [[f64; 2]; DIMENSIONS]) -> Self {
        let mut axes = self.axes.clone();
        for (axis, [least, largest]) in axes.iter_mut().zip(ranges) {
            axis.retain(|level| (least..=largest).contains(level));
        }
        Self::of_axes(axes)
    }

    pub(super) fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    /// Levels of scatter, of which all combinations with [`Self::pairs`] follow one another in the grid.
    pub(super) fn scatter(&self) -> &[f64] {
        &self.axes[0]
    }

    /// All pairs of levels of flicker and walk, the latter fastest.
    pub(super) fn pairs(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let [_, flicker, walk] = &self.axes;
        let flicker = flicker.iter();
        flicker.flat_map(|flicker| walk.iter().map(|walk| [*flicker, *walk]))
    }

    /// Likelihoods of the levels that are common to the gyros from those of one gyro, whose levels are near the common
    /// ones or anywhere; all as logarithms.
    pub(super) fn common(&self, of_gyro: &[f64]) -> Vec<f64> {
        self.moved(of_gyro, |kernel, common, own| kernel[common][own])
    }

    /// Probabilities of the levels of a gyro from those of the common ones.
    pub(super) fn of_gyro(&self, common: &[f64]) -> Vec<f64> {
        self.moved(common, |kernel, own, common| kernel[common][own])
    }

    fn moved(&self, logs: &[f64], share: fn(&[Vec<f64>], usize, usize) -> f64) -> Vec<f64> {
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut near: Vec<f64> = logs.iter().map(|one| exp(one - largest)).collect();
        let anywhere = exp(ln_sum(logs) - largest) / self.len() as f64;
        let mut stride = self.len();
        for (axis, kernel) in self.axes.iter().zip(&self.kernels) {
            let count = axis.len();
            stride /= count;
            let mut moved = vec![0.0; near.len()];
            for (place, sum) in moved.iter_mut().enumerate() {
                let own = place / stride % count;
                let first = place - own * stride;
                for other in 0..count {
                    *sum += share(kernel, own, other) * near[first + other * stride];
                }
            }
            near = moved;
        }
        let mixed = near
            .iter()
            .map(|one| (1.0 - APART) * one + APART * anywhere);
        mixed.map(|one| largest + ln(one)).collect()
    }

    /// The level of one kind that a share of the weights does not exceed.
    pub(super) fn quantile(&self, weights: &[f64], dimension: usize, share: f64) -> f64 {
        let axis = &self.axes[dimension];
        let mut sums = vec![0.0; axis.len()];
        let stride: usize = self.axes[dimension + 1..].iter().map(Vec::len).product();
        for (place, weight) in weights.iter().enumerate() {
            sums[place / stride % axis.len()] += weight;
        }
        let mut below = 0.0;
        for (level, sum) in axis.iter().zip(&sums) {
            below += sum;
            if below >= share {
                return *level;
            }
        }
        axis.last().copied().unwrap_or(0.0)
    }
}

/// Probability of each level of an axis given each common one. Zero counts as one step below the least.
fn kernel(axis: &[f64], ratio: f64) -> Vec<Vec<f64>> {
    let least = axis.get(1).copied().unwrap_or(LEAST) / ratio;
    let logarithm = |level: f64| ln(if level > 0.0 { level } else { least });
    let row = |common: &f64| {
        let normal = |level: &f64| {
            let off = (logarithm(*level) - logarithm(*common)) / SPREAD;
            exp(-0.5 * off * off)
        };
        let row: Vec<f64> = axis.iter().map(normal).collect();
        let sum: f64 = row.iter().sum();
        row.into_iter().map(|one| one / sum).collect()
    };
    axis.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_is_bounded_whatever_the_scatter() {
        for largest in [0.0, 1.0, 1e3, 1e9, f64::INFINITY, f64::NAN] {
            let grid = Grid::new(largest, true);
            // 36 levels of scatter and 10 of the others over the range, and zero of each.
            assert!(grid.len() <= 37 * 11 * 11, "{largest}: {}", grid.len());
            assert_eq!(grid.scatter().len() * grid.pairs().count(), grid.len());
        }
    }

    #[test]
    fn probabilities_stay_probabilities() {
        let grid = Grid::new(20.0, true);
        let mut common = vec![f64::NEG_INFINITY; grid.len()];
        common[grid.len() / 2] = 0.0;
        let sum: f64 = grid.of_gyro(&common).iter().map(|one| exp(*one)).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        // A gyro of which nothing is known tells nothing of the others.
        let flat = grid.common(&vec![-3.0; grid.len()]);
        assert!(flat.iter().all(|one| (one + 3.0).abs() < 1e-12));
    }
}

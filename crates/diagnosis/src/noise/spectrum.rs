//! Spectrum of the accelerometer noise, averaged over blocks.

use gyrocal_statistics::upper_median;

use super::block::Basis;

/// Rows of the longest block.
const MOST_ROWS: usize = 64;
/// Rows of the shortest block.
const LEAST_ROWS: usize = 16;
/// Longest block: variations within about an hour are noise.
const LONGEST_BLOCK_S: f64 = 4000.0;
/// Rows in which the filter settles and its prediction is not smooth.
pub(crate) const SETTLING_ROWS: usize = 32;
/// Excess power of a block over the median, in standard deviations, beyond which it is left out (an
/// attitude jump, a power failure). Of noise alone less than one block in a million exceeds it.
const EXCESS_POWER_SIGMAS: f64 = 7.0;

/// Sums over blocks, axis by axis.
pub(crate) struct Spectrum {
    pub(crate) basis: Basis,
    pub(crate) axes: [AxisSpectrum; 3],
}

/// Sums over the blocks of one axis.
#[derive(Default)]
pub(crate) struct AxisSpectrum {
    /// Number of blocks.
    pub(crate) blocks: usize,
    /// Squared coefficient of each cosine, summed.
    pub(crate) power: Vec<f64>,
    /// Sum of the squared fractions of present values: observed part of the spectrum.
    pub(crate) seen: f64,
    /// Part of the variance that missing values spread over the whole spectrum.
    pub(crate) scattered: f64,
    /// Sum of the variances of the steps of the random walk, times the observed part.
    pub(crate) walk: f64,
}

struct Block {
    powers: Vec<f64>,
    present: f64,
    walk: f64,
}

impl Spectrum {
    /// From residuals in declared standard deviations, `NaN` where there is none, and the
    /// variance of the random walk's step at each row in the same unit.
    pub(crate) fn new(
        open: &[[f64; 3]],
        walk: impl Fn(usize, usize) -> f64,
        runs: &[core::ops::Range<usize>],
        interval_s: f64,
    ) -> Self {
        let rows = ((LONGEST_BLOCK_S / interval_s) as usize)
            .clamp(LEAST_ROWS, MOST_ROWS)
            .next_power_of_two();
        let rows = if rows as f64 * interval_s > LONGEST_BLOCK_S {
            rows / 2
        } else {
            rows
        };
        let basis = Basis::new(rows.max(LEAST_ROWS));
        let axes = core::array::from_fn(|axis| {
            let mut blocks = Vec::new();
            let mut values = vec![0.0; basis.rows()];
            for run in runs {
                let start = run.start.max(SETTLING_ROWS);
                for first in (start..run.end).step_by(basis.rows()) {
                    if first + basis.rows() > run.end {
                        break;
                    }
                    for (value, row) in values.iter_mut().zip(&open[first..]) {
                        *value = row[axis];
                    }
                    if let Some((powers, present)) = basis.powers(&values) {
                        let walk = walk(first + basis.rows() / 2, axis);
                        blocks.push(Block {
                            powers,
                            present,
                            walk,
                        });
                    }
                }
            }
            AxisSpectrum::gather(blocks, basis.len())
        });
        Self { basis, axes }
    }

    /// Number of blocks of all axes.
    pub(crate) fn blocks(&self) -> usize {
        self.axes.iter().map(|axis| axis.blocks).sum()
    }
}

impl AxisSpectrum {
    fn gather(mut blocks: Vec<Block>, cosines: usize) -> Self {
        let mut totals: Vec<f64> = blocks.iter().map(Block::total).collect();
        let usual = upper_median(&mut totals).unwrap_or(0.0);
        let most = usual * (1.0 + EXCESS_POWER_SIGMAS * (2.0 / cosines as f64).sqrt());
        blocks.retain(|block| block.total() <= most);
        let mut sums = Self {
            power: vec![0.0; cosines],
            blocks: blocks.len(),
            ..Self::default()
        };
        for block in &blocks {
            let seen = block.present * block.present;
            sums.seen += seen;
            sums.scattered += block.present - seen;
            sums.walk += seen * block.walk;
            for (sum, power) in sums.power.iter_mut().zip(&block.powers) {
                *sum += power;
            }
        }
        sums
    }
}

impl Block {
    fn total(&self) -> f64 {
        self.powers.iter().sum::<f64>() / self.present
    }
}

//! A figure of the table: what is asked for and what was measured.

use core::ops::Range;

use gyrocal_campaign::statistics::{Proportion, mean, standard_error};
use serde::{Deserialize, Serialize};

/// Confidence of the intervals that are shown.
const CONFIDENCE: f64 = 0.95;

/// A population smaller than the one that a figure is asked for on cannot meet a target: it fails
/// one if it shows, with this confidence, that the true value misses it.
const SHOWN: f64 = 0.999;

/// The same as a point of the normal distribution.
const SIGMAS_SHOWN: f64 = 3.090_232_306_167_813;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// No less than this.
    AtLeast(f64),
    /// No more than this.
    AtMost(f64),
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Characteristic {
    /// The cell that it was measured in.
    pub cell: String,
    /// What is measured.
    pub figure: String,
    /// What it should be; `None` if it only informs.
    pub target: Option<Target>,
    /// What it is; `None` if there was nothing to measure it on.
    pub measured: Option<f64>,
    /// Its 95 % interval, of shares that of Clopper and Pearson.
    pub interval: Option<[f64; 2]>,
    /// Records that it was measured on.
    pub runs: u64,
    /// The first seed of the cell and the one after the last.
    pub seeds: [u64; 2],
    /// Whether the target is met or, of a population smaller than asked for, not shown to be
    /// missed.
    pub holds: Option<bool>,
}

/// The figures of one cell, as they are gathered.
pub(crate) struct Gathered {
    pub(crate) cell: String,
    pub(crate) seeds: Range<u64>,
    /// Whether there are as many records as the figures are asked for on.
    pub(crate) full: bool,
    pub(crate) all: Vec<Characteristic>,
}

impl Gathered {
    fn push(
        &mut self,
        figure: &str,
        target: Option<Target>,
        measured: f64,
        interval: Option<[f64; 2]>,
        runs: u64,
        holds: Option<bool>,
    ) {
        self.all.push(Characteristic {
            cell: self.cell.clone(),
            figure: figure.to_owned(),
            target,
            measured: measured.is_finite().then_some(measured),
            interval: interval.filter(|_| runs > 0),
            runs,
            seeds: [self.seeds.start, self.seeds.end],
            holds,
        });
    }

    /// A share that should be no less than something.
    pub(crate) fn at_least(&mut self, figure: &str, least: f64, of: Proportion) {
        let holds = if self.full {
            of.share() >= least
        } else {
            of.trials == 0 || of.upper_bound(SHOWN) >= least
        };
        self.share(figure, Some(Target::AtLeast(least)), of, Some(holds));
    }

    /// A share that should be no more than something.
    pub(crate) fn at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let holds = if self.full {
            of.share() <= most
        } else {
            of.trials == 0 || of.lower_bound(SHOWN) <= most
        };
        self.share(figure, Some(Target::AtMost(most)), of, Some(holds));
    }

    /// A share whose upper 95 % bound should be no more than something.
    pub(crate) fn bound_at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let bound = of.upper_bound(CONFIDENCE);
        let holds = if self.full {
            bound <= most
        } else {
            of.lower_bound(SHOWN) <= most
        };
        let target = Some(Target::AtMost(most));
        self.push(figure, target, bound, None, of.trials, Some(holds));
    }

    /// The smallest of some shares, each of which a sample this small must not show to be less
    /// than something.
    pub(crate) fn none_below(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let worst = all
            .iter()
            .min_by(|one, other| one.share().total_cmp(&other.share()));
        let Some(worst) = worst else { return };
        let confidence = if self.full { CONFIDENCE } else { SHOWN };
        let holds = all.iter().all(|of| of.upper_bound(confidence) >= least);
        self.share(figure, Some(Target::AtLeast(least)), *worst, Some(holds));
    }

    /// A share that only informs.
    pub(crate) fn note(&mut self, figure: &str, of: Proportion) {
        self.share(figure, None, of, None);
    }

    fn share(&mut self, figure: &str, target: Option<Target>, of: Proportion, holds: Option<bool>) {
        let interval = of.interval(CONFIDENCE);
        self.push(figure, target, of.share(), Some(interval), of.trials, holds);
    }

    /// A number that should be 0.
    pub(crate) fn none(&mut self, figure: &str, count: usize, of: u64) {
        let target = Some(Target::AtMost(0.0));
        self.push(figure, target, count as f64, None, of, Some(count == 0));
    }

    /// A mean that only informs.
    pub(crate) fn mean(&mut self, figure: &str, values: &[f64]) {
        self.push(figure, None, mean(values), None, values.len() as u64, None);
    }

    /// The ratio of two means over the same records that should be no more than something.
    pub(crate) fn ratio_at_most(&mut self, figure: &str, most: f64, pairs: &[[f64; 2]]) {
        let column = |which: usize| -> Vec<f64> { pairs.iter().map(|pair| pair[which]).collect() };
        let ratio = mean(&column(0)) / mean(&column(1));
        let excess: Vec<f64> = pairs.iter().map(|pair| pair[0] - most * pair[1]).collect();
        // The excess is what the ratio is more, in records: its mean is normal for tens of them.
        let least = mean(&excess) - SIGMAS_SHOWN * standard_error(&excess);
        let holds = if self.full {
            ratio <= most
        } else {
            // Of one record or none nothing is shown.
            least.is_nan() || least <= 0.0
        };
        let target = Some(Target::AtMost(most));
        let runs = pairs.len() as u64;
        self.push(figure, target, ratio, None, runs, Some(holds));
    }
}

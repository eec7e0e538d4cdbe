//! A figure of the table: what is asked for and what was measured.

use core::ops::Range;

use gyrocal_statistics::{NORMAL_97_5, Proportion, mean, standard_error};
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

    /// The average of some shares, each counting the same, that should be no less than something.
    pub(crate) fn average_at_least(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let average = mean(&all.iter().map(Proportion::share).collect::<Vec<_>>());
        let variance = all.iter().map(Proportion::variance).sum::<f64>();
        let sigma = variance.sqrt() / all.len() as f64;
        let up_to = |sigmas: f64| f64::min(average + sigmas * sigma, 1.0);
        let interval = [
            f64::max(average - NORMAL_97_5 * sigma, 0.0),
            up_to(NORMAL_97_5),
        ];
        let holds = if self.full {
            average >= least
        } else {
            all.is_empty() || up_to(SIGMAS_SHOWN) >= least
        };
        let target = Some(Target::AtLeast(least));
        let runs = all.iter().map(|of| of.trials).sum();
        self.push(figure, target, average, Some(interval), runs, Some(holds));
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

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(full: bool, judge: impl Fn(&mut Gathered)) -> Option<bool> {
        let mut gathered = Gathered {
            cell: String::new(),
            seeds: 0..10,
            full,
            all: Vec::new(),
        };
        judge(&mut gathered);
        gathered.all[0].holds
    }

    #[test]
    fn a_full_population_must_meet_a_target_and_a_small_one_must_not_miss_it() {
        let of = |hits, trials| Proportion { hits, trials };
        let least =
            |full, hits, trials| judged(full, |all| all.at_least("", 0.9, of(hits, trials)));
        assert_eq!(least(true, 900, 1000), Some(true));
        assert_eq!(least(true, 899, 1000), Some(false));
        // 0.8 of ten says little about 0.9; 0.4 is shown to be less: its 99.9 % bound is 0.83.
        assert_eq!(least(false, 8, 10), Some(true));
        assert_eq!(least(false, 4, 10), Some(false));
        let most = |full, hits, trials| judged(full, |all| all.at_most("", 0.1, of(hits, trials)));
        assert_eq!(most(true, 101, 1000), Some(false));
        assert_eq!(most(false, 2, 10), Some(true));
        assert_eq!(most(false, 6, 10), Some(false));
        // The upper bound of 27 of 2000 is below 2 %, that of 30 is not.
        let bound = |hits| judged(true, |all| all.bound_at_most("", 0.02, of(hits, 2000)));
        assert_eq!((bound(27), bound(33)), (Some(true), Some(false)));
        // Each counts the same, whatever its trials.
        let averaged = |full, all: &[Proportion]| {
            judged(full, |gathered| gathered.average_at_least("", 0.6, all))
        };
        let (all, few) = (of(30, 30), of(2, 10));
        assert_eq!(averaged(true, &[all, few]), Some(true));
        assert_eq!(averaged(true, &[all, few, few]), Some(false));
        // (0.25 + 0.27) / 2 with a sigma of about 0.07.
        assert_eq!(averaged(false, &[of(5, 20), of(6, 22)]), Some(false));
        assert_eq!(averaged(false, &[of(0, 1), of(1, 1)]), Some(true));
        // One family of two that misses all of its twenty records.
        let families = [of(20, 20), of(0, 20)];
        assert_eq!(
            judged(true, |all| all.none_below("", 0.8, &families)),
            Some(false)
        );
        assert_eq!(
            judged(true, |all| all.none_below("", 0.8, &families[..1])),
            Some(true)
        );
    }

    #[test]
    fn sizes_are_compared_in_the_mean() {
        let ratio =
            |full, pairs: &[[f64; 2]]| judged(full, |all| all.ratio_at_most("", 1.2, pairs));
        let fine = [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]];
        let large = [[3.0, 2.0], [3.0, 2.0], [3.1, 2.0]];
        assert_eq!(
            (ratio(true, &fine), ratio(true, &large)),
            (Some(true), Some(false))
        );
        assert_eq!(
            (ratio(false, &fine), ratio(false, &large)),
            (Some(true), Some(false))
        );
        // One that is off among others shows nothing.
        assert_eq!(
            ratio(false, &[[5.0, 1.0], [1.0, 1.0], [1.0, 1.0]]),
            Some(true)
        );
    }
}

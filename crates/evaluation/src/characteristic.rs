//! Operating characteristics: measured figures with their targets.

use core::ops::Range;

use gyrocal_statistics::{NORMAL_97_5, Proportion, mean, standard_error};
use serde::{Deserialize, Serialize};

/// Confidence of reported intervals.
const CONFIDENCE: f64 = 0.95;

/// Confidence of a rejection: a population smaller than the target asks for misses the target if it
/// rejects, with this confidence, that the true value meets it.
const REJECTION_CONFIDENCE: f64 = 0.999;

/// The same, as a one-sided point of the normal distribution.
const REJECTION_SIGMAS: f64 = 3.090_232_306_167_813;

/// Target of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// At least this.
    AtLeast(f64),
    /// At most this.
    AtMost(f64),
}

/// One measured figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Characteristic {
    /// Name of the cell.
    pub cell: String,
    /// Name of the figure.
    pub figure: String,
    /// Its target; `None` for information only.
    pub target: Option<Target>,
    /// Its value; `None` without records to measure it on.
    pub measured: Option<f64>,
    /// Its 95 % interval; for fractions that of Clopper and Pearson.
    pub interval: Option<[f64; 2]>,
    /// Number of records that it was measured on.
    pub runs: u64,
    /// The first seed of the cell and the one after the last.
    pub seeds: [u64; 2],
    /// `true` if the target is met or, for a population smaller than the target asks for, not
    /// rejected; `None` without a target.
    pub holds: Option<bool>,
}

/// Builder of the figures of one cell.
pub(crate) struct CellFigures {
    pub(crate) cell: String,
    pub(crate) seeds: Range<u64>,
    /// `true` if the population is as large as the targets ask for.
    pub(crate) full: bool,
    pub(crate) all: Vec<Characteristic>,
}

impl CellFigures {
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

    /// A fraction with a lower limit.
    pub(crate) fn at_least(&mut self, figure: &str, least: f64, of: Proportion) {
        let holds = if self.full {
            of.share() >= least
        } else {
            of.trials == 0 || of.upper_bound(REJECTION_CONFIDENCE) >= least
        };
        self.share(figure, Some(Target::AtLeast(least)), of, Some(holds));
    }

    /// The unweighted average of fractions, with a lower limit.
    pub(crate) fn average_at_least(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let average = mean(all.iter().map(Proportion::share));
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
            all.is_empty() || up_to(REJECTION_SIGMAS) >= least
        };
        let target = Some(Target::AtLeast(least));
        let runs = all.iter().map(|of| of.trials).sum();
        self.push(figure, target, average, Some(interval), runs, Some(holds));
    }

    /// A fraction with an upper limit.
    pub(crate) fn at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let holds = if self.full {
            of.share() <= most
        } else {
            of.trials == 0 || of.lower_bound(REJECTION_CONFIDENCE) <= most
        };
        self.share(figure, Some(Target::AtMost(most)), of, Some(holds));
    }

    /// The upper 95 % confidence bound of a fraction, with an upper limit.
    pub(crate) fn bound_at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let bound = of.upper_bound(CONFIDENCE);
        let holds = if self.full {
            bound <= most
        } else {
            of.lower_bound(REJECTION_CONFIDENCE) <= most
        };
        let target = Some(Target::AtMost(most));
        self.push(figure, target, bound, None, of.trials, Some(holds));
    }

    /// The smallest of several fractions, with a lower limit that none of them may be shown to miss.
    pub(crate) fn none_below(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let worst = all
            .iter()
            .min_by(|one, other| one.share().total_cmp(&other.share()));
        let Some(worst) = worst else { return };
        let confidence = if self.full {
            CONFIDENCE
        } else {
            REJECTION_CONFIDENCE
        };
        let holds = all.iter().all(|of| of.upper_bound(confidence) >= least);
        self.share(figure, Some(Target::AtLeast(least)), *worst, Some(holds));
    }

    /// A fraction without a target.
    pub(crate) fn note(&mut self, figure: &str, of: Proportion) {
        self.share(figure, None, of, None);
    }

    fn share(&mut self, figure: &str, target: Option<Target>, of: Proportion, holds: Option<bool>) {
        let interval = of.interval(CONFIDENCE);
        self.push(figure, target, of.share(), Some(interval), of.trials, holds);
    }

    /// A count that should be 0.
    pub(crate) fn none(&mut self, figure: &str, count: usize, of: u64) {
        let target = Some(Target::AtMost(0.0));
        self.push(figure, target, count as f64, None, of, Some(count == 0));
    }

    /// A mean without a target.
    pub(crate) fn mean(&mut self, figure: &str, values: &[f64]) {
        self.push(figure, None, mean(values), None, values.len() as u64, None);
    }

    /// The ratio of two means over the same records, with an upper limit.
    pub(crate) fn ratio_at_most(&mut self, figure: &str, most: f64, pairs: &[[f64; 2]]) {
        let column = |which: usize| -> Vec<f64> { pairs.iter().map(|pair| pair[which]).collect() };
        let ratio = mean(column(0)) / mean(column(1));
        let excess: Vec<f64> = pairs.iter().map(|pair| pair[0] - most * pair[1]).collect();
        // The ratio exceeds the limit if the mean of this difference is positive; over tens of records
        // that mean is normal.
        let least = mean(&excess) - REJECTION_SIGMAS * standard_error(&excess);
        let holds = if self.full {
            ratio <= most
        } else {
            // One record or none cannot reject.
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

    fn judged(full: bool, judge: impl Fn(&mut CellFigures)) -> Option<bool> {
        let mut figures = CellFigures {
            cell: String::new(),
            seeds: 0..10,
            full,
            all: Vec::new(),
        };
        judge(&mut figures);
        figures.all[0].holds
    }

    #[test]
    fn a_full_population_must_meet_a_target_and_a_small_one_must_not_reject_it() {
        let of = |hits, trials| Proportion { hits, trials };
        let least =
            |full, hits, trials| judged(full, |all| all.at_least("", 0.9, of(hits, trials)));
        assert_eq!(least(true, 900, 1000), Some(true));
        assert_eq!(least(true, 899, 1000), Some(false));
        // 0.8 of ten does not reject 0.9; 0.4 does: its 99.9 % bound is 0.83.
        assert_eq!(least(false, 8, 10), Some(true));
        assert_eq!(least(false, 4, 10), Some(false));
        let most = |full, hits, trials| judged(full, |all| all.at_most("", 0.1, of(hits, trials)));
        assert_eq!(most(true, 101, 1000), Some(false));
        assert_eq!(most(false, 2, 10), Some(true));
        assert_eq!(most(false, 6, 10), Some(false));
        // The upper bound of 27 of 2000 is below 2 %, that of 30 is not.
        let bound = |hits| judged(true, |all| all.bound_at_most("", 0.02, of(hits, 2000)));
        assert_eq!((bound(27), bound(33)), (Some(true), Some(false)));
        // Unweighted, whatever the number of trials.
        let averaged = |full, all: &[Proportion]| {
            judged(full, |figures| figures.average_at_least("", 0.6, all))
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
        // One outlier among others does not reject.
        assert_eq!(
            ratio(false, &[[5.0, 1.0], [1.0, 1.0], [1.0, 1.0]]),
            Some(true)
        );
    }
}

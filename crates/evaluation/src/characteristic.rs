//! Operating characteristics: measured figures with their targets.

use core::ops::Range;

use gyrocal_statistics::{Judgement, NORMAL_97_5, Proportion, mean, standard_error};
use serde::{Deserialize, Serialize};

/// Confidence of reported intervals.
const CONFIDENCE: f64 = 0.95;

/// One-sided points of the normal distribution at which a population smaller than the target asks for
/// shows that the target is met (95 %) or missed (99.9 %), as [`Judgement`] has them.
const MET_SIGMAS: f64 = 1.644_853_626_951_472_2;
const MISSED_SIGMAS: f64 = 3.090_232_306_167_813;

/// Target of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// At least this.
    AtLeast(f64),
    /// At most this.
    AtMost(f64),
}

/// One measured figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    /// `true` if the target is met; `None` without a target, and for a population smaller than the
    /// target asks for that shows neither that it is met nor that it is missed.
    pub holds: Option<bool>,
    /// `true` if the records are too few to tell whether the target is met.
    pub too_few: bool,
    /// Hits and trials of a fraction; `None` for other figures.
    #[serde(skip)]
    pub share: Option<Proportion>,
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
        judged: Option<Judgement>,
    ) {
        self.all.push(Characteristic {
            cell: self.cell.clone(),
            figure: figure.to_owned(),
            target,
            measured: measured.is_finite().then_some(measured),
            interval: interval.filter(|_| runs > 0),
            runs,
            seeds: [self.seeds.start, self.seeds.end],
            holds: judged.and_then(Judgement::holds),
            too_few: judged == Some(Judgement::TooFew),
            share: None,
        });
    }

    /// A fraction with a lower limit.
    pub(crate) fn at_least(&mut self, figure: &str, least: f64, of: Proportion) {
        let judged = if self.full {
            decided(of.share() >= least)
        } else {
            of.at_least(least)
        };
        self.share(figure, Some(Target::AtLeast(least)), of, Some(judged));
    }

    /// The unweighted average of fractions, with a lower limit.
    pub(crate) fn average_at_least(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let average = mean(all.iter().map(Proportion::share));
        let variance = all.iter().map(Proportion::variance).sum::<f64>();
        let sigma = variance.sqrt() / all.len() as f64;
        let at = |sigmas: f64| (average + sigmas * sigma).clamp(0.0, 1.0);
        let judged = if self.full {
            decided(average >= least)
        } else {
            Judgement::of(at(-MET_SIGMAS) >= least, at(MISSED_SIGMAS) < least)
        };
        let target = Some(Target::AtLeast(least));
        let runs = all.iter().map(|of| of.trials).sum();
        let interval = [-NORMAL_97_5, NORMAL_97_5].map(at);
        self.push(figure, target, average, Some(interval), runs, Some(judged));
    }

    /// A fraction with an upper limit.
    pub(crate) fn at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let judged = if self.full {
            decided(of.share() <= most)
        } else {
            of.at_most(most)
        };
        self.share(figure, Some(Target::AtMost(most)), of, Some(judged));
    }

    /// The upper 95 % confidence bound of a fraction, with an upper limit.
    pub(crate) fn bound_at_most(&mut self, figure: &str, most: f64, of: Proportion) {
        let bound = of.upper_bound(CONFIDENCE);
        let judged = if self.full {
            decided(bound <= most)
        } else {
            of.at_most(most)
        };
        let target = Some(Target::AtMost(most));
        self.push(figure, target, bound, None, of.trials, Some(judged));
    }

    /// The smallest of several fractions, with a lower limit for each of them. Each has a part of the
    /// records only, which in a full population, too, may be too few to tell.
    pub(crate) fn none_below(&mut self, figure: &str, least: f64, all: &[Proportion]) {
        let worst = all
            .iter()
            .min_by(|one, other| one.share().total_cmp(&other.share()));
        let Some(worst) = worst else { return };
        let met = |of: &Proportion| of.at_least(least) == Judgement::Met;
        let missed = |of: &Proportion| match self.full {
            true => of.upper_bound(CONFIDENCE) < least,
            false => of.at_least(least) == Judgement::Missed,
        };
        let judged = Judgement::of(all.iter().all(met), all.iter().any(missed));
        self.share(figure, Some(Target::AtLeast(least)), *worst, Some(judged));
    }

    /// A fraction without a target.
    pub(crate) fn note(&mut self, figure: &str, of: Proportion) {
        self.share(figure, None, of, None);
    }

    fn share(
        &mut self,
        figure: &str,
        target: Option<Target>,
        of: Proportion,
        judged: Option<Judgement>,
    ) {
        let interval = of.interval(CONFIDENCE);
        self.push(
            figure,
            target,
            of.share(),
            Some(interval),
            of.trials,
            judged,
        );
        if let Some(last) = self.all.last_mut() {
            last.share = Some(of);
        }
    }

    /// A count that should be 0.
    pub(crate) fn none(&mut self, figure: &str, count: usize, of: u64) {
        let target = Some(Target::AtMost(0.0));
        let judged = Some(decided(count == 0));
        self.push(figure, target, count as f64, None, of, judged);
    }

    /// A mean without a target.
    pub(crate) fn mean(&mut self, figure: &str, values: &[f64]) {
        self.push(figure, None, mean(values), None, values.len() as u64, None);
    }

    /// The ratio of two means over the same records, with an upper limit.
    pub(crate) fn ratio_at_most(&mut self, figure: &str, most: f64, pairs: &[[f64; 2]]) {
        self.ratio(figure, Target::AtMost(most), pairs);
    }

    /// The same with a lower limit.
    pub(crate) fn ratio_at_least(&mut self, figure: &str, least: f64, pairs: &[[f64; 2]]) {
        self.ratio(figure, Target::AtLeast(least), pairs);
    }

    fn ratio(&mut self, figure: &str, target: Target, pairs: &[[f64; 2]]) {
        let column = |which: usize| -> Vec<f64> { pairs.iter().map(|pair| pair[which]).collect() };
        let ratio = mean(column(0)) / mean(column(1));
        // The target is missed if the mean of this difference is positive; over tens of records that mean is
        // normal.
        let excess = |pair: &[f64; 2]| match target {
            Target::AtMost(most) => pair[0] - most * pair[1],
            Target::AtLeast(least) => least * pair[1] - pair[0],
        };
        let excess: Vec<f64> = pairs.iter().map(excess).collect();
        let at = |sigmas: f64| mean(&excess) + sigmas * standard_error(&excess);
        let judged = if self.full {
            decided(mean(&excess) <= 0.0)
        } else {
            // One record or none has no standard error, and shows neither.
            Judgement::of(at(MET_SIGMAS) <= 0.0, at(-MISSED_SIGMAS) > 0.0)
        };
        let runs = pairs.len() as u64;
        self.push(figure, Some(target), ratio, None, runs, Some(judged));
    }
}

/// The judgement of a population as large as the target asks for: by the value itself.
fn decided(met: bool) -> Judgement {
    Judgement::of(met, !met)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(full: bool, judge: impl FnOnce(&mut CellFigures)) -> Option<bool> {
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
    fn a_full_population_meets_a_target_or_not_and_a_small_one_may_be_too_small_to_tell() {
        let of = |hits, trials| Proportion { hits, trials };
        let least =
            |full, hits, trials| judged(full, |all| all.at_least("", 0.9, of(hits, trials)));
        assert_eq!(least(true, 900, 1000), Some(true));
        assert_eq!(least(true, 899, 1000), Some(false));
        // 0.8 of ten does not reject 0.9; 0.4 does: its 99.9 % bound is 0.83. 30 of 30 show 0.905.
        assert_eq!(least(false, 8, 10), None);
        assert_eq!(least(false, 4, 10), Some(false));
        assert_eq!(least(false, 10, 10), None);
        assert_eq!(least(false, 30, 30), Some(true));
        let most = |full, hits, trials| judged(full, |all| all.at_most("", 0.1, of(hits, trials)));
        assert_eq!(most(true, 101, 1000), Some(false));
        assert_eq!(most(false, 2, 10), None);
        assert_eq!(most(false, 0, 10), None);
        assert_eq!(most(false, 0, 29), Some(true));
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
        assert_eq!(averaged(false, &[of(0, 1), of(1, 1)]), None);
        assert_eq!(averaged(false, &[of(30, 30), of(30, 30)]), Some(true));
    }

    #[test]
    fn families_of_few_records_are_too_few_to_tell_in_a_full_population_too() {
        let of = |hits, trials| Proportion { hits, trials };
        let families = |least, all: &[Proportion]| {
            let mut figures = None;
            let holds = judged(true, |of| {
                of.none_below("", least, all);
                figures = Some(of.all[0].too_few);
            });
            (holds, figures)
        };
        // One of two that misses all of its twenty records.
        let (all, none) = (of(20, 20), of(0, 20));
        assert_eq!(families(0.8, &[all, none]), (Some(false), Some(false)));
        assert_eq!(families(0.8, &[all]), (Some(true), Some(false)));
        // 45 of 45 show no more than 0.936.
        assert_eq!(families(0.99, &[of(45, 45)]), (None, Some(true)));
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
        // One outlier among others does not reject, and confirms nothing.
        assert_eq!(ratio(false, &[[5.0, 1.0], [1.0, 1.0], [1.0, 1.0]]), None);
        assert_eq!(ratio(false, &[[1.0, 1.0]]), None);
        let least =
            |full, pairs: &[[f64; 2]]| judged(full, |all| all.ratio_at_least("", 0.95, pairs));
        assert_eq!(
            (least(true, &fine), least(true, &[[1.8, 2.0], [1.0, 1.0]])),
            (Some(true), Some(false))
        );
        // Half of what the oracle finds, in hundreds of records.
        let half: Vec<[f64; 2]> = (0..400).map(|index| [f64::from(index % 2), 1.0]).collect();
        assert_eq!(
            (least(false, &half), least(false, &half[..4])),
            (Some(false), None)
        );
    }
}

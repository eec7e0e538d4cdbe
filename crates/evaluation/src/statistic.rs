//! Statistics over the records of a population, and their judgement against targets.
//!
//! A rate is judged by its 95 % bound: it misses its target where the exact one-sided 95 % bound excludes it. So a
//! program whose true rate is that of the target passes in nineteen of twenty populations, whatever their size,
//! where a comparison of the measured rate itself would fail every second one. A population smaller than the target
//! asks for misses it at 99.9 % only, as tens of targets are judged at once, and meets it if the other 95 % bound
//! does; between these it is too small to tell.

use gyrocal_statistics::{
    Judgement, NORMAL_97_5, Proportion, mean, median, quantile, standard_error,
};
use serde::{Deserialize, Serialize};

/// Confidence of reported intervals, two-sided, and of bounds, one-sided.
const CONFIDENCE: f64 = 0.95;

/// One-sided points of the normal distribution: 95 % and 99.9 %.
const BOUND_SIGMAS: f64 = 1.644_853_626_951_472_2;
const MISSED_SIGMAS: f64 = 3.090_232_306_167_813;

/// One-sided confidence at which a small population misses its target.
const MISSED: f64 = 0.999;

/// Target of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Target {
    /// At least this.
    AtLeast(f64),
    /// At most this.
    AtMost(f64),
    /// Between these, both included.
    Between([f64; 2]),
}

impl Target {
    /// The least and the largest value that meet it.
    #[must_use]
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::AtLeast(least) => [least, f64::INFINITY],
            Self::AtMost(most) => [f64::NEG_INFINITY, most],
            Self::Between(range) => range,
        }
    }
}

impl core::fmt::Display for Target {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::AtLeast(least) => write!(f, ">= {least}"),
            Self::AtMost(most) => write!(f, "<= {most}"),
            Self::Between([least, most]) => write!(f, "{least} to {most}"),
        }
    }
}

/// A statistic over the records of a population.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Statistic {
    /// A share of the records.
    Share(Proportion),
    /// The upper 95 % bound of a share.
    Bound(Proportion),
    /// The unweighted average of shares.
    Average(Vec<Proportion>),
    /// The least of several shares; each has a part of the records only.
    Least(Vec<Proportion>),
    /// The mean of one number a record.
    Mean(Vec<f64>),
    /// The median of one number a record.
    Median(Vec<f64>),
    /// The ratio of the means of two numbers a record.
    Ratio(Vec<[f64; 2]>),
    /// The ratio of the root mean squares of two numbers a record.
    RmsRatio(Vec<[f64; 2]>),
    /// A number without scatter, and its number of runs.
    Value(f64, u64),
}

/// What a statistic states of the true value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    /// One-sided bounds of 95 %.
    bounds: [f64; 2],
    /// One-sided bounds of 99.9 %.
    far: [f64; 2],
}

impl Range {
    fn of(bounds: impl Fn(f64, f64) -> [f64; 2]) -> Self {
        Self {
            bounds: bounds(CONFIDENCE, BOUND_SIGMAS),
            far: bounds(MISSED, MISSED_SIGMAS),
        }
    }

    fn exact(share: &Proportion) -> Self {
        Self::of(|confidence, _| [share.lower_bound(confidence), share.upper_bound(confidence)])
    }

    fn normal(value: f64, sigma: f64) -> Self {
        Self::of(|_, sigmas| [value - sigmas * sigma, value + sigmas * sigma])
    }
}

impl Statistic {
    /// Share of the records for which `of` is true, among those for which it is anything.
    pub fn share<R>(records: &[R], of: impl Fn(&R) -> Option<bool>) -> Self {
        Self::Share(Proportion::of(records.iter().filter_map(of)))
    }

    /// Share of all items of all records that are true. Items of one record depend on each other: the share counts
    /// as that of so many independent ones as scatter over records like these.
    pub fn each<R, I: IntoIterator<Item = bool>>(records: &[R], of: impl Fn(&R) -> I) -> Self {
        let all = records.iter().map(|record| Proportion::of(of(record)));
        let all: Vec<Proportion> = all.filter(|share| share.trials > 0).collect();
        Self::Share(independent(&all))
    }

    /// The measured value; NaN without records.
    #[must_use]
    pub fn value(&self) -> f64 {
        match self {
            Self::Share(share) => share.share(),
            Self::Bound(share) => share.upper_bound(CONFIDENCE),
            Self::Average(all) => mean(all.iter().map(Proportion::share)),
            Self::Least(all) => least(all).map_or(f64::NAN, |least| least.share()),
            Self::Mean(values) => mean(values),
            Self::Median(values) => median(values),
            Self::Ratio(pairs) => mean(column(pairs, 0)) / mean(column(pairs, 1)),
            Self::RmsRatio(pairs) => Self::Ratio(squares(pairs)).value().sqrt(),
            Self::Value(value, _) => *value,
        }
    }

    /// Its two-sided 95 % interval: that of Clopper and Pearson for a share, a normal one for an average of
    /// shares; `None` for other statistics.
    #[must_use]
    pub fn interval(&self) -> Option<[f64; 2]> {
        match self {
            Self::Share(share) => Some(share.interval(CONFIDENCE)),
            Self::Least(all) => Some(least(all)?.interval(CONFIDENCE)),
            Self::Average(all) => {
                let sigma = sigma_of_average(all);
                let at = |z: f64| (self.value() + z * sigma).clamp(0.0, 1.0);
                Some([-NORMAL_97_5, NORMAL_97_5].map(at))
            }
            _ => None,
        }
    }

    /// Number of records that it is measured on.
    #[must_use]
    pub fn runs(&self) -> u64 {
        match self {
            Self::Share(share) | Self::Bound(share) => share.trials,
            Self::Average(all) => all.iter().map(|share| share.trials).sum(),
            Self::Least(all) => least(all).map_or(0, |least| least.trials),
            Self::Mean(values) | Self::Median(values) => values.len() as u64,
            Self::Ratio(pairs) | Self::RmsRatio(pairs) => pairs.len() as u64,
            Self::Value(_, runs) => *runs,
        }
    }

    /// The share that it is, or that its bound is of.
    #[must_use]
    pub fn proportion(&self) -> Option<Proportion> {
        match self {
            Self::Share(share) | Self::Bound(share) => Some(*share),
            Self::Least(all) => least(all).copied(),
            _ => None,
        }
    }

    /// Judgement against a target by a population as large as the target asks for (`full`), or by a smaller one.
    #[must_use]
    pub fn judged(&self, target: Target, full: bool) -> Judgement {
        let normal = |sigma| judged(Range::normal(self.value(), sigma), target, full);
        match self {
            Self::Value(value, _) => {
                let [least, most] = target.range();
                let met = least <= *value && *value <= most;
                Judgement::of(met, !met)
            }
            // The bound itself is to meet the target.
            Self::Bound(share) => match (target, full) {
                (Target::AtMost(most), false) => share.at_most(most),
                _ => {
                    let met = self.value() <= target.range()[1];
                    Judgement::of(met, !met)
                }
            },
            Self::Least(all) => {
                // In a full population, too, a part of the records may be too few to tell.
                let [least, _] = target.range();
                let met = all.iter().all(|of| Range::exact(of).bounds[0] >= least);
                let missed = |share: &Proportion| match full {
                    true => Range::exact(share).bounds[1] < least,
                    false => Range::exact(share).far[1] < least,
                };
                Judgement::of(met, all.iter().any(missed))
            }
            Self::Ratio(pairs) => ratio_judged(pairs, target.range(), full),
            Self::RmsRatio(pairs) => {
                // Both sides squared; a limit below zero is none.
                let range = target.range().map(|limit| limit * limit.abs());
                ratio_judged(&squares(pairs), range, full)
            }
            Self::Share(share) if share.trials > 0 => judged(Range::exact(share), target, full),
            Self::Average(all) => normal(sigma_of_average(all)),
            // One record or none has no standard error, and shows nothing.
            Self::Mean(values) if values.len() > 1 => normal(standard_error(values)),
            Self::Median(values) if values.len() > 1 => judged(of_median(values), target, full),
            Self::Share(_) | Self::Mean(_) | Self::Median(_) => Judgement::TooFew,
        }
    }
}

/// The mean of one number less the limit times the mean of the other is normal over tens of records.
fn ratio_judged(pairs: &[[f64; 2]], [least, most]: [f64; 2], full: bool) -> Judgement {
    if pairs.len() < 2 {
        return Judgement::TooFew;
    }
    let side = |(limit, sign): (f64, f64)| {
        let excess = pairs.iter().map(|pair| sign * (pair[0] - limit * pair[1]));
        let excess: Vec<f64> = excess.collect();
        let range = Range::normal(mean(&excess), standard_error(&excess));
        judged(range, Target::AtMost(0.0), full)
    };
    let sides = [(least, -1.0), (most, 1.0)].into_iter();
    let sides = sides.filter(|(limit, _)| limit.is_finite());
    let judgements: Vec<Judgement> = sides.map(side).collect();
    Judgement::of(
        judgements.iter().all(|one| *one == Judgement::Met),
        judgements.contains(&Judgement::Missed),
    )
}

fn squares(pairs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let square = |pair: &[f64; 2]| pair.map(|value| value * value);
    pairs.iter().map(square).collect()
}

/// A range against a target.
fn judged(range: Range, target: Target, full: bool) -> Judgement {
    let [least, most] = target.range();
    let excluded = |[low, high]: [f64; 2]| high < least || low > most;
    if full {
        let missed = excluded(range.bounds);
        return Judgement::of(!missed, missed);
    }
    let [low, high] = range.bounds;
    Judgement::of(least <= low && high <= most, excluded(range.far))
}

/// Bounds of a median by the order statistics of a sign test.
fn of_median(values: &[f64]) -> Range {
    let count = values.len() as f64;
    Range::of(|_, sigmas| {
        // Number of values below the median: normal with this share of scatter.
        let half_width = 0.5 * sigmas / count.sqrt();
        [0.5 - half_width, 0.5 + half_width].map(|share| quantile(values, share.clamp(0.0, 1.0)))
    })
}

/// The number of independent items that are as certain as those of these records, at least one a record, and those of
/// them that are true.
fn independent(records: &[Proportion]) -> Proportion {
    let sum = |of: &dyn Fn(&Proportion) -> f64| -> f64 { records.iter().map(of).sum() };
    let trials = sum(&|record| record.trials as f64);
    let share = sum(&|record| record.hits as f64) / trials;
    let count = records.len() as f64;
    let scatter = sum(&|record| {
        let excess = record.hits as f64 - share * record.trials as f64;
        excess * excess
    });
    // Of records whose items agree with each other.
    let most = trials / count;
    let effect = scatter / (trials * share * (1.0 - share)) * count / (count - 1.0);
    let effect = if effect.is_finite() { effect } else { most };
    let trials = (trials / effect.clamp(1.0, most.max(1.0))).round();
    Proportion {
        hits: (share * trials).round() as u64,
        trials: trials as u64,
    }
}

fn least(all: &[Proportion]) -> Option<&Proportion> {
    all.iter()
        .min_by(|one, other| one.share().total_cmp(&other.share()))
}

fn sigma_of_average(all: &[Proportion]) -> f64 {
    let variance: f64 = all.iter().map(Proportion::variance).sum();
    variance.sqrt() / all.len() as f64
}

fn column(pairs: &[[f64; 2]], which: usize) -> Vec<f64> {
    pairs.iter().map(|pair| pair[which]).collect()
}

#[cfg(test)]
mod tests;

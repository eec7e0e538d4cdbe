//! One row of a table of figures: a statistic over a population, its target, and the reason of the target.

use gyrocal_evaluation::{Statistic, Target};
use gyrocal_statistics::Proportion;

use super::population::Records;
use super::{COVERAGE, COVERAGE_REASON};
use crate::figure::Figure;

/// A statistic over the records of a population.
pub(crate) struct Row<'a, R> {
    name: String,
    target: Option<Target>,
    /// Why the target is what it is.
    reason: &'static str,
    of: Of<'a, R>,
    /// Words behind the statistic.
    remark: Option<Remark<'a, R>>,
}

/// Words about all records.
type Remark<'a, R> = Box<dyn Fn(&[R]) -> String + 'a>;

/// What a row says of all records.
type Of<'a, R> = Box<dyn Fn(&[R]) -> Measured + 'a>;

/// What a row says.
enum Measured {
    Statistic(Statistic),
    /// Words, and the number of runs that they are of.
    Words(String, usize),
}

impl<'a, R> Row<'a, R> {
    fn made(name: impl Into<String>, of: impl Fn(&[R]) -> Measured + 'a) -> Self {
        Self {
            name: name.into(),
            target: None,
            reason: "",
            of: Box::new(of),
            remark: None,
        }
    }

    /// A statistic of all records.
    pub(crate) fn new(name: impl Into<String>, of: impl Fn(&[R]) -> Statistic + 'a) -> Self {
        Self::made(name, move |records| Measured::Statistic(of(records)))
    }

    /// The number of something in all records.
    pub(crate) fn count(name: impl Into<String>, of: impl Fn(&R) -> usize + 'a) -> Self {
        Self::new(name, move |records| {
            let all: usize = records.iter().map(&of).sum();
            Statistic::Value(all as f64, records.len() as u64)
        })
    }

    /// The largest of one number a record; NaN if one is.
    pub(crate) fn largest(name: impl Into<String>, of: impl Fn(&R) -> f64 + 'a) -> Self {
        Self::new(name, move |records| {
            let larger = |most: f64, one: f64| match most.is_nan() || one <= most {
                true => most,
                false => one,
            };
            let largest = records.iter().map(&of).fold(0.0, larger);
            Statistic::Value(largest, records.len() as u64)
        })
    }

    /// The share of records for which `of` is true, among those for which it is anything.
    pub(crate) fn share(name: impl Into<String>, of: impl Fn(&R) -> Option<bool> + 'a) -> Self {
        Self::new(name, move |records| Statistic::share(records, &of))
    }

    /// The share of all items of all records that are true.
    pub(crate) fn each<I: IntoIterator<Item = bool>>(
        name: impl Into<String>,
        of: impl Fn(&R) -> I + 'a,
    ) -> Self {
        Self::new(name, move |records| Statistic::each(records, &of))
    }

    /// The upper 95 % bound of a share.
    pub(crate) fn bound(name: impl Into<String>, of: impl Fn(&R) -> bool + 'a) -> Self {
        Self::new(name, move |records| {
            Statistic::Bound(Proportion::of(records.iter().map(&of)))
        })
    }

    /// The mean of one number a record.
    pub(crate) fn mean(name: impl Into<String>, of: impl Fn(&R) -> Option<f64> + 'a) -> Self {
        Self::of_each(name, of, Statistic::Mean)
    }

    /// The median of one number a record.
    pub(crate) fn median(name: impl Into<String>, of: impl Fn(&R) -> Option<f64> + 'a) -> Self {
        Self::of_each(name, of, Statistic::Median)
    }

    /// The ratio of the means of two numbers a record.
    pub(crate) fn ratio(name: impl Into<String>, of: impl Fn(&R) -> Option<[f64; 2]> + 'a) -> Self {
        Self::of_each(name, of, Statistic::Ratio)
    }

    /// The ratio of the root mean squares of two numbers a record.
    pub(crate) fn rms_ratio(
        name: impl Into<String>,
        of: impl Fn(&R) -> Option<[f64; 2]> + 'a,
    ) -> Self {
        Self::of_each(name, of, Statistic::RmsRatio)
    }

    fn of_each<T: 'a>(
        name: impl Into<String>,
        of: impl Fn(&R) -> Option<T> + 'a,
        make: fn(Vec<T>) -> Statistic,
    ) -> Self {
        Self::new(name, move |records| {
            make(records.iter().filter_map(&of).collect())
        })
    }

    /// Words about all records, without a target.
    pub(crate) fn words(name: impl Into<String>, of: impl Fn(&[R]) -> String + 'a) -> Self {
        Self::made(name, move |records| {
            Measured::Words(of(records), records.len())
        })
    }

    /// With words behind the statistic.
    pub(crate) fn told(self, remark: impl Fn(&[R]) -> String + 'a) -> Self {
        let remark: Option<Remark<'a, R>> = Some(Box::new(remark));
        Self { remark, ..self }
    }

    /// With a lower limit.
    pub(crate) fn at_least(self, least: f64, reason: &'static str) -> Self {
        self.with_target(Target::AtLeast(least), reason)
    }

    /// With an upper limit.
    pub(crate) fn at_most(self, most: f64, reason: &'static str) -> Self {
        self.with_target(Target::AtMost(most), reason)
    }

    /// With both.
    pub(crate) fn between(self, range: [f64; 2], reason: &'static str) -> Self {
        self.with_target(Target::Between(range), reason)
    }

    /// With the limits of the coverage of 95 % intervals.
    pub(crate) fn of_coverage(self) -> Self {
        self.between(COVERAGE, COVERAGE_REASON)
    }

    /// With a target.
    pub(crate) fn with_target(self, target: Target, reason: &'static str) -> Self {
        Self {
            target: Some(target),
            reason,
            ..self
        }
    }

    /// The figure of these records.
    pub(super) fn figure(&self, of: &Records<R>) -> Figure {
        let mut figure = match (self.of)(&of.records) {
            Measured::Statistic(statistic) => {
                Figure::of_statistic(&self.name, &statistic, self.target, of.full)
            }
            Measured::Words(words, runs) => Figure::note(&self.name, words).over(runs, ""),
        };
        if let Some(remark) = &self.remark {
            figure.measured += &format!("; {}", remark(&of.records));
        }
        let runs = figure.runs;
        Figure {
            reason: self.reason.to_owned(),
            ..figure.over(runs, of.seeds.as_str())
        }
    }
}

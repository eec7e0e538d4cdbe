//! Operating characteristics: measured figures with their targets.

use core::ops::Range;

use gyrocal_statistics::{Judgement, Proportion};
use serde::{Deserialize, Serialize};

use crate::record_score::RecordScore;
use crate::statistic::{Statistic, Target};

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
}

impl Characteristic {
    /// A statistic of a cell, which is as large as its targets ask for (`full`), or smaller.
    pub(crate) fn of(cell: &str, seeds: &Range<u64>, full: bool, of: &Measure) -> Self {
        let (measured, runs) = (of.statistic.value(), of.statistic.runs());
        let judged = of
            .target
            .map(|(target, _)| of.statistic.judged(target, full));
        Self {
            cell: cell.to_owned(),
            figure: of.figure.to_owned(),
            target: of.target.map(|(target, _)| target),
            measured: measured.is_finite().then_some(measured),
            interval: of.statistic.interval().filter(|_| runs > 0),
            runs,
            seeds: [seeds.start, seeds.end],
            holds: judged.and_then(Judgement::holds),
            too_few: judged == Some(Judgement::TooFew),
        }
    }
}

/// A statistic over the records of a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// Name of the figure.
    pub figure: &'static str,
    /// The statistic.
    pub statistic: Statistic,
    /// Its target and the reason of it; `None` for information only.
    pub target: Option<(Target, &'static str)>,
}

impl Measure {
    /// A statistic without a target.
    pub(crate) fn new(figure: &'static str, statistic: Statistic) -> Self {
        Self {
            figure,
            statistic,
            target: None,
        }
    }

    /// The share of records for which `of` is true, among those for which it is anything.
    pub(crate) fn share(
        figure: &'static str,
        records: &[&RecordScore],
        of: impl Fn(&RecordScore) -> Option<bool>,
    ) -> Self {
        let share = Proportion::of(records.iter().filter_map(|record| of(record)));
        Self::new(figure, Statistic::Share(share))
    }

    /// With a target, and its reason.
    pub(crate) fn with_target(self, target: Target, reason: &'static str) -> Self {
        Self {
            target: Some((target, reason)),
            ..self
        }
    }

    pub(crate) fn at_least(self, least: f64, reason: &'static str) -> Self {
        self.with_target(Target::AtLeast(least), reason)
    }

    pub(crate) fn at_most(self, most: f64, reason: &'static str) -> Self {
        self.with_target(Target::AtMost(most), reason)
    }
}

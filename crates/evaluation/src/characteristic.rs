//! Operating characteristics: measured figures with their targets.

use core::ops::Range;

use gyrocal_statistics::{Judgement, Proportion};
use serde::{Deserialize, Serialize};

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
    /// A statistic with a target.
    pub(crate) fn judge(&mut self, figure: &str, target: Target, of: Statistic) {
        let judgement = of.judged(target, self.full);
        self.push(figure, Some(target), of, Some(judgement));
    }

    /// A statistic without a target.
    pub(crate) fn note(&mut self, figure: &str, of: Statistic) {
        self.push(figure, None, of, None);
    }

    /// A count that should be 0.
    pub(crate) fn none(&mut self, figure: &str, count: usize, of: u64) {
        self.judge(
            figure,
            Target::AtMost(0.0),
            Statistic::Value(count as f64, of),
        );
    }

    fn push(
        &mut self,
        figure: &str,
        target: Option<Target>,
        of: Statistic,
        judged: Option<Judgement>,
    ) {
        let (measured, runs) = (of.value(), of.runs());
        self.all.push(Characteristic {
            cell: self.cell.clone(),
            figure: figure.to_owned(),
            target,
            measured: measured.is_finite().then_some(measured),
            interval: of.interval().filter(|_| runs > 0),
            runs,
            seeds: [self.seeds.start, self.seeds.end],
            holds: judged.and_then(Judgement::holds),
            too_few: judged == Some(Judgement::TooFew),
            // The number of a bound is not its share.
            share: of.proportion().filter(|share| share.share() == measured),
        });
    }
}

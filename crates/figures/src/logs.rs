//! Instrument tests on simulated logs whose errors are known.

mod allan;
mod oracle;
mod positions;
mod rates;
mod rates_simulation;
pub(crate) mod records;
mod stops;
mod vertical;

use gyrocal_statistics::Proportion;

use crate::error::Error;
use crate::figure::{Figure, coverage};
use crate::truth::Extent;

/// Range of a coverage of 95 %.
const COVERAGE: [f64; 2] = [0.93, 0.97];

/// Cells of fewer intervals hold if the exact 99.9 % interval of their coverage contains 95 %.
const LARGE_CELL: usize = 1000;

/// All figures of the topic.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = allan::figures(extent)?;
    figures.extend(positions::figures(extent)?);
    figures.extend(stops::figures(extent)?);
    figures.extend(vertical::figures(extent)?);
    figures.extend(rates::figures(extent)?);
    Ok(figures)
}

/// Share of 95 % intervals that contain the truth.
fn covered(name: &str, hits: impl IntoIterator<Item = bool>, seeds: &str, small: bool) -> Figure {
    let share = Proportion::of(hits);
    let count = share.trials as usize;
    let mut figure = Figure::within(name, COVERAGE, share.share()).of_share(share);
    let judgement = coverage(share, COVERAGE);
    if small {
        figure = figure.judged(judgement);
    } else if count < LARGE_CELL {
        figure.holds = Some(judgement != gyrocal_statistics::Judgement::Missed);
    }
    figure.over(count, seeds)
}

/// Share that is to be at least a target.
fn at_least(
    name: &str,
    target: f64,
    hits: impl IntoIterator<Item = bool>,
    seeds: &str,
    small: bool,
) -> Figure {
    let share = Proportion::of(hits);
    let mut figure = Figure::within(name, [target, f64::INFINITY], share.share()).of_share(share);
    if small {
        figure = figure.judged(share.at_least(target));
    }
    figure.over(share.trials as usize, seeds)
}

//! Operating characteristics of the diagnosis: detection and identification of injected effects, and
//! false alarms. The cells are those of `gyrocal characterise`, which adds baseline methods.

mod cost;
pub(crate) mod plan;

use gyrocal_evaluation::{Characteristic, PopulationCell, cell_campaign, cell_report};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable::results;
use crate::truth::Extent;

/// Number of records of each cell in the small version.
const SMALL_RUNS: [(PopulationCell, u64); 11] = [
    (PopulationCell::Clean, 4),
    (PopulationCell::Single(5), 1),
    (PopulationCell::Single(6), 1),
    (PopulationCell::Single(8), 3),
    (PopulationCell::Single(12), 1),
    (PopulationCell::LogUniform, 1),
    (PopulationCell::Pair, 1),
    (PopulationCell::Step, 1),
    (PopulationCell::Cubic, 1),
    (PopulationCell::Azimuth, 1),
    (PopulationCell::OutOfCatalogue, 1),
];

/// All figures of the topic.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let mut figures = Vec::new();
    for (cell, few) in SMALL_RUNS {
        let seeds = 0..extent.records(cell.full_runs(), few);
        let mut campaign = cell_campaign(cell, seeds.clone(), &[]);
        if !small {
            campaign = campaign.results(results("naming", &cell.name())?);
        }
        let outcome = campaign.run(|seed| cell.evaluate(seed, &[]), |_| ())?;
        let report = cell_report(cell, &outcome, &seeds);
        let all = report.characteristics.iter();
        figures.extend(all.map(|characteristic| figure(&report.title, characteristic)));
    }
    figures.extend(cost::figures(small)?);
    Ok(figures)
}

fn figure(title: &str, of: &Characteristic) -> Figure {
    Figure {
        name: format!("{title}: {}", of.figure),
        target: of
            .target
            .map_or_else(String::new, |target| target.to_string()),
        measured: match (of.measured, of.interval) {
            (Some(value), Some([low, high])) => format!("{value:.3} ({low:.3} to {high:.3})"),
            (Some(value), None) => format!("{value:.3}"),
            (None, _) => "nothing to measure on".to_owned(),
        },
        runs: of.runs as usize,
        seeds: format!("{}..{}", of.seeds[0], of.seeds[1]),
        holds: of.holds,
        too_few: of.too_few,
        share: of.share,
        ..Figure::default()
    }
}

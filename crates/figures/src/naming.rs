//! Cells of `gyrocal characterise`: detection and identification of injected effects, and false alarms. The records
//! of a cell are diagnosed once, for the parts [`comparison`](crate::comparison) and [`gain`](crate::gain) too.

mod cost;

use gyrocal_evaluation::{BaselineMethod, Measure, PopulationCell, RecordScore, measures};

use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Seeds, of};

/// The cells that usual methods are compared on: without an effect, and with one of eight sigmas of its own bound.
pub(crate) const CLEAN: PopulationCell = PopulationCell::Clean;
pub(crate) const WITH_EFFECT: PopulationCell = PopulationCell::Single(8);

/// Number of their records that these methods are applied to.
const COMPARED: u64 = 300;

/// Cells with their number of records in the small version.
const CELLS: [(PopulationCell, u64); 11] = [
    (CLEAN, 4),
    (PopulationCell::Single(5), 1),
    (PopulationCell::Single(6), 1),
    (WITH_EFFECT, 3),
    (PopulationCell::Single(12), 1),
    (PopulationCell::LogUniform, 1),
    (PopulationCell::Pair, 1),
    (PopulationCell::Step, 1),
    (PopulationCell::Cubic, 1),
    (PopulationCell::Azimuth, 1),
    (PopulationCell::OutOfCatalogue, 1),
];

/// The records of a cell.
pub(crate) fn population(cell: PopulationCell) -> Population<'static, RecordScore> {
    let small = CELLS.iter().find(|(other, _)| *other == cell);
    let seeds = [0, cell.full_runs(), small.map_or(0, |(_, small)| *small)];
    let sources = of(DIAGNOSIS, &[file!()]);
    let is_compared = [CLEAN, WITH_EFFECT].contains(&cell);
    let job = move |seed| {
        let methods = match is_compared && seed % Seeds::REPORT < COMPARED {
            true => &BaselineMethod::ALL[..],
            false => &[],
        };
        Ok(cell.evaluate(seed, methods)?)
    };
    Population::new(format!("cell-{}", cell.name()), seeds, sources, job)
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (cell, _) in CELLS {
        let population = population(cell);
        let records = context.records(&population)?;
        let records: Vec<&RecordScore> = records.records.iter().collect();
        let rows = measures(cell, &records).into_iter();
        let rows: Vec<Row<'_, RecordScore>> = rows.map(|measure| row(cell, measure)).collect();
        figures.extend(context.measure(&population, &rows)?);
    }
    figures.extend(cost::figures(context.is_small())?);
    Ok(figures)
}

fn row(cell: PopulationCell, measure: Measure) -> Row<'static, RecordScore> {
    let Measure {
        figure,
        statistic,
        target,
    } = measure;
    let name = format!("{}: {figure}", cell.title());
    let row = Row::new(name, move |_| statistic.clone());
    match target {
        Some((target, reason)) => row.with_target(target, reason),
        None => row,
    }
}

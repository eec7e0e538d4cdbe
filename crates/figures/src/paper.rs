//! The paper, reproduced and corrected: its tables and curves, and measurements of its errors.

mod bench;
mod coordinates;
mod curves;
mod discretisation;
mod documents;
mod earth_rate;
mod result;
mod symmetry;

use crate::figure::Figure;
use crate::page;
use crate::values::Values;

use crate::error::Error;

/// Template of docs/paper.md.
pub(crate) const TEMPLATE: &str = include_str!("paper/page.md");

/// Result of a section: texts and tables for the page, and figures with their targets.
#[derive(Default)]
struct Measured {
    values: Values,
    figures: Vec<Figure>,
}

/// All figures of the topic. The last compares page and pictures in `docs` with the measurement; with
/// `write` they are renewed instead.
pub(crate) fn figures(write: bool) -> Result<Vec<Figure>, Error> {
    let mut measured = Measured::default();
    bench::describe(&mut measured.values);
    result::measure(&mut measured)?;
    discretisation::measure(&mut measured)?;
    earth_rate::measure(&mut measured)?;
    coordinates::measure(&mut measured)?;
    symmetry::measure(&mut measured)?;
    let documents = documents::Documents {
        page: page::fill(TEMPLATE, &measured.values)?,
        pictures: curves::pictures()?,
    };
    let mut figures = measured.figures;
    if write {
        documents.write()?;
    } else {
        figures.push(Figure::truth(
            "docs/paper.md and its pictures are what is measured",
            documents.are_committed()?,
        ));
    }
    Ok(figures)
}

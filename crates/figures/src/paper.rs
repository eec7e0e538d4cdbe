//! The paper, reproduced and corrected: its tables and curves again, and what was wrong with
//! them, measured.

mod bench;
mod coordinates;
mod curves;
mod discretisation;
mod earth_rate;
mod page;
mod result;
mod symmetry;
mod values;

use crate::figure::Figure;
use values::Values;

/// Why a figure could not be measured.
pub(crate) type Error = Box<dyn std::error::Error + Send + Sync>;

/// What a section adds: words and tables for the page, and figures with their targets.
#[derive(Default)]
struct Measured {
    values: Values,
    figures: Vec<Figure>,
}

/// All figures of the topic. The last says whether page and pictures in `docs` are what was
/// measured; with `write` they are renewed instead.
pub(crate) fn figures(write: bool) -> Result<Vec<Figure>, Error> {
    let mut measured = Measured::default();
    bench::describe(&mut measured.values);
    result::measure(&mut measured)?;
    discretisation::measure(&mut measured)?;
    earth_rate::measure(&mut measured)?;
    coordinates::measure(&mut measured)?;
    symmetry::measure(&mut measured)?;
    let documents = page::Documents {
        page: page::fill(&measured.values)?,
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

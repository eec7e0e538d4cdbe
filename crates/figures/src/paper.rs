//! The paper, reproduced and corrected: its filter and others on its bench, and docs/paper.md with its pictures.

mod curves;
mod symmetry;
mod tables;
mod ways;

use gyrocal_report::to_png;

use crate::harness::{Context, Error, Figure, Seeds, Size};
use crate::page::{docs, fill, renewed};
use crate::values::Values;

/// Template of docs/paper.md.
pub(crate) const TEMPLATE: &str = include_str!("paper/page.md");

/// Command that renews page and pictures.
const TOPIC: &str = "calibration --part paper";

/// Width of the pictures as PNG, px.
const PNG_WIDTH_PX: u32 = 1440;

/// All figures of the part. The last compares page and pictures with the measurement; with leave to write they are
/// renewed instead.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let population = ways::population();
    let mut figures = context.measure(&population, &ways::rows())?;
    // The page is of the same records wherever it is measured.
    let own = Context::new(Size::Full, Seeds::Development);
    let of_page = if context.is_small() { context } else { &own };
    let found = of_page.records(&population)?;
    let mut values = Values::default();
    tables::fill(&mut values, &found.records)?;
    figures.extend(symmetry::measure(&mut values)?);
    let page = fill(TEMPLATE, &values)?;
    let write = context.write;
    let mut same = renewed(&docs().join("paper.md"), &page, TOPIC, write)?;
    for (stem, picture) in curves::pictures(&found.records[0])? {
        let svg = picture.to_svg_of(&format!("One record, seed {}.", ways::SHOWN_SEED))?;
        let path = docs().join("pictures/paper").join(stem);
        same &= renewed(&path.with_extension("svg"), &svg, TOPIC, write)?;
        // Only written, together with its SVG.
        let png = path.with_extension("png");
        if write {
            gyrocal_record::write_whole(&png, &to_png(&svg, PNG_WIDTH_PX)?)?;
        }
        same &= png.is_file();
    }
    let name = "docs/paper.md and its pictures are what is measured";
    figures.push(Figure::truth(name, same));
    Ok(figures)
}

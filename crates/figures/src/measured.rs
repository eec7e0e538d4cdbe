//! Two recordings of real gyros: the figures of docs/measured-data.md.

mod allan;
mod ring_laser;
mod xsens;

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::figure::Figure;
use crate::page;
use crate::values::Values;

/// Template of docs/measured-data.md.
pub(crate) const TEMPLATE: &str = include_str!("measured/page.md");

/// Result of a section: texts and tables for the page, and figures with their targets.
#[derive(Default)]
struct Measured {
    values: Values,
    figures: Vec<Figure>,
}

/// All figures of the topic. The last compares the page with the measurement; with `write` it is renewed
/// instead.
pub(crate) fn figures(write: bool) -> Result<Vec<Figure>, Error> {
    let mut measured = Measured::default();
    xsens::measure(&mut measured)?;
    ring_laser::measure(&mut measured)?;
    allan::measure(&mut measured)?;
    let text = page::fill(TEMPLATE, &measured.values)?;
    let path = page::docs().join("measured-data.md");
    let mut figures = measured.figures;
    if write {
        gyrocal_record::write_whole(&path, text.as_bytes())?;
    } else {
        figures.push(Figure::truth(
            "docs/measured-data.md is what is measured",
            page::is_committed(&path, &text, "instruments --part measured")?,
        ));
    }
    Ok(figures)
}

/// A file of the recordings.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/data/measured")
        .join(name)
}

/// Run time of a command on a recording; the target is one minute.
fn run_time(command: &str, seconds: f64) -> Figure {
    Figure {
        measured: format!("{seconds:.1}"),
        ..Figure::within(&format!("{command}: run time, s"), [0.0, 60.0], seconds)
    }
}

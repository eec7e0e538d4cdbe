//! Two recordings of real gyros: the figures of docs/measured-data.md.

mod ring_laser;
mod xsens;

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::harness::{Context, Error, Figure};
use crate::page;
use crate::values::Values;

/// Template of docs/measured-data.md.
pub(crate) const TEMPLATE: &str = include_str!("measured/page.md");

/// Ranges of the rows by their names, with reasons.
const ROWS: &str = include_str!("measured/rows.toml");

/// Result of the sections: texts for the page, and figures with their targets.
struct Measured {
    values: Values,
    figures: Vec<Figure>,
    rows: Table,
}

impl Measured {
    /// Adds a value that is to be in the range of its row; `*` in the name of a row stands for an axis.
    fn judge(&mut self, name: &str, value: f64) -> &mut Figure {
        let of_axis = |key: String, axis| key.replace(&format!("gyro_{axis}:"), "gyro_*:");
        let axes = gyrocal_record::AXES.into_iter();
        let row = self.rows.get(&axes.fold(name.to_owned(), of_axis));
        let figure = match row.and_then(Value::as_array).map_or(&[][..], Vec::as_slice) {
            [Value::Float(low), Value::Float(high), Value::String(reason)] => Figure {
                reason: reason.clone(),
                ..Figure::within(name, [*low, *high], value)
            },
            _ => Figure::truth(
                &format!("{name}: measured/rows.toml has a range for it"),
                false,
            ),
        };
        let last = self.figures.len();
        self.figures.push(figure);
        &mut self.figures[last]
    }

    fn put<const N: usize>(&mut self, values: [(&str, String); N]) {
        for (name, text) in values {
            self.values.put(name, text);
        }
    }
}

/// All figures of the part. The last compares the page with the measurement; with leave to write it is renewed
/// instead.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut measured = Measured {
        values: Values::default(),
        figures: Vec::new(),
        rows: toml::from_str(ROWS)?,
    };
    xsens::measure(&mut measured)?;
    ring_laser::measure(&mut measured)?;
    let (topic, values) = ("instruments --part measured", &measured.values);
    let same = page::filled("measured-data.md", TEMPLATE, values, topic, context.write)?;
    let mut figures = measured.figures;
    let name = "docs/measured-data.md is what is measured";
    figures.push(Figure::truth(name, same));
    Ok(figures)
}

/// A file of the recordings.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/data/measured")
        .join(name)
}

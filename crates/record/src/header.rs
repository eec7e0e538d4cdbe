//! The header row of a record: the field of each column.

use std::ops::Range;

use crate::error::{Error, InputErrorKind};
use crate::fields::Line;
use crate::source::{SourceText, quoted};
use crate::suggest::{any_of, similar_names};

/// The columns that a record may have.
pub(crate) const COLUMNS: [&str; 5] = [
    "time_s",
    "accel_x_g",
    "accel_y_g",
    "accel_z_g",
    "temperature_c",
];

/// The columns that a record must have.
pub(crate) const REQUIRED_COLUMNS: &[&str] = COLUMNS.split_at(4).0;

/// Index of the field of each column.
#[derive(Debug)]
pub(crate) struct Header {
    /// Number of fields of a row.
    pub(crate) fields: usize,
    /// Field of `time_s`.
    pub(crate) time: usize,
    /// Fields of the three accelerometers.
    pub(crate) accel: [usize; 3],
    /// Field of `temperature_c`.
    pub(crate) temperature: Option<usize>,
}

impl Header {
    /// Finds the columns in the header line.
    pub(crate) fn parse(source: &SourceText, line: &Line<'_>) -> Result<Self, Error> {
        if let Some(swapped) = source.description_in_place_of_table() {
            return Err(swapped);
        }
        let names: Vec<&str> = line.fields.iter().map(|field| field.text).collect();
        refuse_other_separators(source, line)?;
        refuse_numbers(source, line)?;
        for (column, field) in line.fields.iter().enumerate() {
            let name = field.text;
            if !COLUMNS.contains(&name) {
                return Err(unknown(source, field.span.clone(), name, &names));
            }
            if names[..column].contains(&name) {
                return Err(source.error(
                    InputErrorKind::Header,
                    field.span.clone(),
                    format!("a second column `{name}`"),
                    "each column once",
                    "remove or rename one of them",
                ));
            }
        }
        let place = |wanted: &str| names.iter().position(|name| *name == wanted);
        let required = |wanted: &str| {
            place(wanted).ok_or_else(|| {
                source.error(
                    InputErrorKind::Header,
                    line.span.clone(),
                    format!("the header {}", quoted(&names.join(","))),
                    format!("a column `{wanted}` too"),
                    format!("a record has the columns {}", REQUIRED_COLUMNS.join(",")),
                )
            })
        };
        let [time, x, y, z, temperature] = COLUMNS;
        Ok(Self {
            fields: names.len(),
            time: required(time)?,
            accel: [required(x)?, required(y)?, required(z)?],
            temperature: place(temperature),
        })
    }
}

fn unknown(source: &SourceText, span: Range<usize>, name: &str, names: &[&str]) -> Error {
    let absent: Vec<&str> = COLUMNS
        .into_iter()
        .filter(|column| !names.contains(column))
        .collect();
    let advice = match similar_names(name, &absent, 1)[..] {
        [near, ..] => format!("did you mean `{near}`? (names carry their unit)"),
        [] => "rename it if it is one of these, remove it if it is not".to_owned(),
    };
    source.error(
        InputErrorKind::Header,
        span,
        format!("the unknown column {}", quoted(name)),
        any_of(if absent.is_empty() { &COLUMNS } else { &absent }),
        advice,
    )
}

fn refuse_other_separators(source: &SourceText, line: &Line<'_>) -> Result<(), Error> {
    let [only] = &line.fields[..] else {
        return Ok(());
    };
    let Some(separator) = source.text()[only.span.clone()].find([';', '\t']) else {
        return Ok(());
    };
    let place = only.span.start + separator;
    Err(source.error(
        InputErrorKind::Header,
        place..place + 1,
        "fields separated by another character",
        "fields separated by commas",
        "write commas, and points in decimal numbers",
    ))
}

fn refuse_numbers(source: &SourceText, line: &Line<'_>) -> Result<(), Error> {
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    if line.fields.iter().all(|field| is_number(field.text)) {
        return Err(source.error(
            InputErrorKind::Header,
            line.span.clone(),
            "a row of numbers",
            format!("the header `{}`", REQUIRED_COLUMNS.join(",")),
            "put the header before the first row",
        ));
    }
    Ok(())
}

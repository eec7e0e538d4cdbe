//! Selected columns of a CSV file, by name.

use core::ops::Range;

use gyrocal_record::fields::{Field, Line, Lines};
use gyrocal_record::{Error, InputErrorKind, SourceText};

/// Columns of a CSV file.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The values of each column, all finite.
    pub values: Vec<Vec<f64>>,
    /// Place of each row in the text of the file.
    pub places: Vec<Range<usize>>,
}

/// Reads the columns `names`, in that order, from text with a header row.
///
/// # Errors
///
/// [`Error::Input`], at its place, for a column that is absent or double, a row with more or
/// fewer fields than the header, a field that is not a finite number, or a file without rows.
pub fn read_columns(source: &SourceText, names: &[&str]) -> Result<Columns, Error> {
    let mut lines = Lines::of(source);
    let header = lines.next_line()?.unwrap_or_default();
    let indices = names
        .iter()
        .map(|name| index(source, &header, name))
        .collect::<Result<Vec<usize>, Error>>()?;
    let mut values = vec![Vec::new(); names.len()];
    let mut places: Vec<Range<usize>> = Vec::new();
    while let Some(line) = lines.next_line()? {
        if line.fields.len() != header.fields.len() {
            return Err(source.error(
                InputErrorKind::FieldCount,
                line.span,
                format!("{} fields", line.fields.len()),
                format!("{} fields, as the header has", header.fields.len()),
                "decimal numbers have a point, and fields are separated by commas",
            ));
        }
        for (column, &index) in values.iter_mut().zip(&indices) {
            column.push(number(source, &line.fields[index])?);
        }
        places.push(line.span);
    }
    if places.is_empty() {
        return Err(source.error(
            InputErrorKind::TooFewRows,
            header.span.start..header.span.start,
            "a header without rows",
            "samples",
            "check that the program that wrote the log had finished",
        ));
    }
    Ok(Columns { values, places })
}

/// Index of the column of a name.
fn index(source: &SourceText, header: &Line<'_>, name: &str) -> Result<usize, Error> {
    let names: Vec<&str> = header.fields.iter().map(|field| field.text).collect();
    let mut indices = (0..names.len()).filter(|index| names[*index] == name);
    let advice = format!("the columns are {}", names.join(", "));
    let error = |found: String, expected: String| {
        let span = header.span.clone();
        source.error(InputErrorKind::Header, span, found, expected, &*advice)
    };
    match (indices.next(), indices.next()) {
        (Some(index), None) => Ok(index),
        (None, _) => Err(error(
            "a header without it".to_owned(),
            format!("a column `{name}`"),
        )),
        (Some(_), Some(_)) => Err(error(
            format!("the column `{name}` twice"),
            "each column once".to_owned(),
        )),
    }
}

fn number(source: &SourceText, field: &Field<'_>) -> Result<f64, Error> {
    let number = field.text.parse::<f64>().ok();
    number.filter(|value| value.is_finite()).ok_or_else(|| {
        source.error(
            InputErrorKind::NotANumber,
            field.span.clone(),
            format!("`{}`", &source.text()[field.span.clone()]),
            "a finite number",
            "cut the log before the first sample that is missing",
        )
    })
}

//! Columns of a file of binary records.

use std::path::Path;

use gyrocal_record::read_content;

use crate::error::{InstrumentError, Unfit};
use crate::file_format::{Binary, Only};

/// Reads the columns `names` of the records, in that order.
///
/// # Errors
///
/// [`gyrocal_record::Error::Unreadable`]; [`Unfit::Binary`] for a column that no field has, for a file that ends within a
/// record, and for a number that is not finite.
pub(crate) fn read_binary(
    path: &Path,
    format: &Binary,
    only: Option<&Only>,
    names: &[&str],
) -> Result<Vec<Vec<f64>>, InstrumentError> {
    let places = names
        .iter()
        .map(|name| place(format, name))
        .collect::<Result<Vec<usize>, InstrumentError>>()?;
    let filter = match only {
        Some(only) => Some((place(format, &only.column)?, number(&only.equals)?)),
        None => None,
    };
    let mut starts = Vec::with_capacity(format.fields.len());
    let mut length = 0;
    for field in &format.fields {
        starts.push(length);
        length += field.kind.bytes();
    }
    let bytes = read_content(path)?;
    let records = bytes.get(format.skip_bytes..).unwrap_or_default();
    if length == 0 || records.is_empty() || !records.len().is_multiple_of(length) {
        return Err(unfit(
            format!(
                "{} bytes after the first {}",
                records.len(),
                format.skip_bytes
            ),
            format!("whole records of {length} bytes, as `fields` say"),
            "check the types of the fields and `skip_bytes`; if the logger was cut off, cut the last \
             record from the file",
        ));
    }
    let mut values = vec![Vec::new(); names.len()];
    for (index, record) in records.chunks_exact(length).enumerate() {
        let of = |place: usize| {
            let kind = format.fields[place].kind;
            kind.number(&record[starts[place]..], format.byte_order)
        };
        if filter.is_some_and(|(place, value)| of(place) != value) {
            continue;
        }
        for (column, place) in values.iter_mut().zip(&places) {
            let value = of(*place);
            if !value.is_finite() {
                let name = &format.fields[*place].name;
                return Err(unfit(
                    format!("{value} as `{name}` of record {}", index + 1),
                    "a finite number".to_owned(),
                    "check types, `byte_order` and `skip_bytes`; cut the log before the first sample \
                     that is missing",
                ));
            }
            column.push(value);
        }
    }
    Ok(values)
}

fn place(format: &Binary, name: &str) -> Result<usize, InstrumentError> {
    let found = format.fields.iter().position(|field| field.name == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = format.fields.iter().map(|field| &*field.name).collect();
        unfit(
            format!("records without a field `{name}`"),
            "it among `fields`".to_owned(),
            &format!("the fields are {}", names.join(", ")),
        )
    })
}

fn number(text: &str) -> Result<f64, InstrumentError> {
    text.parse().map_err(|_| {
        unfit(
            format!("`equals = \"{text}\"`"),
            "a number for a field of a binary record".to_owned(),
            "give the number of the sensor",
        )
    })
}

fn unfit(found: String, expected: String, advice: &str) -> InstrumentError {
    InstrumentError::unfit(Unfit::Binary, found, expected, advice)
}

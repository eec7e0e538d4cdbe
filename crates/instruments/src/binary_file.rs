//! Columns of a file of binary records, read record by record.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use gyrocal_record::Error;

use crate::error::{InstrumentError, Unfit};
use crate::file_format::{Binary, Only};

/// Reads the columns `names` of the records, in that order.
///
/// # Errors
///
/// [`Error::Unreadable`]; [`Unfit::Binary`] for a column that no field has, for a file that ends within a
/// record, and for a number that is not finite.
pub(crate) fn read_binary(
    path: &Path,
    format: &Binary,
    only: Option<&Only>,
    names: &[&str],
) -> Result<Vec<Vec<f64>>, InstrumentError> {
    let unreadable = |reason| Error::Unreadable {
        path: path.to_owned(),
        reason,
    };
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
    let file = File::open(path).map_err(unreadable)?;
    let bytes = file.metadata().map_err(unreadable)?.len();
    let left = bytes.saturating_sub(format.skip_bytes as u64);
    if length == 0 || left % length as u64 != 0 || left == 0 {
        return Err(unfit(
            format!("{left} bytes after the first {}", format.skip_bytes),
            format!("whole records of {length} bytes, as `fields` say"),
            "check the types of the fields and `skip_bytes`; if the logger was cut off, cut the last \
             record from the file",
        ));
    }
    let mut reader = BufReader::new(file);
    reader
        .seek(SeekFrom::Start(format.skip_bytes as u64))
        .map_err(unreadable)?;
    let mut record = vec![0; length];
    let mut values = vec![Vec::new(); names.len()];
    for index in 0..left / length as u64 {
        reader.read_exact(&mut record).map_err(unreadable)?;
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

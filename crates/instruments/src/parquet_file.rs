//! Columns of files of Parquet.

use std::path::Path;

use bytes::Bytes;
use gyrocal_record::read_content;
use parquet::basic::{LogicalType, TimeUnit};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use parquet::schema::types::Type;

use crate::cell::{Cell, TakeCells, no_column, unfit};
use crate::error::InstrumentError;

/// Hands the cells of the columns `names` of each row to `take`; the file is in memory, of its rows a group at a
/// time.
pub(crate) fn read(
    path: &Path,
    names: &[&str],
    take: &mut TakeCells<'_>,
) -> Result<(), InstrumentError> {
    let damaged = |reason: ParquetError| {
        let found = format!("what no reader of Parquet accepts ({reason})");
        unfit(
            &found,
            "a whole file",
            "copy the file again, or write it without zstd",
        )
    };
    let reader = SerializedFileReader::new(Bytes::from(read_content(path)?)).map_err(damaged)?;
    let schema = reader.metadata().file_metadata().schema();
    let projection = projection(schema, names)?;
    let nanoseconds: Vec<&str> = projection
        .get_fields()
        .iter()
        .filter(|field| has_nanoseconds(field))
        .map(|field| field.name())
        .collect();
    let rows = reader
        .get_row_iter(Some(projection.clone()))
        .map_err(damaged)?;
    for (number, row) in rows.enumerate() {
        let row = row.map_err(damaged)?;
        let cells = names.iter().map(|name| {
            let mut columns = row.get_column_iter();
            let field = columns
                .find(|(title, _)| title == name)
                .map(|(_, field)| field);
            match field {
                None => Some(Cell::Missing),
                Some(Field::Long(stamp)) if nanoseconds.contains(name) => {
                    Some(Cell::Seconds(seconds(*stamp, 1_000_000_000)))
                }
                Some(field) => cell(field),
            }
        });
        let Some(cells) = cells.collect::<Option<Vec<Cell<'_>>>>() else {
            return Err(unfit(
                &format!(
                    "a value that is nested, binary or of another type in row {}",
                    number + 1
                ),
                "columns of numbers, time stamps and texts",
                "name other columns in the map",
            ));
        };
        take(&cells)?;
    }
    Ok(())
}

/// The schema with the columns `names` alone.
fn projection(schema: &Type, names: &[&str]) -> Result<Type, InstrumentError> {
    let fields = schema.get_fields();
    for name in names {
        if !fields.iter().any(|field| field.name() == *name) {
            let there: Vec<&str> = fields.iter().map(|field| field.name()).collect();
            return Err(no_column(name, &there.join(", ")));
        }
    }
    let fields = fields.iter().filter(|field| names.contains(&field.name()));
    Type::group_type_builder(schema.name())
        .with_fields(fields.cloned().collect())
        .build()
        .map_err(|reason| unfit(&reason.to_string(), "a schema", ""))
}

/// Whether a column has time stamps in nanoseconds, which the rows hand over as plain numbers.
fn has_nanoseconds(field: &Type) -> bool {
    matches!(
        field.get_basic_info().logical_type_ref(),
        Some(LogicalType::Timestamp(stamp)) if stamp.unit == TimeUnit::NANOS
    )
}

/// A number of parts of a second, as one number rounded once.
fn seconds(parts: i64, parts_per_s: i64) -> f64 {
    let whole = parts.div_euclid(parts_per_s);
    whole as f64 + parts.rem_euclid(parts_per_s) as f64 / parts_per_s as f64
}

/// The cell of a field; `None` of a kind that is no number, time or text.
fn cell(field: &Field) -> Option<Cell<'_>> {
    Some(match field {
        Field::Null => Cell::Missing,
        Field::Byte(value) => Cell::Number(f64::from(*value)),
        Field::Short(value) => Cell::Number(f64::from(*value)),
        Field::Int(value) => Cell::Number(f64::from(*value)),
        Field::Long(value) => Cell::Number(*value as f64),
        Field::UByte(value) => Cell::Number(f64::from(*value)),
        Field::UShort(value) => Cell::Number(f64::from(*value)),
        Field::UInt(value) => Cell::Number(f64::from(*value)),
        Field::ULong(value) => Cell::Number(*value as f64),
        Field::Float(value) => Cell::Number(f64::from(*value)),
        Field::Double(value) => Cell::Number(*value),
        Field::Str(text) => Cell::Text(text),
        Field::TimestampMillis(value) => Cell::Seconds(seconds(*value, 1_000)),
        Field::TimestampMicros(value) => Cell::Seconds(seconds(*value, 1_000_000)),
        _ => return None,
    })
}

//! Columns of an Arrow stream, through the C stream interface of Arrow (PyCapsule protocol).

use arrow_array::cast::AsArray as _;
use arrow_array::ffi_stream::{FFI_ArrowArrayStream, RecordBatchStreamReader};
use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{Array, RecordBatch, RecordBatchReader as _};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use gyrocal_record::Record;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::error::{Failure, Outcome};
use crate::names::check_names;
use crate::record::COLUMNS;

/// Units that the metadata of a field may give each column.
const UNITS: [&[&str]; 5] = [
    &["s"],
    &["g"],
    &["g"],
    &["g"],
    &["degC", "°C", "C", "celsius"],
];

/// Takes the stream out of its capsule.
pub(crate) fn reader(stream: &Bound<'_, PyAny>) -> PyResult<RecordBatchStreamReader> {
    let capsule = stream.cast::<PyCapsule>()?;
    let pointer = capsule.pointer_checked(Some(c"arrow_array_stream"))?;
    // SAFETY: a capsule of this name holds a valid stream, by the protocol. It is moved out, and what is
    // left is marked as released, so that the capsule frees the memory of the structure alone.
    let reader = unsafe {
        RecordBatchStreamReader::from_raw(pointer.cast::<FFI_ArrowArrayStream>().as_ptr())
    };
    reader.map_err(|error| unreadable(&error).into())
}

fn unreadable(error: &ArrowError) -> Failure {
    Failure {
        message: format!("the Arrow stream cannot be read: {error}"),
        ..Failure::default()
    }
}

/// Reads all batches.
pub(crate) fn read(reader: RecordBatchStreamReader, name: &str) -> Outcome<Record> {
    let schema = reader.schema();
    let names: Vec<&str> = schema.fields().iter().map(|field| &**field.name()).collect();
    check_names(&names, name)?;
    let places = COLUMNS.map(|column| names.iter().position(|name| *name == column));
    check_units(&schema, places, name)?;
    let mut columns: [Vec<f64>; 5] = Default::default();
    for batch in reader {
        let batch = batch.map_err(|error| unreadable(&error))?;
        for (column, place) in columns.iter_mut().zip(places) {
            if let Some(place) = place {
                append(column, &batch, place, name)?;
            }
        }
    }
    let [time_s, x, y, z, temperature_c] = columns;
    let rows = x.iter().zip(&y).zip(&z);
    Ok(Record {
        time_s,
        accel_g: rows.map(|((x, y), z)| [*x, *y, *z]).collect(),
        temperature_c: places[4].map(|_| temperature_c),
    })
}

fn check_units(schema: &Schema, places: [Option<usize>; 5], name: &str) -> Outcome<()> {
    for (place, units) in places.iter().zip(UNITS) {
        let field = place.and_then(|place| schema.fields().get(place));
        let unit = field.and_then(|field| {
            let metadata = field.metadata();
            metadata.get("unit").or_else(|| metadata.get("units"))
        });
        if let (Some(field), Some(unit)) = (field, unit)
            && !units.contains(&unit.as_str())
        {
            return Err(Failure::of_value(
                &format!("{name}, column `{}`", field.name()),
                format!("the unit `{unit}`"),
                format!("`{}`", units[0]),
                "convert the values, and the unit in the metadata of the field",
            ));
        }
    }
    Ok(())
}

/// Appends a column of a batch; nulls become NaN.
fn append(values: &mut Vec<f64>, batch: &RecordBatch, place: usize, name: &str) -> Outcome<()> {
    let array = batch.column(place);
    macro_rules! converted {
        ($kind:ty, $convert:expr) => {{
            let numbers = array.as_primitive::<$kind>();
            values.extend(numbers.iter().map(|value| value.map_or(f64::NAN, $convert)));
        }};
    }
    match array.data_type() {
        // Without nulls the buffer is the column.
        DataType::Float64 if array.null_count() == 0 => {
            values.extend_from_slice(array.as_primitive::<Float64Type>().values());
        }
        DataType::Float64 => converted!(Float64Type, |value| value),
        DataType::Float32 => converted!(Float32Type, f64::from),
        DataType::Int8 => converted!(Int8Type, f64::from),
        DataType::Int16 => converted!(Int16Type, f64::from),
        DataType::Int32 => converted!(Int32Type, f64::from),
        DataType::Int64 => converted!(Int64Type, |value| value as f64),
        DataType::UInt8 => converted!(UInt8Type, f64::from),
        DataType::UInt16 => converted!(UInt16Type, f64::from),
        DataType::UInt32 => converted!(UInt32Type, f64::from),
        DataType::UInt64 => converted!(UInt64Type, |value| value as f64),
        DataType::Null => values.extend(std::iter::repeat_n(f64::NAN, array.len())),
        _ => return Err(no_numbers(batch.schema().field(place), name)),
    }
    Ok(())
}

fn no_numbers(field: &Field, name: &str) -> Failure {
    let kind = field.data_type();
    let advice = match kind {
        DataType::Timestamp(..) | DataType::Date32 | DataType::Date64 | DataType::Time64(_) => {
            "give seconds since the first row as numbers"
        }
        DataType::Decimal128(..) | DataType::Decimal256(..) => "cast the column to float64",
        _ => "convert the column to numbers: find the entries that are none",
    };
    Failure::of_value(
        &format!("{name}, column `{}`", field.name()),
        format!("the type {kind}"),
        "float64",
        advice,
    )
}

//! The columns of a record from an Arrow stream.

use gyrocal_record::Record;

use crate::arrow_abi::{Batch, Field, Stream};
use crate::error::{Failure, Outcome};
use crate::names::{COLUMNS, check_names};

/// Units that the metadata of a field may give each column.
const UNITS: [&[&str]; 5] = [
    &["s"],
    &["g"],
    &["g"],
    &["g"],
    &["degC", "°C", "C", "celsius"],
];

/// Reads all batches of a stream; nulls become NaN.
pub(crate) fn read(mut stream: Stream, name: &str) -> Outcome<Record> {
    let unreadable = |reason: String| Failure {
        message: format!("{name}: the Arrow stream cannot be read: {reason}"),
        ..Failure::default()
    };
    let schema = stream.schema().map_err(unreadable)?;
    let fields = schema
        .fields()
        .ok_or_else(|| unreadable("it is none of batches with columns".to_owned()))?;
    let names: Vec<&str> = fields.iter().map(|field| &*field.name).collect();
    check_names(&names, name)?;
    let places = COLUMNS.map(|column| names.iter().position(|name| *name == column));
    for (place, units) in places.iter().zip(UNITS) {
        if let Some(place) = place {
            check_unit(&fields[*place], units, name)?;
        }
    }
    let mut columns: [Vec<f64>; 5] = Default::default();
    while let Some(batch) = stream.next().map_err(unreadable)? {
        for (column, place) in columns.iter_mut().zip(places) {
            if let Some(place) = place {
                append(column, &batch, place, &fields[place], name)?;
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

fn place(name: &str, field: &Field) -> String {
    format!("{name}, column `{}`", field.name)
}

fn check_unit(field: &Field, units: &[&str], name: &str) -> Outcome<()> {
    let mut metadata = field.metadata.iter();
    let unit = metadata.find(|(key, _)| key == "unit" || key == "units");
    match unit {
        Some((_, unit)) if !units.contains(&unit.as_str()) => Err(Failure::of_value(
            &place(name, field),
            format!("the unit `{unit}`"),
            format!("`{}`", units[0]),
            "convert the values, and the unit in the metadata of the field",
        )),
        _ => Ok(()),
    }
}

fn append(
    values: &mut Vec<f64>,
    batch: &Batch,
    column: usize,
    field: &Field,
    name: &str,
) -> Outcome<()> {
    let appended = match field.format.as_str() {
        "g" => batch.append::<f64>(column, values),
        "f" => batch.append::<f32>(column, values),
        "c" => batch.append::<i8>(column, values),
        "s" => batch.append::<i16>(column, values),
        "i" => batch.append::<i32>(column, values),
        "l" => batch.append::<i64>(column, values),
        "C" => batch.append::<u8>(column, values),
        "S" => batch.append::<u16>(column, values),
        "I" => batch.append::<u32>(column, values),
        "L" => batch.append::<u64>(column, values),
        // A column of nulls alone has no buffers.
        "n" => batch
            .rows()
            .map(|rows| values.extend(std::iter::repeat_n(f64::NAN, rows))),
        _ => return Err(no_numbers(field, name)),
    };
    appended.ok_or_else(|| Failure {
        message: format!(
            "{}: the buffers of the Arrow stream are not sound",
            place(name, field)
        ),
        ..Failure::default()
    })
}

fn no_numbers(field: &Field, name: &str) -> Failure {
    let (kind, advice) = match field.format.as_bytes() {
        [b't', ..] => ("times", "give seconds since the first row as numbers"),
        [b'd', b':', ..] => ("decimal numbers", "cast the column to float64"),
        [b'b'] => ("booleans", "give numbers"),
        [b'u' | b'U'] | [b'v', b'u'] => (
            "text",
            "convert the column to numbers: find the entries that are none",
        ),
        _ => ("other things than numbers", "cast the column to float64"),
    };
    Failure::of_value(
        &place(name, field),
        format!("{kind} (Arrow format `{}`)", field.format),
        "float64",
        advice,
    )
}

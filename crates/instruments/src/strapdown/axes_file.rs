//! The file of body axes: the rotation from body to virtual platform at each row of a record.

use std::fmt::Write as _;

use gyrocal_record::{Error, InputErrorKind, Record, SourceText};

use crate::columns::{Columns, read_columns};

const COLUMNS: [&str; 5] = ["time_s", "q_w", "q_x", "q_y", "q_z"];

/// Largest difference of the time stamps of the two files, which may be rounded.
const SAME_TIME_S: f64 = 1e-6;
/// Largest error of the norm, that of a quaternion printed with three digits.
const UNIT: f64 = 0.01;

/// The text of the file: for each row its time and the unit quaternion (w, x, y, z) that takes
/// body components to platform components.
#[must_use]
pub fn axes_csv(record: &Record, platform_q_body: &[[f64; 4]]) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for (time_s, [w, x, y, z]) in record.time_s.iter().zip(platform_q_body) {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{time_s:?},{w:?},{x:?},{y:?},{z:?}");
    }
    text
}

/// The norm of a quaternion that is no rotation.
#[must_use]
pub fn wrong_norm(quaternion: &[f64; 4]) -> Option<f64> {
    let squares: f64 = quaternion.iter().map(|part| part.powi(2)).sum();
    let norm = squares.sqrt();
    let is_unit = (norm - 1.0).abs() <= UNIT;
    (!is_unit).then_some(norm)
}

/// Reads the file that belongs to a record.
///
/// # Errors
///
/// [`Error::Input`], at its place, if rows or times differ from those of the record, or if a quaternion
/// is not a rotation.
pub fn read_axes(source: &SourceText, record: &Record) -> Result<Vec<[f64; 4]>, Error> {
    let Columns {
        values: columns,
        places,
    } = read_columns(source, &COLUMNS)?;
    let rows = places.len();
    // The place after the last row if the record has more.
    let end = source.text().len();
    let at_line = |row: usize| {
        let start = places.get(row).map_or(end, |place| place.start);
        start..start
    };
    if rows != record.len() {
        return Err(source.error(
            InputErrorKind::TooFewRows,
            at_line(rows.min(record.len())),
            format!("{rows} rows"),
            format!("{}, as many as the record has", record.len()),
            "record and axes are written together: gyrocal import strapdown",
        ));
    }
    let quaternion = |row: usize| core::array::from_fn(|i| columns[i + 1][row]);
    for (row, (time_s, of_record_s)) in columns[0].iter().zip(&record.time_s).enumerate() {
        if (time_s - of_record_s).abs() > SAME_TIME_S {
            return Err(source.error(
                InputErrorKind::Time,
                at_line(row),
                format!("time {time_s} s in row {}", row + 1),
                format!("{of_record_s} s, as in the record"),
                "record and axes are written together: gyrocal import strapdown",
            ));
        }
        if let Some(norm) = wrong_norm(&quaternion(row)) {
            return Err(source.error(
                InputErrorKind::Norm,
                at_line(row),
                format!("a quaternion of norm {norm:.4} in row {}", row + 1),
                "a rotation, norm 1",
                "q_w is its real part",
            ));
        }
    }
    Ok((0..rows).map(quaternion).collect())
}

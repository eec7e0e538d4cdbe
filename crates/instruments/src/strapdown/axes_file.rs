//! The file that says how body axes lie in those of the virtual platform.

use std::fmt::Write as _;

use gyrocal_record::{Error, InputErrorKind, Record, SourceText};

use crate::columns::read_columns;

const COLUMNS: [&str; 5] = ["time_s", "q_w", "q_x", "q_y", "q_z"];

/// Time stamps of the two files are printed numbers, rounded or not.
const SAME_TIME_S: f64 = 1e-6;
/// A quaternion printed with three digits is a unit one within this.
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

/// Reads the file that belongs to a record.
///
/// # Errors
///
/// [`Error::Input`], at its place, if rows or times are not those of the record, or if a
/// quaternion is no rotation.
pub fn read_axes(source: &SourceText, record: &Record) -> Result<Vec<[f64; 4]>, Error> {
    let columns = read_columns(source, &COLUMNS)?;
    let rows = columns[0].len();
    let at_line = |row: usize| {
        let mut ends = source.text().match_indices('\n').map(|(end, _)| end + 1);
        let start = ends.nth(row).unwrap_or(0);
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
        let norm = (1..5).map(|i| columns[i][row].powi(2)).sum::<f64>().sqrt();
        if (norm - 1.0).abs() > UNIT {
            return Err(source.error(
                InputErrorKind::Norm,
                at_line(row),
                format!("a quaternion of norm {norm:.4} in row {}", row + 1),
                "a rotation, norm 1",
                "q_w is its real part",
            ));
        }
    }
    let quaternion = |row: usize| core::array::from_fn(|i| columns[i + 1][row]);
    Ok((0..rows).map(quaternion).collect())
}

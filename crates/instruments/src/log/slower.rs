//! Values between those of sensors that are slower than the gyros.

use gyrocal_record::InputErrorKind;
use gyrocal_statistics::median;

use super::LONGEST_JITTER;
use crate::clock::fill;
use crate::columns::FileColumns;
use crate::description::Description;
use crate::error::{InstrumentError, Unfit};

/// Interpolates what accelerometers and temperature do not have in each row.
///
/// # Errors
///
/// [`InstrumentError::File`] for a column without values, and for accelerometers that are missing for longer than they
/// are slow.
pub(super) fn fill_slower(
    file: &mut FileColumns,
    time_s: &[f64],
    description: &Description,
) -> Result<(), InstrumentError> {
    let forces = description.accel.iter().flat_map(|accel| &accel.columns);
    let forces = forces.map(|name| (name, true));
    let temperature = description.temperature.iter();
    let temperature = temperature.map(|column| (&column.column, false));
    for (at, (name, is_force)) in forces.chain(temperature).enumerate() {
        let column = 3 + at;
        let values = &file.values[column];
        let is_known = |row: &usize| !values[*row].is_nan();
        let known: Vec<usize> = (0..values.len()).filter(is_known).collect();
        if known.len() == values.len() {
            continue;
        }
        let hole = match known.is_empty() {
            true => Some(0..values.len()),
            false => longest_hole(&known, values.len()).filter(|_| is_force),
        };
        if let Some(hole) = hole {
            return Err(file.error_at(
                hole.start,
                InputErrorKind::NotANumber,
                Unfit::Gap,
                [
                    &format!("no value of `{name}` in {} rows from here on", hole.len()),
                    "values now and then, between which others are interpolated",
                    "split the log in front of this line and behind those rows, or name another column",
                ],
            ));
        }
        fill(time_s, &mut file.values[column]);
    }
    Ok(())
}

/// Rows without a value that are far more than those between values usually.
fn longest_hole(known: &[usize], rows: usize) -> Option<core::ops::Range<usize>> {
    let holes = known.windows(2).map(|pair| pair[0] + 1..pair[1]);
    let first = 0..known[0];
    let last = known[known.len() - 1] + 1..rows;
    let steps: Vec<f64> = known
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) as f64)
        .collect();
    let usual = if steps.is_empty() {
        1.0
    } else {
        median(&steps)
    };
    let longest = [first, last]
        .into_iter()
        .chain(holes)
        .max_by_key(ExactSizeIterator::len)?;
    (longest.len() as f64 > LONGEST_JITTER * usual).then_some(longest)
}

//! Checks of data before they are drawn. Not-a-number stands for a missing value and is left out;
//! data that would make a picture wrong or endless are an error.

use crate::error::Error;

/// A column is as long as the one it belongs to, and has no infinite value.
pub(crate) fn column(
    what: impl Fn() -> String,
    values: &[f64],
    (against, expected): (&str, usize),
) -> Result<(), Error> {
    if values.len() != expected {
        return Err(Error::UnequalLengths {
            what: what(),
            found: values.len(),
            against: against.to_owned(),
            expected,
        });
    }
    not_infinite(what, values)
}

/// No value is infinite.
pub(crate) fn not_infinite(what: impl Fn() -> String, values: &[f64]) -> Result<(), Error> {
    let expected = "a finite number, or nan where there is none";
    each(what, values, expected, |value| !value.is_infinite())
}

/// Abscissas are finite and never decrease.
pub(crate) fn non_decreasing(what: &str, values: &[f64]) -> Result<(), Error> {
    finite(what, values)?;
    match values.windows(2).position(|pair| pair[1] < pair[0]) {
        None => Ok(()),
        Some(index) => Err(Error::Value {
            what: what.to_owned(),
            index: index + 1,
            found: values[index + 1],
            expected: "a number not below the one before it",
        }),
    }
}

/// Numbers are finite.
pub(crate) fn finite(what: &str, values: &[f64]) -> Result<(), Error> {
    let what = || what.to_owned();
    each(what, values, "a finite number", f64::is_finite)
}

/// A list has an entry.
pub(crate) fn non_empty<T>(what: &'static str, list: &[T]) -> Result<(), Error> {
    if list.is_empty() {
        return Err(Error::Empty { what });
    }
    Ok(())
}

fn each(
    what: impl Fn() -> String,
    values: &[f64],
    expected: &'static str,
    usable: impl Fn(f64) -> bool,
) -> Result<(), Error> {
    match values.iter().position(|&value| !usable(value)) {
        None => Ok(()),
        Some(index) => Err(Error::Value {
            what: what(),
            index,
            found: values[index],
            expected,
        }),
    }
}

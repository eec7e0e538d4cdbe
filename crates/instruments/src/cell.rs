//! Cells of a file with typed columns, as each format hands them over, and the errors that all formats share.

use core::fmt::{Display, Formatter};

use crate::error::{InstrumentError, Unfit};

/// A cell of a file.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(
    not(any(feature = "parquet", feature = "mcap")),
    allow(
        dead_code,
        reason = "MATLAB has neither time stamps nor missing values"
    )
)]
pub(crate) enum Cell<'a> {
    /// A text.
    Text(&'a str),
    /// A number of a typed column.
    Number(f64),
    /// A time stamp of a typed column, s.
    Seconds(f64),
    /// A missing value of a typed column.
    Missing,
}

impl Cell<'_> {
    /// Whether it is what a text says: this text, or its number.
    pub(crate) fn is(&self, text: &str) -> bool {
        match self {
            Self::Text(own) => *own == text,
            Self::Number(own) => text.parse() == Ok(*own),
            Self::Seconds(_) | Self::Missing => false,
        }
    }
}

impl Display for Cell<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Text(text) => write!(f, "`{text}`"),
            Self::Number(value) => write!(f, "{value}"),
            Self::Seconds(_) => write!(f, "a time stamp"),
            Self::Missing => write!(f, "no value"),
        }
    }
}

/// A cell that owns its text.
#[cfg(feature = "mcap")]
#[derive(Debug, Clone)]
pub(crate) enum OwnedCell {
    Number(f64),
    Seconds(f64),
    Text(String),
    Missing,
}

#[cfg(feature = "mcap")]
impl OwnedCell {
    /// It, borrowed.
    pub(crate) fn cell(&self) -> Cell<'_> {
        match self {
            Self::Number(value) => Cell::Number(*value),
            Self::Seconds(value) => Cell::Seconds(*value),
            Self::Text(text) => Cell::Text(text),
            Self::Missing => Cell::Missing,
        }
    }
}

/// Takes the cells of one row; an error ends the reading.
pub(crate) type TakeCells<'t> = dyn FnMut(&[Cell<'_>]) -> Result<(), InstrumentError> + 't;

/// The error of a file that its description does not fit.
pub(crate) fn unfit(found: &str, expected: &str, advice: &str) -> InstrumentError {
    InstrumentError::unfit(Unfit::Binary, found, expected, advice)
}

/// The error of a column that a file lacks, which has those `there`.
pub(crate) fn no_column(name: &str, there: &str) -> InstrumentError {
    unfit(
        &format!("the columns {there}"),
        &format!("a column `{name}`"),
        "name the columns in a map (`--columns MAP.toml`)",
    )
}

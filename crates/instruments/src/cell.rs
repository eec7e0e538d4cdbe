//! Cells of a file with typed columns, as each format hands them over, and the errors that all formats share.

use core::fmt::{Display, Formatter};
use core::ops::Range;

use gyrocal_record::InputErrorKind;

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

/// What is wrong with a cell.
#[derive(Debug)]
pub(crate) struct Fault {
    /// Its column, by the order of those that were asked for.
    pub(crate) column: usize,
    pub(crate) kind: InputErrorKind,
    pub(crate) expected: String,
    pub(crate) advice: String,
}

impl Fault {
    /// The error of a cell in a row, by its number from 0, of a file whose columns have types.
    pub(crate) fn in_row(&self, names: &[&str], cells: &[Cell<'_>], row: usize) -> InstrumentError {
        unfit(
            &format!(
                "{} in the column `{}` of row {}",
                cells[self.column],
                names[self.column],
                row + 1
            ),
            &self.expected,
            &self.advice,
        )
    }

    /// The fault of a column that is behind `before` others.
    pub(crate) fn behind(self, before: usize) -> Self {
        Self {
            column: self.column + before,
            ..self
        }
    }
}

/// Columns that are read of a file.
#[derive(Debug, Clone)]
pub(crate) struct Wanted<'a> {
    /// Their names.
    pub(crate) names: &'a [&'a str],
    /// Those of slower sensors, by their order: a missing value is `NaN`.
    pub(crate) sparse: Range<usize>,
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
        "name columns that are there, here or in the map or description of the log",
    )
}

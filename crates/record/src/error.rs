//! The error type of this crate, and the located error in it.

use std::fmt;
use std::path::{Path, PathBuf};

use miette::{Diagnostic, LabeledSpan, SourceCode};

use crate::excerpt::Excerpt;
use crate::printable::{printable, printable_line, printable_path};

/// Failure to read or write a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Content of an input file violates its format.
    #[error(transparent)]
    Input(Box<InputError>),
    /// An input file cannot be read at all.
    #[error("{}: cannot be read: {reason}", printable_path(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        reason: std::io::Error,
    },
    /// An output file cannot be written; nothing was left behind.
    #[error("{}: cannot be written: {reason}", printable_path(path))]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        reason: std::io::Error,
    },
    /// A value in memory cannot be written because no reader would accept it.
    #[error(
        "{}: not written: found {}, expected {}",
        printable_path(path),
        printable_line(found),
        printable_line(expected)
    )]
    InvalidValue {
        /// The file that was to be written.
        path: PathBuf,
        /// The value, in words.
        found: String,
        /// Expected values, in words.
        expected: String,
    },
    /// The name of a model file gives no name of a Rust module.
    #[error(
        "{}: not written: found the module name `{}`, expected lower-case words joined by `_` \
         before the first dot that are no Rust keyword",
        printable_path(path),
        printable_line(found)
    )]
    ModuleName {
        /// The file that was to be written.
        path: PathBuf,
        /// Its name up to the first dot.
        found: String,
    },
}

impl Error {
    /// What a written text is refused for, as the refusal of the file that it becomes.
    pub(crate) fn of_written(self, path: &Path) -> Self {
        match self {
            Self::Input(error) => Self::InvalidValue {
                path: path.to_owned(),
                found: error.found,
                expected: error.expected,
            },
            other => other,
        }
    }
}

/// Makes the error of a file that cannot be read.
pub(crate) fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    move |reason| Error::Unreadable {
        path: path.to_owned(),
        reason,
    }
}

/// Makes the error of a file that cannot be written.
pub(crate) fn unwritable(path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    move |reason| Error::Unwritable {
        path: path.to_owned(),
        reason,
    }
}

impl Diagnostic for Error {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let code = match self {
            Self::Input(error) => return error.code(),
            Self::Unreadable { .. } => "gyrocal::file::unreadable",
            Self::Unwritable { .. } => "gyrocal::file::unwritable",
            Self::InvalidValue { .. } => "gyrocal::file::invalid_value",
            Self::ModuleName { .. } => "gyrocal::file::module_name",
        };
        Some(Box::new(code))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let advice = match self {
            Self::Input(error) => return error.help(),
            // The reason has the advice, or the decoder knows none.
            Self::Unreadable { reason, .. } if reason.kind() == std::io::ErrorKind::Other => {
                return None;
            }
            Self::Unreadable { .. } => "check that the file exists and that you may read it",
            Self::Unwritable { .. } => {
                "check that the folder exists, that you may write there and that the disk has room"
            }
            Self::InvalidValue { .. } => return None,
            Self::ModuleName { .. } => "give the file another name, such as `extended.model.toml`",
        };
        Some(Box::new(advice))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self {
            Self::Input(error) => error.source_code(),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        match self {
            Self::Input(error) => error.labels(),
            _ => None,
        }
    }
}

/// Kind of a fault in an input file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputErrorKind {
    /// The file has no content.
    Empty,
    /// The file is not UTF-8 text.
    NotUtf8,
    /// The file is not TOML, or not CSV.
    Syntax,
    /// The header row is missing, or a column of it is unknown, missing or doubled.
    Header,
    /// A row has more or fewer fields than the header.
    FieldCount,
    /// A field or value is not a number.
    NotANumber,
    /// Time repeats or goes back.
    Time,
    /// Readings never change.
    Stuck,
    /// There are fewer rows than the job needs.
    TooFewRows,
    /// The norm of specific force is far from 1 g.
    Norm,
    /// A key that the format does not have.
    UnknownKey,
    /// A key that the format needs is absent.
    MissingKey,
    /// A value of another type than the key takes.
    WrongType,
    /// A number outside the range that makes sense.
    OutOfRange,
}

impl InputErrorKind {
    fn code(self) -> &'static str {
        match self {
            Self::Empty => "gyrocal::input::empty",
            Self::NotUtf8 => "gyrocal::input::not_utf8",
            Self::Syntax => "gyrocal::input::syntax",
            Self::Header => "gyrocal::input::header",
            Self::FieldCount => "gyrocal::input::field_count",
            Self::NotANumber => "gyrocal::input::not_a_number",
            Self::Time => "gyrocal::input::time",
            Self::Stuck => "gyrocal::input::stuck",
            Self::TooFewRows => "gyrocal::input::too_few_rows",
            Self::Norm => "gyrocal::input::norm",
            Self::UnknownKey => "gyrocal::input::unknown_key",
            Self::MissingKey => "gyrocal::input::missing_key",
            Self::WrongType => "gyrocal::input::wrong_type",
            Self::OutOfRange => "gyrocal::input::out_of_range",
        }
    }
}

/// An error at one place of one file.
///
/// `Display` is `file:line:column: found …, expected …`; [`Diagnostic`] adds the marked line
/// and the advice. Text of the file is shown with its control characters escaped, and long lines
/// are cut to a window around the place; the fields hold what was found, cut if it is long.
#[derive(Debug, Clone)]
pub struct InputError {
    /// Kind of the fault.
    pub kind: InputErrorKind,
    /// Line of the place, from 1.
    pub line: usize,
    /// Column of the place in characters, from 1.
    pub column: usize,
    /// Content found at the place, in words.
    pub found: String,
    /// Expected content, in words.
    pub expected: String,
    /// Advice to the user; empty if `expected` suffices.
    pub advice: String,
    pub(crate) excerpt: Excerpt,
}

impl InputError {
    /// The name of the file as it was given.
    #[must_use]
    pub fn file(&self) -> &str {
        self.excerpt.name()
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{}:{}:{}: found {}, expected {}",
            printable_line(self.file()),
            self.line,
            self.column,
            printable_line(&self.found),
            printable_line(&self.expected)
        )
    }
}

impl core::error::Error for InputError {}

impl Diagnostic for InputError {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.kind.code()))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        (!self.advice.is_empty())
            .then(|| Box::new(printable(&self.advice)) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.excerpt)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::new_with_span(Some("here".to_owned()), self.excerpt.span());
        Some(Box::new(core::iter::once(label)))
    }
}

//! Failures as plain data, and the exceptions that they become.

use std::fmt::Display;

use miette::Diagnostic;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyDict};

/// The module of the exceptions.
const EXCEPTIONS: &str = "gyrocal._errors";

/// Class of the exception.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Class {
    /// An argument, a file, a frame or one of its values.
    #[default]
    Input,
    /// The computation.
    Computation,
    /// A gross error of the set-up leaves nothing sound.
    Setup,
}

/// A failure of a call, without the interpreter.
#[derive(Clone, Debug, Default)]
pub(crate) struct Failure {
    pub(crate) class: Class,
    pub(crate) message: String,
    pub(crate) code: Option<String>,
    pub(crate) file: Option<String>,
    pub(crate) line: Option<usize>,
    pub(crate) column: Option<usize>,
    pub(crate) found: Option<String>,
    pub(crate) expected: Option<String>,
    /// What to do.
    pub(crate) advice: Option<String>,
    /// The causes, each of the one before it.
    pub(crate) causes: Vec<String>,
    /// The result for programs (JSON) that tells the same.
    pub(crate) result: Option<String>,
}

/// Result of a call.
pub(crate) type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// A failure with nothing but its words.
    pub(crate) fn of_text(error: &impl Display) -> Self {
        Self {
            message: error.to_string(),
            ..Self::default()
        }
    }

    /// A value other than expected, at a place in words such as "column `time_s` of <DataFrame>".
    pub(crate) fn of_value(
        place: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: &str,
    ) -> Self {
        let (found, expected) = (found.into(), expected.into());
        Self {
            message: format!("{place}: found {found}, expected {expected}"),
            found: Some(found),
            expected: Some(expected),
            advice: Some(advice.to_owned()).filter(|advice| !advice.is_empty()),
            ..Self::default()
        }
    }

    /// Refuses a number that is no probability between 0 and 1.
    pub(crate) fn unless_probability(place: &str, value: f64) -> Outcome<f64> {
        match value > 0.0 && value < 1.0 {
            true => Ok(value),
            false => Err(Self::of_value(
                place,
                format!("{value}"),
                "a probability between 0 and 1",
                "",
            )),
        }
    }

    /// A failed computation, with its code, causes and advice.
    pub(crate) fn of_work(error: &dyn Diagnostic) -> Self {
        let mut causes = Vec::new();
        let mut cause = error.source();
        while let Some(this) = cause {
            // A transparent error repeats its source.
            let text = this.to_string();
            if causes.last() != Some(&text) {
                causes.push(text);
            }
            cause = this.source();
        }
        Self {
            class: Class::Computation,
            message: error.to_string(),
            code: error.code().map(|code| code.to_string()),
            advice: error.help().map(|help| help.to_string()),
            causes,
            ..Self::default()
        }
    }
}

impl From<gyrocal_record::Error> for Failure {
    fn from(error: gyrocal_record::Error) -> Self {
        use gyrocal_record::Error;

        let plain = Self {
            class: Class::Input,
            ..Self::of_work(&error)
        };
        match error {
            Error::Input(input) => Self {
                file: Some(input.file().to_owned()),
                line: Some(input.line),
                column: Some(input.column),
                found: Some(input.found),
                expected: Some(input.expected),
                ..plain
            },
            Error::Unreadable { path, .. } | Error::Unwritable { path, .. } => Self {
                file: Some(path.display().to_string()),
                ..plain
            },
            Error::InvalidValue {
                path,
                found,
                expected,
            } => Self {
                file: Some(path.display().to_string()),
                found: Some(found),
                expected: Some(expected),
                ..plain
            },
            _ => plain,
        }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| exception(py, failure).unwrap_or_else(|error| error))
    }
}

fn exception(py: Python<'_>, failure: Failure) -> PyResult<PyErr> {
    let class = match failure.class {
        Class::Input => "InputError",
        Class::Computation => "ComputationError",
        Class::Setup => "SetupError",
    };
    let fields: Bound<'_, PyDict> = [
        ("code", failure.code),
        ("file", failure.file),
        ("found", failure.found),
        ("expected", failure.expected),
        ("advice", failure.advice),
        ("result", failure.result),
    ]
    .into_py_dict(py)?;
    fields.set_item("line", failure.line)?;
    fields.set_item("column", failure.column)?;
    fields.set_item("causes", failure.causes)?;
    let class = py.import(EXCEPTIONS)?.getattr(class)?;
    Ok(PyErr::from_value(
        class.call((failure.message,), Some(&fields))?,
    ))
}

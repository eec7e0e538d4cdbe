//! Shared parts of the commands on logs of real sensors.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use gyrocal_instruments::InstrumentError;
use gyrocal_record::printable_path;
use miette::Diagnostic;

use crate::Failure;

/// An error of a log as a failure of the command.
pub(crate) fn unusable(log: &Path, error: InstrumentError) -> Failure {
    match error {
        InstrumentError::File(error) => error.into(),
        InstrumentError::Unfit {
            found,
            expected,
            advice,
            ..
        } => Failure::Work(
            Unusable {
                log: log.to_owned(),
                found,
                expected,
                advice,
            }
            .into(),
        ),
        other => Failure::of(log, other),
    }
}

#[derive(Debug, thiserror::Error)]
#[error("{}: found {found}, expected {expected}", printable_path(log))]
struct Unusable {
    log: PathBuf,
    found: String,
    expected: String,
    advice: String,
}

impl Diagnostic for Unusable {
    fn code<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new("gyrocal::measured::unfit"))
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(&self.advice))
    }
}

/// Parses `FROM:TO`.
pub(crate) fn interval(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(':')
        .and_then(|(from, to)| Some([from.parse::<f64>().ok()?, to.parse::<f64>().ok()?]));
    ends.filter(|[from, to]| from < to)
        .ok_or_else(|| "expected two times in seconds, FROM:TO, FROM before TO".to_owned())
}

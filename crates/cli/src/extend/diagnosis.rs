//! What a diagnosis found, as far as a model file is made of it.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SCHEMA_VERSION, SourceText};
use serde::Deserialize;

/// The result of `gyrocal diagnose --json`; other fields do not matter here.
#[derive(Debug, Deserialize)]
pub(super) struct Diagnosis {
    schema_version: u32,
    pub(super) verdict: String,
    pub(super) findings: Vec<Finding>,
}

/// One finding.
#[derive(Debug, Deserialize)]
pub(super) struct Finding {
    pub(super) effect: String,
    pub(super) parameters: Vec<Parameter>,
    #[serde(default)]
    pub(super) equivalents: Vec<Equivalent>,
}

/// A parameter that was estimated.
#[derive(Debug, Deserialize)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) estimate: f64,
    pub(super) sigma: Option<f64>,
}

/// An effect that no record can tell from the one that was found.
#[derive(Debug, Deserialize)]
pub(super) struct Equivalent {
    pub(super) effect: String,
}

impl Diagnosis {
    /// Reads a result.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let source = SourceText::read(path)?;
        let diagnosis: Self = serde_json::from_str(source.text()).map_err(|error| {
            let place = offset(source.text(), error.line(), error.column());
            let reason = error.to_string();
            let reason = reason.split(" at line ").next().unwrap_or_default();
            source.error(
                InputErrorKind::Syntax,
                place..place,
                format!("JSON that is no result of a diagnosis ({reason})"),
                "what `gyrocal diagnose --json` writes",
                "write it again with `gyrocal diagnose`",
            )
        })?;
        if diagnosis.schema_version == SCHEMA_VERSION {
            return Ok(diagnosis);
        }
        let place = source.text().find("\"schema_version\"").unwrap_or(0);
        Err(source.error(
            InputErrorKind::OutOfRange,
            place..place,
            format!("schema_version {}", diagnosis.schema_version),
            format!("{SCHEMA_VERSION}, the version that this program knows"),
            "write it again with `gyrocal diagnose` of this version",
        ))
    }
}

/// The byte of a line and column from 1, the column in bytes, within the text.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let before = text.split_inclusive('\n').take(line.saturating_sub(1));
    let start: usize = before.map(str::len).sum();
    let mut place = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(place) {
        place -= 1;
    }
    place
}

//! Reads the result of a diagnosis.

use std::path::Path;

use gyrocal_record::{DiagnosisReport, Error, InputErrorKind, SCHEMA_VERSION, SourceText};
use serde::Deserialize;

/// What results of any version have.
#[derive(Deserialize)]
struct Versioned {
    schema_version: u32,
}

/// Reads the result of `gyrocal diagnose --json`. The version is checked first: keys of another
/// version may differ.
pub(crate) fn read(path: &Path) -> Result<DiagnosisReport, Error> {
    let source = SourceText::read(path)?;
    let text = source.text();
    let versioned: Versioned =
        serde_json::from_str(text).map_err(|error| no_diagnosis(&source, &error))?;
    if versioned.schema_version != SCHEMA_VERSION {
        let place = text.find("\"schema_version\"").unwrap_or(0);
        return Err(source.error(
            InputErrorKind::OutOfRange,
            place..place,
            format!("schema_version {}", versioned.schema_version),
            format!("{SCHEMA_VERSION}, the version of this program"),
            "write it again with `gyrocal diagnose` of this version",
        ));
    }
    serde_json::from_str(text).map_err(|error| no_diagnosis(&source, &error))
}

fn no_diagnosis(source: &SourceText, error: &serde_json::Error) -> Error {
    let place = offset(source.text(), error.line(), error.column());
    let reason = error.to_string();
    let reason = reason.split(" at line ").next().unwrap_or_default();
    source.error(
        InputErrorKind::Syntax,
        place..place,
        format!("JSON that is not the result of a diagnosis ({reason})"),
        "the result of `gyrocal diagnose --json`",
        "write it again with `gyrocal diagnose`",
    )
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

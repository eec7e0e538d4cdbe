//! Reading a written result.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText};
use serde::Deserialize;

use crate::{Answer, PlantFit, SCHEMA_VERSION, Subject};

/// The key that results of any version have.
#[derive(Deserialize)]
struct Versioned {
    schema_version: u32,
}

/// Reads a result that `gyrocal diagnose --json` wrote.
///
/// # Errors
/// As [`read_text`], and [`Error::Unreadable`] if there is no such file.
// Both inline: the code of the deserialisation, a third of this package's, is made where it is used.
#[inline]
pub fn read(path: &Path) -> Result<Answer, Error> {
    read_text(&SourceText::read(path)?)
}

/// Reads a result from a text. The version is checked before anything else, as another version may
/// have other keys.
///
/// # Errors
/// [`Error::Input`] with line and column if the text is no result of this version.
#[inline]
pub fn read_text(source: &SourceText) -> Result<Answer, Error> {
    let text = source.text();
    let versioned: Versioned =
        serde_json::from_str(text).map_err(|error| no_diagnosis(source, &error))?;
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
    serde_json::from_str(text).map_err(|error| no_diagnosis(source, &error))
}

/// Reads the answer of a platform or of a strapdown unit, that `gyrocal diagnose --json` wrote.
///
/// # Errors
/// As [`read`], and [`Error::Input`] if the answer is of a plant.
#[inline]
pub fn read_platform(path: &Path) -> Result<Answer, Error> {
    read_platform_text(&SourceText::read(path)?)
}

/// The same from a text.
///
/// # Errors
/// As [`read_text`], and [`Error::Input`] if the answer is of a plant.
#[inline]
pub fn read_platform_text(source: &SourceText) -> Result<Answer, Error> {
    let answer = read_text(source)?;
    let Subject::Plant(name) = &answer.subject else {
        return Ok(answer);
    };
    let place = source.text().find("\"subject\"").unwrap_or(0);
    Err(source.error(
        InputErrorKind::OutOfRange,
        place..place,
        format!("an answer on the plant `{name}`"),
        "an answer on a platform or a strapdown unit",
        "give a result of `gyrocal diagnose`; `gyrocal plant extend` takes this one",
    ))
}

/// Reads the fit of a plant, that `gyrocal plant fit --json` wrote.
///
/// # Errors
/// [`Error::Unreadable`], and [`Error::Input`] with line and column if it is no such fit.
#[inline]
pub fn read_fit(path: &Path) -> Result<PlantFit, Error> {
    let source = SourceText::read(path)?;
    let read = serde_json::from_str(source.text());
    read.map_err(|error| no_result(&source, &error, ["fit of a plant", "gyrocal plant fit"]))
}

fn no_diagnosis(source: &SourceText, error: &serde_json::Error) -> Error {
    no_result(source, error, ["diagnosis", "gyrocal diagnose"])
}

/// Refuses what is not the result of some work, which a command writes.
fn no_result(source: &SourceText, error: &serde_json::Error, [work, command]: [&str; 2]) -> Error {
    let place = offset(source.text(), error.line(), error.column());
    let reason = error.to_string();
    let reason = reason.split(" at line ").next().unwrap_or_default();
    source.error(
        InputErrorKind::Syntax,
        place..place,
        format!("JSON that is not the result of a {work} ({reason})"),
        format!("the result of `{command} --json`"),
        format!("write it again with `{command}`"),
    )
}

/// The byte of a line and column, both counted from 1, the column in bytes.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let before = text.split_inclusive('\n').take(line.saturating_sub(1));
    let start: usize = before.map(str::len).sum();
    let mut place = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(place) {
        place -= 1;
    }
    place
}

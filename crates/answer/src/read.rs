//! Reading a written result.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText};
use serde::Deserialize;

use crate::{Answer, PlantFit, SCHEMA_VERSION, Subject};

/// The hash of the model that a result is of, where it tells one.
#[derive(Deserialize)]
struct OfModel {
    manifest: ModelHash,
}

#[derive(Deserialize)]
struct ModelHash {
    model_hash: String,
}

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
    let made_by = ["diagnosis", "gyrocal diagnose"];
    refuse_other_version(source, SCHEMA_VERSION, made_by)?;
    let read = serde_json::from_str(source.text());
    read.map_err(|error| no_result(source, &error, made_by))
}

/// Refuses a result of another version than this program's.
fn refuse_other_version(
    source: &SourceText,
    expected: u32,
    made_by: [&str; 2],
) -> Result<(), Error> {
    let text = source.text();
    let read = serde_json::from_str(text);
    let Versioned { schema_version } = read.map_err(|error| no_result(source, &error, made_by))?;
    if schema_version == expected {
        return Ok(());
    }
    let place = text.find("\"schema_version\"").unwrap_or(0);
    Err(source.error(
        InputErrorKind::OutOfRange,
        place..place,
        format!("schema_version {schema_version}"),
        format!("{expected}, the version of this program"),
        format!("write it again with `{}` of this version", made_by[1]),
    ))
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

/// Reads the fit of a plant, that `gyrocal plant fit --json` of this version wrote, and the hash of the program of the
/// plant; it is empty in files of the time before it was written.
///
/// # Errors
/// [`Error::Unreadable`], and [`Error::Input`] with line and column if it is no such fit.
#[inline]
pub fn read_fit(path: &Path) -> Result<(PlantFit, String), Error> {
    let source = SourceText::read(path)?;
    let made_by = ["fit of a plant", "gyrocal plant fit"];
    refuse_other_version(&source, gyrocal_record::SCHEMA_VERSION, made_by)?;
    let fit = serde_json::from_str(source.text());
    let fit = fit.map_err(|error| no_result(&source, &error, made_by))?;
    let of_model = serde_json::from_str::<OfModel>(source.text());
    let hash = of_model.map_or_else(|_| String::new(), |one| one.manifest.model_hash);
    Ok((fit, hash))
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

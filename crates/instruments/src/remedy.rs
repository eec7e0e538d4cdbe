//! The line of a description that makes a refused place of a file readable.

use crate::date_time::seconds_of;
use crate::file_format::{Decimal, Delimiter, FileFormat};

/// Beginnings of comments that programs write.
const COMMENTS: [&str; 5] = ["#", "%", "//", "!", "*"];

/// Words that programs write for a missing value.
const MISSING: [&str; 8] = ["na", "n/a", "null", "none", "-", "--", "#n/a", "missing"];

/// The advice to add a line to a table of the description.
fn add(line: &str, table: &str) -> String {
    format!("add `{line}` to `[{table}]` of the map (`--columns MAP.toml`)")
}

/// Remedy for a line whose fields are not those expected.
pub(crate) fn of_line(format: &FileFormat, line: &str) -> Option<String> {
    let begins = |sign: &&&str| line.starts_with(**sign);
    if let Some(sign) = COMMENTS.iter().find(begins)
        && format.comment.is_none()
    {
        return Some(add(&format!("comment = \"{sign}\""), "file"));
    }
    let others = [
        (Delimiter::Semicolon, ';', "semicolon"),
        (Delimiter::Tab, '\t', "tab"),
        (Delimiter::Bar, '|', "bar"),
        (Delimiter::Comma, ',', "comma"),
    ];
    let count = |sign: char| line.matches(sign).count();
    let is_there = |(delimiter, sign, _): &(Delimiter, char, &str)| {
        // A time and three accelerometers have three separators.
        *delimiter != format.delimiter && count(*sign) >= 3
    };
    if others.iter().any(|(delimiter, sign, _)| *delimiter == format.delimiter && count(*sign) >= 3) {
        return None;
    }
    if let Some((_, _, word)) = others.into_iter().find(is_there) {
        return Some(add(&format!("delimiter = \"{word}\""), "file"));
    }
    (format.delimiter != Delimiter::Space && line.split_whitespace().count() > 3)
        .then(|| add("delimiter = \"space\"", "file"))
}

/// Remedy for a field that is no number.
pub(crate) fn of_number(format: &FileFormat, text: &str) -> Option<String> {
    if format.decimal == Decimal::Point && Decimal::Comma.number(text).is_some_and(f64::is_finite) {
        return Some(add("decimal = \"comma\"", "file"));
    }
    None
}

/// Remedy for a time that is no number.
pub(crate) fn of_time(format: &FileFormat, text: &str) -> Option<String> {
    match seconds_of(text) {
        Some(_) => Some(add("unit = \"rfc3339\"", "time")),
        None => of_number(format, text),
    }
}

/// Remedy for a value that is no number and may be missing, in the row of this number from 0.
pub(crate) fn of_value(format: &FileFormat, text: &str, row: usize) -> Option<String> {
    if let Some(remedy) = of_number(format, text) {
        return Some(remedy);
    }
    if MISSING.contains(&text.to_lowercase().as_str()) {
        return Some(add(&format!("missing = [\"{text}\"]"), "file"));
    }
    (row == 0).then(|| add(&format!("skip_rows = {}", format.skip_rows + 1), "file"))
}

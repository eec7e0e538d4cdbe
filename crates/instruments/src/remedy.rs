//! The line of a description that makes a refused place of a file readable.

use crate::date_time::DateTimes;
use crate::file_format::{Decimal, Delimiter, FileFormat};

/// Beginnings of comments that programs write.
pub(crate) const COMMENTS: [&str; 5] = ["#", "%", "//", "!", "*"];

/// Words that programs write for a missing value.
const MISSING: [&str; 8] = ["na", "n/a", "null", "none", "-", "--", "#n/a", "missing"];

/// Formats of dates and times that programs write, beside RFC 3339.
const FORMATS: [&str; 8] = [
    "%d.%m.%Y %H:%M:%S%.f",
    "%d/%m/%Y %H:%M:%S%.f",
    "%m/%d/%Y %H:%M:%S%.f",
    "%m/%d/%Y %I:%M:%S%.f %p",
    "%Y/%m/%d %H:%M:%S%.f",
    "%d-%b-%Y %H:%M:%S%.f",
    "%Y %j %H:%M:%S%.f",
    "%H:%M:%S%.f",
];

/// The advice to add a line to a table of the description.
fn add(line: &str, table: &str) -> String {
    format!("add `{line}` to `[{table}]` of the map or description of the log")
}

/// Remedy for a line whose fields are not those expected.
pub(crate) fn of_line(format: &FileFormat, line: &str) -> Option<String> {
    let begins = |sign: &&&str| line.starts_with(**sign);
    if let Some(sign) = COMMENTS.iter().find(begins)
        && format.comment.is_none()
    {
        return Some(add(&format!("comment = \"{sign}\""), "file"));
    }
    match delimiter_of(line) {
        Some(delimiter) if delimiter != format.delimiter && !separates(format.delimiter, line) => {
            Some(add(
                &format!("delimiter = \"{}\"", word_of(delimiter)),
                "file",
            ))
        }
        _ => None,
    }
}

/// Fewest separators of a line: those between a time and three accelerometers.
const FEWEST: usize = 3;

fn separates(delimiter: Delimiter, line: &str) -> bool {
    let count = |sign: char| line.matches(sign).count();
    FEWEST
        <= match delimiter {
            Delimiter::Comma => count(','),
            Delimiter::Semicolon => count(';'),
            Delimiter::Tab => count('\t'),
            Delimiter::Bar => count('|'),
            Delimiter::Space => line.split_whitespace().count().saturating_sub(1),
        }
}

/// The delimiter that a line seems to have.
pub(crate) fn delimiter_of(line: &str) -> Option<Delimiter> {
    // Decimal commas are between other signs, and blanks within names.
    [
        Delimiter::Semicolon,
        Delimiter::Tab,
        Delimiter::Bar,
        Delimiter::Comma,
        Delimiter::Space,
    ]
    .into_iter()
    .find(|delimiter| separates(*delimiter, line))
}

/// The word of a delimiter in a description.
pub(crate) fn word_of(delimiter: Delimiter) -> &'static str {
    match delimiter {
        Delimiter::Comma => "comma",
        Delimiter::Semicolon => "semicolon",
        Delimiter::Tab => "tab",
        Delimiter::Bar => "bar",
        Delimiter::Space => "space",
    }
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
    if DateTimes::rfc3339().seconds(text).is_some() {
        return Some(add("unit = \"rfc3339\"", "time"));
    }
    of_date(text).or_else(|| of_number(format, text))
}

/// Remedy for a date and time in words.
pub(crate) fn of_date(text: &str) -> Option<String> {
    let reads = |format: &&str| {
        DateTimes::of_format(format).is_some_and(|mut reader| reader.seconds(text).is_some())
    };
    // Day and month may be either.
    let lines: Vec<String> = FORMATS
        .iter()
        .filter(|format| reads(format))
        .map(|format| format!("`format = \"{format}\"`"))
        .collect();
    (!lines.is_empty()).then(|| {
        format!(
            "give {} in place of a `unit` in `[time]` of the map or description of the log",
            lines.join(" or ")
        )
    })
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

//! Selected columns of the file of a log, by name.

use core::ops::Range;
use std::path::Path;

use gyrocal_record::fields::{MOST_COLUMNS, too_many_columns};
use gyrocal_record::{Error, InputErrorKind, SourceText};

use crate::binary_file::read_binary;
use crate::date_time::seconds_of;
use crate::error::{InstrumentError, Unfit};
use crate::file_format::{FileFormat, Only};
use crate::log_lines::{LogLine, log_lines};
use crate::remedy;
use crate::typed_file::TypedFile;

/// Columns of a text file.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The values of each column, all finite.
    pub values: Vec<Vec<f64>>,
    /// Place of each row in the text of the file.
    pub places: Vec<Range<usize>>,
}

/// Most lines that are searched for a header behind a preamble.
const LONGEST_PREAMBLE: usize = 500;

/// Reads the columns `names`, in that order, from text with a header row, separated by commas.
///
/// # Errors
///
/// As [`read_described`].
pub fn read_columns(source: &SourceText, names: &[&str]) -> Result<Columns, Error> {
    read_described(source, &FileFormat::default(), names)
}

/// Reads the columns `names`, in that order, from text of a format. A preamble in front of the header is
/// passed over.
///
/// # Errors
///
/// [`Error::Input`], at its place, for a column that is absent or double, a row with more or
/// fewer fields than the header, a field that is not a finite number, or a file without rows.
pub fn read_described(
    source: &SourceText,
    format: &FileFormat,
    names: &[&str],
) -> Result<Columns, Error> {
    read_dated(source, format, names, None)
}

/// As [`read_described`], where the column `dated`, by its index in `names`, has dates and times.
pub(crate) fn read_dated(
    source: &SourceText,
    format: &FileFormat,
    names: &[&str],
    dated: Option<usize>,
) -> Result<Columns, Error> {
    let mut lines = log_lines(source, format).peekable();
    let selection = Selection::find(source, format, names, &mut lines)?;
    let mut values = vec![Vec::new(); names.len()];
    let mut places: Vec<Range<usize>> = Vec::new();
    for line in lines {
        if !selection.takes(source, format, &line)? {
            continue;
        }
        for (at, (column, &index)) in values.iter_mut().zip(&selection.indices).enumerate() {
            let field = &line.fields[index];
            column.push(match dated == Some(at) {
                true => date(source, field)?,
                false => number(source, format, field)?,
            });
        }
        places.push(line.span);
    }
    if places.is_empty() {
        return Err(selection.no_rows(source, format));
    }
    Ok(Columns { values, places })
}

/// The selected columns in the lines of a text.
#[derive(Debug)]
pub(crate) struct Selection {
    /// Place of the header, or of the first row of a file without one.
    pub(crate) header: Range<usize>,
    /// Field of each selected column.
    pub(crate) indices: Vec<usize>,
    /// Number of fields of a row.
    fields: usize,
    /// Field of the sensor's name.
    sensor: Option<usize>,
}

impl Selection {
    /// Finds the columns `names` in the header, and takes the lines up to the first row.
    pub(crate) fn find<'a>(
        source: &'a SourceText,
        format: &'a FileFormat,
        names: &[&str],
        lines: &mut core::iter::Peekable<impl Iterator<Item = LogLine<'a>>>,
    ) -> Result<Self, Error> {
        let header = header(source, format, names, lines);
        if header.fields.len() > MOST_COLUMNS {
            let start = header.span.start;
            return Err(too_many_columns(source, start..start, header.fields.len()));
        }
        let titles: Vec<&str> = match format.header {
            true => header.fields.iter().map(|(_, text)| *text).collect(),
            false => Vec::new(),
        };
        let index = |name: &str| match format.header {
            true => index(source, format, &header, &titles, name),
            false => number_of(source, format, &header, name),
        };
        let indices = names
            .iter()
            .map(|name| index(name))
            .collect::<Result<Vec<usize>, Error>>()?;
        let sensor = match &format.only {
            Some(only) => Some(index(&only.column)?),
            None => None,
        };
        for _ in 0..format.skip_rows {
            lines.next();
        }
        Ok(Self {
            header: header.span,
            indices,
            fields: header.fields.len(),
            sensor,
        })
    }

    /// Whether a line is a row of the sensor.
    pub(crate) fn takes(
        &self,
        source: &SourceText,
        format: &FileFormat,
        line: &LogLine<'_>,
    ) -> Result<bool, Error> {
        if let (Some(index), Some(only)) = (self.sensor, &format.only)
            && !is_of_sensor(line, index, only)
        {
            return Ok(false);
        }
        if line.fields.len() != self.fields {
            return Err(self.field_count(source, format, line));
        }
        Ok(true)
    }

    /// The error of a file without rows.
    pub(crate) fn no_rows(&self, source: &SourceText, format: &FileFormat) -> Error {
        let found = match &format.only {
            Some(only) => format!(
                "no row with `{}` in the column `{}`",
                only.equals, only.column
            ),
            None => "a header without rows".to_owned(),
        };
        source.error(
            InputErrorKind::TooFewRows,
            self.header.start..self.header.start,
            found,
            "samples",
            "check that the program that wrote the log had finished",
        )
    }

    fn field_count(&self, source: &SourceText, format: &FileFormat, line: &LogLine<'_>) -> Error {
        let first = if format.header {
            "the header"
        } else {
            "the first row"
        };
        if line.fields.len() < self.fields && source.ends_within_line(&line.span) {
            return source.error(
                InputErrorKind::FieldCount,
                line.span.clone(),
                format!(
                    "a last line that is cut off, with {} fields",
                    line.fields.len()
                ),
                format!("{} fields, as {first} has", self.fields),
                "the file ends within this line, as if its writer or a copy was stopped: copy the file \
                 again, or delete this line",
            );
        }
        let advice =
            remedy::of_line(format, &source.text()[line.span.clone()]).unwrap_or_else(|| {
                format!(
                    "decimal numbers have a point, and fields are separated by {}; `delimiter` in \
                 `[file]` names others",
                    format.delimiter.description()
                )
            });
        source.error(
            InputErrorKind::FieldCount,
            line.span.clone(),
            format!("{} fields", line.fields.len()),
            format!("{} fields, as {first} has", self.fields),
            advice,
        )
    }
}

/// Columns of a file, with the text that errors can point into; binary files have none.
#[derive(Debug)]
pub(crate) struct FileColumns {
    pub(crate) values: Vec<Vec<f64>>,
    pub(crate) text: Option<(SourceText, Vec<Range<usize>>)>,
}

impl FileColumns {
    /// An error of a row: at its place in a text, by its number in a binary file. The words say what was
    /// found, what was expected and what to do.
    pub(crate) fn error_at(
        &self,
        row: usize,
        kind: InputErrorKind,
        unfit: Unfit,
        [found, expected, advice]: [&str; 3],
    ) -> InstrumentError {
        match &self.text {
            Some((source, places)) => source
                .error(kind, places[row].clone(), found, expected, advice)
                .into(),
            None => InstrumentError::unfit(
                unfit,
                format!("{found} in record {}", row + 1),
                expected,
                advice,
            ),
        }
    }

    /// Reads the columns `names` of a file of any format. Time stamps of typed columns are in units of `unit_s`.
    pub(crate) fn read(
        path: &Path,
        format: &FileFormat,
        names: &[&str],
        dated: Option<usize>,
        unit_s: f64,
    ) -> Result<Self, InstrumentError> {
        let values = match (&format.binary, TypedFile::of(path)?) {
            (Some(binary), _) => read_binary(path, binary, format.only.as_ref(), names)?,
            (None, Some(typed)) => typed.columns(path, format, names, dated, unit_s)?,
            (None, None) => return Self::of_text(SourceText::read(path)?, format, names, dated),
        };
        Ok(Self { values, text: None })
    }

    pub(crate) fn of_text(
        source: SourceText,
        format: &FileFormat,
        names: &[&str],
        dated: Option<usize>,
    ) -> Result<Self, InstrumentError> {
        let Columns { values, places } = read_dated(&source, format, names, dated)?;
        Ok(Self {
            values,
            text: Some((source, places)),
        })
    }
}

/// The header, or the first row of a file without one, which is not consumed.
fn header<'a>(
    source: &'a SourceText,
    format: &'a FileFormat,
    names: &[&str],
    lines: &mut core::iter::Peekable<impl Iterator<Item = LogLine<'a>>>,
) -> LogLine<'a> {
    let empty = || LogLine {
        span: 0..0,
        fields: Vec::new(),
    };
    if !format.header {
        // Peeking keeps the row; its fields are few.
        return lines.peek().map_or_else(empty, |line| LogLine {
            span: line.span.clone(),
            fields: line.fields.clone(),
        });
    }
    let has_all = |line: &LogLine<'_>| {
        names
            .iter()
            .all(|name| line.fields.iter().any(|(_, text)| text == name))
    };
    let before = log_lines(source, format)
        .take(LONGEST_PREAMBLE)
        .position(|line| has_all(&line))
        .unwrap_or(0);
    lines.nth(before).unwrap_or_else(empty)
}

fn is_of_sensor(line: &LogLine<'_>, index: usize, only: &Only) -> bool {
    let Some((_, text)) = line.fields.get(index) else {
        return false;
    };
    let same_number = || {
        let [found, expected] = [text.parse::<f64>().ok()?, only.equals.parse::<f64>().ok()?];
        Some(found == expected)
    };
    *text == only.equals || same_number().unwrap_or(false)
}

/// Index of the column of a name.
fn index(
    source: &SourceText,
    format: &FileFormat,
    header: &LogLine<'_>,
    titles: &[&str],
    name: &str,
) -> Result<usize, Error> {
    let mut indices = (0..titles.len()).filter(|index| titles[*index] == name);
    let advice = remedy::of_line(format, &source.text()[header.span.clone()])
        .unwrap_or_else(|| format!("the columns are {}", titles.join(", ")));
    let error = |found: String, expected: String| {
        let span = header.span.clone();
        source.error(InputErrorKind::Header, span, found, expected, &*advice)
    };
    match (indices.next(), indices.next()) {
        (Some(index), None) => Ok(index),
        (None, _) if let Some(swapped) = source.description_in_place_of_table() => Err(swapped),
        (None, _) => Err(error(
            "a header without it".to_owned(),
            format!("a column `{name}`"),
        )),
        (Some(_), Some(_)) => Err(error(
            format!("the column `{name}` twice"),
            "each column once".to_owned(),
        )),
    }
}

/// Index of a column of a file without header, by its number from one.
fn number_of(
    source: &SourceText,
    format: &FileFormat,
    first: &LogLine<'_>,
    name: &str,
) -> Result<usize, Error> {
    let count = first.fields.len();
    match name.parse::<usize>() {
        Ok(number) if (1..=count).contains(&number) => Ok(number - 1),
        _ => Err(source.error(
            InputErrorKind::Header,
            first.span.clone(),
            format!("{count} columns without a header"),
            format!("a column `{name}`"),
            remedy::of_line(format, &source.text()[first.span.clone()]).unwrap_or_else(|| {
                format!("without a header columns are called \"1\" to \"{count}\"")
            }),
        )),
    }
}

fn number(
    source: &SourceText,
    format: &FileFormat,
    (span, text): &(Range<usize>, &str),
) -> Result<f64, Error> {
    let number = format.decimal.number(text);
    number.filter(|value| value.is_finite()).ok_or_else(|| {
        source.error(
            InputErrorKind::NotANumber,
            span.clone(),
            format!("`{}`", &source.text()[span.clone()]),
            "a finite number",
            remedy::of_number(format, text).unwrap_or_else(|| {
                "cut the log before the first sample that is missing".to_owned()
            }),
        )
    })
}

fn date(source: &SourceText, (span, text): &(Range<usize>, &str)) -> Result<f64, Error> {
    seconds_of(text).ok_or_else(|| {
        source.error(
            InputErrorKind::Time,
            span.clone(),
            format!("`{}`", &source.text()[span.clone()]),
            "a date and time of RFC 3339",
            "write 2026-03-01T12:00:00Z, with a fraction and an offset if there are any",
        )
    })
}

//! The selected columns in the lines of a text: header, rows, headers that come again.

use core::ops::Range;

use gyrocal_record::fields::{MOST_COLUMNS, too_many_columns};
use gyrocal_record::{Error, InputErrorKind, SourceText};

use crate::file_format::{FileFormat, Only};
use crate::log_lines::{LogLine, log_lines};
use crate::remedy;

/// Most lines that are searched for a header behind a preamble.
const LONGEST_PREAMBLE: usize = 500;

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
    /// Line of the header; `None` of a file without one.
    title: Option<String>,
    /// Whether LabVIEW wrote the file: parts of it begin with lines of words.
    is_labview: bool,
    /// Lines that are still to be passed over behind a header.
    skip: usize,
    /// Line of the first header that came again, and the number of them.
    repeated: Option<(usize, usize)>,
}

/// First words of a file of LabVIEW.
const LABVIEW: &str = "LabVIEW Measurement";

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
        let title = format
            .header
            .then(|| source.text()[header.span.clone()].to_owned());
        let ends_empty = title.is_some() && header.ends_empty();
        Ok(Self {
            indices,
            fields: header.fields.len() - usize::from(ends_empty),
            header: header.span,
            sensor,
            title,
            is_labview: source.text().starts_with(LABVIEW),
            skip: format.skip_rows,
            repeated: None,
        })
    }

    /// Whether a line is a row of the sensor. The header that comes again is none.
    pub(crate) fn takes(
        &mut self,
        source: &SourceText,
        format: &FileFormat,
        line: &LogLine<'_>,
    ) -> Result<bool, Error> {
        if let Some(skip) = self.skip.checked_sub(1) {
            self.skip = skip;
            return Ok(false);
        }
        if self.title.as_deref() == Some(&source.text()[line.span.clone()]) {
            let (first, count) = self
                .repeated
                .unwrap_or_else(|| (source.line_and_column(line.span.start).0, 0));
            self.repeated = Some((first, count + 1));
            self.skip = format.skip_rows;
            return Ok(false);
        }
        if self.is_labview && line.begins_with_word() {
            return Ok(false);
        }
        if let (Some(index), Some(only)) = (self.sensor, &format.only)
            && !is_of_sensor(line, index, only)
        {
            return Ok(false);
        }
        // A separator may end each line.
        if line.fields.len() - usize::from(line.ends_empty()) != self.fields
            && line.fields.len() != self.fields
        {
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

    /// What there is to tell of headers within the file.
    pub(crate) fn repeated_note(&self, name: &str) -> Option<String> {
        let (line, count) = self.repeated?;
        Some(format!(
            "{name}:{line}: the header comes again here, in {count} line(s) of the file: they are passed over. Files that \
             were joined may have clocks of their own"
        ))
    }

    /// The error of a line of words where numbers are expected; another one if it is no header.
    pub(crate) fn or_second_header(
        &self,
        source: &SourceText,
        format: &FileFormat,
        line: &LogLine<'_>,
        error: Error,
    ) -> Error {
        let follows = line.span.start > self.header.end + 1 && self.title.is_some();
        // One word is a value that is none, of a file of one column.
        let is_one = self.fields < 2;
        if !follows || is_one || !line.is_of_words(format.decimal) {
            return error;
        }
        let (first, _) = source.line_and_column(self.header.start);
        let advice = match &error {
            Error::Input(input) if input.advice.contains("skip_rows") => return error,
            _ => format!(
                "split the file in front of this line if other columns begin here; if it is the header of line {first}, \
                 give it the same words, and it is passed over"
            ),
        };
        source.error(
            InputErrorKind::Header,
            line.span.clone(),
            "a second header, other than the first",
            format!("a row of numbers, or the header of line {first} again"),
            advice,
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

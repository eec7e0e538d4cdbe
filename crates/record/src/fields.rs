//! The fields of a CSV file, each with its place in the text.

use std::ops::Range;

use csv::{ByteRecord, Reader, ReaderBuilder};

use crate::error::{Error, InputErrorKind};
use crate::source::SourceText;

/// Reader of the lines of a CSV file; empty lines are skipped.
#[derive(Debug)]
pub struct Lines<'a> {
    source: &'a SourceText,
    reader: Reader<&'a [u8]>,
    fields: ByteRecord,
}

/// One line of a CSV file.
#[derive(Debug, Default)]
pub struct Line<'a> {
    /// Place in the text, without surrounding white space.
    pub span: Range<usize>,
    /// Fields of the line.
    pub fields: Vec<Field<'a>>,
}

/// One field, without surrounding white space.
#[derive(Debug)]
pub struct Field<'a> {
    /// Place in the text, quotation marks included.
    pub span: Range<usize>,
    /// Text without quotation marks.
    pub text: &'a str,
}

/// Most columns of a file. The header of a file with more is refused before anything is made of it.
pub const MOST_COLUMNS: usize = 10_000;

impl<'a> Lines<'a> {
    /// The lines of a text, its header included.
    #[must_use]
    pub fn of(source: &'a SourceText) -> Self {
        // Quotation marks are left to `Field`: names and numbers need none, and a field that
        // the reader had unquoted could not be found again in the text.
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .quoting(false)
            .from_reader(source.text().as_bytes());
        Self {
            source,
            reader,
            fields: ByteRecord::new(),
        }
    }

    /// The next line; `None` after the last.
    ///
    /// # Errors
    /// [`Error::Input`] for text that the CSV reader refuses, and for a line of more than
    /// [`MOST_COLUMNS`] fields.
    pub fn next_line(&mut self) -> Result<Option<Line<'a>>, Error> {
        while self.read()? {
            if self.fields.len() > MOST_COLUMNS {
                let start = self.start();
                return Err(too_many_columns(
                    self.source,
                    start..start,
                    self.fields.len(),
                ));
            }
            let line = self.line();
            if !line.span.is_empty() {
                return Ok(Some(line));
            }
        }
        Ok(None)
    }

    fn read(&mut self) -> Result<bool, Error> {
        let start = usize::try_from(self.reader.position().byte()).unwrap_or(0);
        self.reader
            .read_byte_record(&mut self.fields)
            .map_err(|error| {
                self.source.error(
                    InputErrorKind::Syntax,
                    start..start,
                    error.to_string(),
                    "comma-separated values",
                    "",
                )
            })
    }

    /// Where the line that was read begins.
    fn start(&self) -> usize {
        let text = self.source.text();
        let position = self.fields.position().map_or(0, csv::Position::byte);
        let position = usize::try_from(position).unwrap_or(text.len());
        // The reader's position is before the end of the previous line if that is two
        // characters, and before empty lines.
        let ends = text[position..].bytes();
        position
            + ends
                .take_while(|byte| matches!(byte, b'\r' | b'\n'))
                .count()
    }

    fn line(&self) -> Line<'a> {
        let text = self.source.text();
        let start = self.start();
        let fields: Vec<Field<'a>> = (0..self.fields.len())
            .filter_map(|field| {
                // One comma before each field but the first.
                let place = self.fields.range(field)?;
                Some(Field::at(
                    text,
                    start + field + place.start..start + field + place.end,
                ))
            })
            .collect();
        let span = match (fields.first(), fields.last()) {
            (Some(first), Some(last)) => first.span.start..last.span.end,
            _ => start..start,
        };
        Line { span, fields }
    }
}

/// The error of a line with more than [`MOST_COLUMNS`] fields.
#[must_use]
pub fn too_many_columns(source: &SourceText, place: Range<usize>, found: usize) -> Error {
    source.error(
        InputErrorKind::FieldCount,
        place,
        format!("{found} fields"),
        format!("at most {MOST_COLUMNS} fields"),
        "lines end with a line feed, and a row is a sample",
    )
}

impl<'a> Field<'a> {
    fn at(text: &'a str, place: Range<usize>) -> Self {
        let whole = &text[place.clone()];
        let bare = whole.trim();
        let start = place.start + (whole.len() - whole.trim_start().len());
        let unquoted = bare
            .strip_prefix('"')
            .and_then(|rest| rest.strip_suffix('"'))
            .map_or(bare, str::trim);
        Self {
            span: start..start + bare.len(),
            text: unquoted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each field of each line as it stands in the text, with line and column.
    fn fields(text: &str) -> Vec<(usize, usize, String)> {
        let source = SourceText::new(text, "t.csv").unwrap();
        let mut lines = Lines::of(&source);
        let mut found = Vec::new();
        while let Some(line) = lines.next_line().unwrap() {
            for field in line.fields {
                let (at_line, at_column) = source.line_and_column(field.span.start);
                found.push((at_line, at_column, source.text()[field.span].to_owned()));
            }
        }
        found
    }

    #[test]
    fn every_field_is_where_it_stands_whatever_ends_the_lines() {
        let expected = [
            (1, 1, "a"),
            (1, 3, "\"b\""),
            (3, 2, "é1"),
            (3, 6, "22"),
            (6, 1, ""),
            (6, 3, "4"),
        ];
        let expected = expected.map(|(line, column, text)| (line, column, text.to_owned()));
        for end in ["\n", "\r\n", "\r"] {
            let text = "a,\"b\"\n\n é1 ,22\n\n  \n, 4\n\n".replace('\n', end);
            assert_eq!(fields(&text), expected, "{text:?}");
            assert_eq!(fields(&format!("\u{feff}{text}")), expected, "{text:?}");
        }
    }

    #[test]
    fn a_quotation_mark_that_never_closes_swallows_no_lines() {
        let found = fields("\"a,b\n1,2\n");
        let texts: Vec<&str> = found.iter().map(|(_, _, text)| &text[..]).collect();
        assert_eq!(texts, ["\"a", "b", "1", "2"]);
    }
}

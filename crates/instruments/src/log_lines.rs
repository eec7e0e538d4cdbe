//! Lines of the text of a log, split into fields with their places.

use core::ops::Range;

use gyrocal_record::{Error, SourceText};

use crate::cell::{Cell, Fault};
use crate::file_format::{Decimal, Delimiter, FileFormat};

/// A line.
#[derive(Debug)]
pub(crate) struct LogLine<'a> {
    /// Place in the text, without surrounding white space.
    pub(crate) span: Range<usize>,
    /// Fields of the line: place and text without quotation marks.
    pub(crate) fields: Vec<(Range<usize>, &'a str)>,
}

impl<'a> LogLine<'a> {
    /// Some of its fields, by their indices.
    pub(crate) fn cells(&self, indices: &[usize]) -> Vec<Cell<'a>> {
        let texts = indices.iter().map(|index| self.fields[*index].1);
        texts.map(Cell::Text).collect()
    }

    /// Whether its last field is empty, as that behind a separator at the end of a line.
    pub(crate) fn ends_empty(&self) -> bool {
        self.fields.last().is_some_and(|(_, text)| text.is_empty())
    }

    /// Whether its first field is a word, or stars.
    pub(crate) fn begins_with_word(&self) -> bool {
        let first = self.fields.first().map_or("", |(_, text)| text);
        first.starts_with(|sign: char| sign.is_alphabetic() || sign == '*')
            && first.parse::<f64>().is_err()
    }

    /// Whether it begins with a word and has no number.
    pub(crate) fn is_of_words(&self, decimal: Decimal) -> bool {
        let mut texts = self.fields.iter().map(|(_, text)| text);
        self.begins_with_word() && texts.all(|text| decimal.number(text).is_none())
    }

    /// The error of one of these cells.
    pub(crate) fn error(&self, source: &SourceText, indices: &[usize], fault: Fault) -> Error {
        let (span, text) = &self.fields[indices[fault.column]];
        let found = match text.is_empty() {
            true => "an empty field".to_owned(),
            false => format!("`{text}`"),
        };
        source.error(
            fault.kind,
            span.clone(),
            found,
            fault.expected,
            fault.advice,
        )
    }
}

/// Lines with content, after those that the format skips.
pub(crate) fn log_lines<'a, 'f>(
    source: &'a SourceText,
    format: &'f FileFormat,
) -> impl Iterator<Item = LogLine<'a>> + use<'a, 'f> {
    let text = source.text();
    let mut at = 0;
    let lines = text.split_inclusive(['\n', '\r']).map(move |line| {
        let start = at;
        at += line.len();
        (start, line)
    });
    // A carriage return before a line feed ends no line of its own.
    let ends_line = |line: &str| !line.ends_with('\r');
    let mut skipped = 0;
    lines
        .filter(move |(start, line)| {
            let is_end = ends_line(line) || !text[start + line.len()..].starts_with('\n');
            let skip = skipped < format.skip_lines;
            skipped += usize::from(skip && is_end);
            !skip
        })
        .filter(|(_, line)| !line.trim().is_empty())
        .filter(|(_, line)| {
            let comment = format.comment.as_deref().unwrap_or("");
            comment.is_empty() || !line.trim_start().starts_with(comment)
        })
        .map(|(start, line)| {
            // An empty field at the end of a line is one.
            let is_blank = |sign: char| {
                sign.is_whitespace() && (sign != '\t' || format.delimiter != Delimiter::Tab)
            };
            let from = start + line.len() - line.trim_start_matches(is_blank).len();
            let bare = line.trim_matches(is_blank);
            LogLine {
                span: from..from + bare.len(),
                fields: fields(bare, from, format.delimiter),
            }
        })
}

fn fields(line: &str, start: usize, delimiter: Delimiter) -> Vec<(Range<usize>, &str)> {
    let place = |piece: &str| {
        let offset = piece.as_ptr() as usize - line.as_ptr() as usize;
        let from = start + offset + (piece.len() - piece.trim_start().len());
        from..from + piece.trim().len()
    };
    let one = |piece| (place(piece), unquoted(piece));
    match delimiter {
        Delimiter::Comma => pieces(line, ',').map(one).collect(),
        Delimiter::Semicolon => pieces(line, ';').map(one).collect(),
        Delimiter::Tab => pieces(line, '\t').map(one).collect(),
        Delimiter::Bar => pieces(line, '|').map(one).collect(),
        Delimiter::Space => line.split_whitespace().map(one).collect(),
    }
}

/// Pieces between delimiters that stand outside of quotation marks. A mark that never closes holds
/// nothing together.
fn pieces(line: &str, delimiter: char) -> impl Iterator<Item = &str> {
    let are_paired = line.matches('"').count().is_multiple_of(2);
    let mut within = false;
    line.split(move |sign: char| {
        within ^= are_paired && sign == '"';
        sign == delimiter && !within
    })
}

fn unquoted(piece: &str) -> &str {
    let bare = piece.trim();
    bare.strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .map_or(bare, str::trim)
}

//! The text of an input file, and the way from a byte offset to line and column.

use std::io::Read;
use std::ops::Range;
use std::path::Path;

use crate::content::{decoded, open_text};
use crate::error::{Error, InputError, InputErrorKind, unreadable};
use crate::excerpt::Excerpt;
use crate::printable::bounded;

/// The text of an input file with the name that errors give it.
#[derive(Debug, Clone)]
pub struct SourceText {
    name: String,
    text: String,
    /// Lines of the file before the text.
    lines_before: usize,
}

impl SourceText {
    /// Reads a file as UTF-8 text, or as UTF-16 if a byte-order mark says so; gzip and Zstandard are decompressed.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`] if the operating system refuses, [`Error::Input`] if the file has
    /// no content or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::read_as(path, None)
    }

    /// Reads a file as text of an encoding, by its label in the Encoding Standard; without one as [`Self::read`].
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn read_as(path: &Path, encoding: Option<&str>) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        open_text(path, encoding)?
            .read_to_end(&mut bytes)
            .map_err(unreadable(path))?;
        Self::from_utf8(bytes, &path.display().to_string())
    }

    /// Takes a block of whole lines out of a file, which has `lines_before` lines in front of it.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is not UTF-8.
    pub fn of_block(bytes: Vec<u8>, name: &str, lines_before: usize) -> Result<Self, Error> {
        let text = String::from_utf8(bytes)
            .map_err(|error| not_utf8(error.as_bytes(), name, lines_before))?;
        Ok(Self {
            name: name.to_owned(),
            text: text.trim_start_matches('\u{feff}').to_owned(),
            lines_before,
        })
    }

    /// Takes the content of a file as UTF-8 text, or as UTF-16 if a byte-order mark says so.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if there is no content or if it is not UTF-8.
    pub fn from_bytes(bytes: Vec<u8>, name: &str) -> Result<Self, Error> {
        let mut text = Vec::with_capacity(bytes.len());
        // Reading from memory does not fail; what follows tells an empty text.
        let _ = decoded(&bytes[..], None).read_to_end(&mut text);
        Self::from_utf8(text, name)
    }

    fn from_utf8(bytes: Vec<u8>, name: &str) -> Result<Self, Error> {
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => return Err(not_utf8(error.as_bytes(), name, 0)),
        };
        Self::new(&text, name)
    }

    /// Takes a text, without the byte-order mark that some editors put first.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if there is nothing but white space.
    pub fn new(text: &str, name: &str) -> Result<Self, Error> {
        let text = text.trim_start_matches('\u{feff}');
        let source = Self {
            name: name.to_owned(),
            text: text.to_owned(),
            lines_before: 0,
        };
        if text.trim().is_empty() {
            return Err(source.error(
                InputErrorKind::Empty,
                0..0,
                "an empty file",
                "some content",
                "check that the program that wrote it had finished",
            ));
        }
        Ok(source)
    }

    /// The name alone, of what has no text.
    pub(crate) fn of_memory(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            text: String::new(),
            lines_before: 0,
        }
    }

    /// The name of the file as it was given.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Line and column in characters of a byte offset, both from 1.
    #[must_use]
    pub fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let before = self.text.get(..offset).unwrap_or(&self.text);
        // A carriage return ends a line too unless a line feed follows.
        let ends = before.match_indices(['\n', '\r']);
        let ends = ends.filter(|(at, end)| *end == "\n" || !self.text[at + 1..].starts_with('\n'));
        let (mut line, mut line_start) = (self.lines_before + 1, 0);
        for (at, _) in ends {
            (line, line_start) = (line + 1, at + 1);
        }
        let column = before.get(line_start..).unwrap_or("").chars().count() + 1;
        (line, column)
    }

    /// Whether the text ends within a line: at most blanks follow the place, and no end of a line.
    #[must_use]
    pub fn ends_within_line(&self, place: &Range<usize>) -> bool {
        let rest = self.text.get(place.end..).unwrap_or("\n");
        !rest.contains(['\n', '\r']) && rest.trim().is_empty()
    }

    /// An error at a byte range of this text.
    #[must_use]
    pub fn error(
        &self,
        kind: InputErrorKind,
        span: Range<usize>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Error {
        let (line, column) = self.line_and_column(span.start);
        Error::Input(Box::new(InputError {
            kind,
            line,
            column,
            found: bounded(found.into()),
            expected: bounded(expected.into()),
            advice: bounded(advice.into()),
            excerpt: Excerpt::new(&self.name, &self.text, span, (line, column)),
        }))
    }
}

/// Quotes a piece of a file for an error message, cut if it is long.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST_CHARS: usize = 60;
    // Enough of it to see that there is more.
    let mut one_line = String::new();
    for word in text.split_whitespace() {
        let space = if one_line.is_empty() { "" } else { " " };
        one_line.push_str(space);
        one_line.extend(word.chars().take(LONGEST_CHARS + 1));
        if one_line.len() > 4 * LONGEST_CHARS {
            break;
        }
    }
    if one_line.chars().count() > LONGEST_CHARS {
        let head: String = one_line.chars().take(LONGEST_CHARS).collect();
        format!("`{head}…`")
    } else if one_line.is_empty() {
        "nothing".to_owned()
    } else {
        format!("`{one_line}`")
    }
}

/// The bytes before the first wrong one are valid, so offsets into the lossy text are right.
fn not_utf8(bytes: &[u8], name: &str, lines_before: usize) -> Error {
    let offset = match std::str::from_utf8(bytes) {
        Ok(text) => text.len(),
        Err(error) => error.valid_up_to(),
    };
    let found = bytes
        .get(offset)
        .map_or_else(|| "the end".to_owned(), |byte| format!("byte 0x{byte:02X}"));
    let source = SourceText {
        name: name.to_owned(),
        text: String::from_utf8_lossy(bytes).into_owned(),
        lines_before,
    };
    source.error(
        InputErrorKind::NotUtf8,
        offset..offset,
        found,
        "UTF-8 text",
        "save the file as UTF-8, or give `encoding` in `[file]` of a map of its columns (`--columns MAP.toml`), as \
         `encoding = \"latin1\"` or `\"utf-16le\"`; spreadsheets and binary files are not read, but for MATLAB, Parquet \
         and MCAP",
    )
}

//! The piece of a file that an error shows: three lines at most, each cut to a window around the
//! place of the error, whatever the size of the file.

use std::ops::Range;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// Longest line that is shown whole, in characters.
const WHOLE_CHARS: usize = 120;

/// Characters of a longer line that are shown.
const WINDOW_CHARS: usize = 90;

/// Sign of what is cut off.
const CUT: char = '…';

/// The lines around a place.
#[derive(Debug, Clone)]
pub(crate) struct Excerpt {
    name: String,
    text: String,
    /// Place of the error in `text`.
    span: Range<usize>,
    /// Number of the first line of `text`, from 0.
    first_line: usize,
    /// Column of the place in its file, from 0.
    column: usize,
}

impl Excerpt {
    /// The lines around a range of bytes of a text, which begins on a line and in a column, both
    /// counted from 1.
    pub(crate) fn new(name: &str, text: &str, span: Range<usize>, at: (usize, usize)) -> Self {
        let (line, column) = (at.0 - 1, at.1 - 1);
        let start = span.start.min(text.len());
        let here = line_around(text, start);
        // Where the window begins, in characters.
        let from = column.saturating_sub(WINDOW_CHARS / 2);
        let mut shown = String::new();
        let mut first_line = line;
        if let Some(end) = end_of_line_before(text, here.start) {
            first_line -= 1;
            shown.push_str(&window(&text[line_around(text, end)], from).0);
            shown.push('\n');
        }
        let (cut, cut_at) = window(&text[here.clone()], from);
        let offset = shown.len();
        let within = |byte: usize| {
            let byte = byte.clamp(here.start, here.end) - here.start;
            // A sign of the cut stands before what is shown.
            let shown = byte.saturating_sub(cut_at);
            let sign = if cut_at > 0 { CUT.len_utf8() } else { 0 };
            offset + (shown + sign).min(cut.len())
        };
        let place = within(start)..within(span.end.max(start));
        shown.push_str(&cut);
        if let Some(next) = start_of_line_after(text, here.end) {
            shown.push('\n');
            shown.push_str(&window(&text[line_around(text, next)], from).0);
        }
        Self {
            name: name.to_owned(),
            text: shown,
            span: place,
            first_line,
            column,
        }
    }

    /// The name of the file as it was given.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The place of the error in the excerpt.
    pub(crate) fn span(&self) -> SourceSpan {
        self.span.clone().into()
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let contents = self.text.read_span(span, lines_before, lines_after)?;
        // The column of the place is that in its file, where the line may begin before the window.
        let column = match lines_before {
            0 => self.column,
            _ => contents.column(),
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            contents.data(),
            *contents.span(),
            contents.line() + self.first_line,
            column,
            contents.line_count(),
        )))
    }
}

const ENDS: [char; 2] = ['\n', '\r'];

/// The line that a byte lies on, without its end.
fn line_around(text: &str, byte: usize) -> Range<usize> {
    let start = text[..byte].rfind(ENDS).map_or(0, |end| end + 1);
    let end = text[byte..].find(ENDS).map_or(text.len(), |end| byte + end);
    start..end
}

/// Where the text of the line before ends.
fn end_of_line_before(text: &str, start: usize) -> Option<usize> {
    let before = &text[..start];
    let bare = before
        .strip_suffix("\r\n")
        .or_else(|| before.strip_suffix(ENDS))?;
    Some(bare.len())
}

/// Where the next line begins; `None` after the last.
fn start_of_line_after(text: &str, end: usize) -> Option<usize> {
    let after = &text[end..];
    let rest = after
        .strip_prefix("\r\n")
        .or_else(|| after.strip_prefix(ENDS))?;
    (!rest.is_empty()).then(|| text.len() - rest.len())
}

/// A line from a character on, cut if it is long, and the number of bytes cut off in front.
fn window(line: &str, from: usize) -> (String, usize) {
    let longer = line.char_indices().nth(WHOLE_CHARS).is_some();
    if !longer {
        return (line.to_owned(), 0);
    }
    let byte = |chars: usize| line.char_indices().nth(chars).map(|(byte, _)| byte);
    let start = byte(from).unwrap_or(line.len());
    let end = byte(from + WINDOW_CHARS);
    let mut cut = String::new();
    if start > 0 {
        cut.push(CUT);
    }
    cut.push_str(&line[start..end.unwrap_or(line.len())]);
    if end.is_some() {
        cut.push(CUT);
    }
    (cut, start)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(excerpt: &Excerpt, context: usize) -> (String, usize, usize) {
        let contents = excerpt
            .read_span(&excerpt.span(), context, context)
            .unwrap();
        let text = String::from_utf8(contents.data().to_vec()).unwrap();
        (text, contents.line(), contents.column())
    }

    #[test]
    fn short_lines_are_shown_whole_with_their_neighbours() {
        for end in ["\n", "\r\n", "\r"] {
            let text = "one\ntwo\nthree\nfour\n".replace('\n', end);
            let start = text.find("hree").unwrap();
            let excerpt = Excerpt::new("f", &text, start..start + 2, (3, 2));
            assert_eq!(shown(&excerpt, 0), ("hr".to_owned(), 2, 1));
            assert_eq!(
                shown(&excerpt, 1).0.trim_end(),
                "two\nthree\nfour",
                "{end:?}"
            );
            assert_eq!(shown(&excerpt, 1).1, 1);
        }
    }

    #[test]
    fn a_long_line_is_a_window_around_the_place() {
        let text = format!("{}here{}\nnext", "é".repeat(1_000), "z".repeat(1_000));
        let excerpt = Excerpt::new("f", &text, 2_000..2_004, (1, 1_001));
        assert_eq!(shown(&excerpt, 0), ("here".to_owned(), 0, 1_000));
        assert!(excerpt.text.chars().count() < 100, "{}", excerpt.text);
        let whole = Excerpt::new("f", &text, 0..text.len(), (1, 1));
        assert!(whole.span.end <= whole.text.len() && whole.text.ends_with("\nnext"));
        let last = Excerpt::new("f", &text, text.len()..text.len(), (2, 5));
        assert_eq!(shown(&last, 0).2, 4);
    }

    #[test]
    fn an_empty_text_has_an_excerpt() {
        let excerpt = Excerpt::new("f", "", 0..0, (1, 1));
        assert_eq!((excerpt.text.as_str(), excerpt.span.clone()), ("", 0..0));
    }
}

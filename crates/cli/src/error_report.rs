//! The form in which errors are printed: code, message, causes, the marked line of the input,
//! advice.
//!
//! The form is that of miette's graphical handler, which is not used: it wraps lines by the
//! Unicode tables of ICU, and they would take a twelfth of the time of a clean build.

use std::fmt::{self, Write as _};
use std::io::IsTerminal as _;

use anstyle::{AnsiColor, Style};
use gyrocal_record::{printable, printable_line};
use miette::{Diagnostic, LabeledSpan, ReportHandler, SourceCode, SpanContents};
use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};

use crate::text;

const RED: Style = AnsiColor::Red.on_default();
const CYAN: Style = AnsiColor::Cyan.on_default();
const PLACE: Style = AnsiColor::Cyan.on_default().underline().bold();
const MARK: Style = AnsiColor::Magenta.on_default().bold();
const DIM: Style = Style::new().dimmed();

/// Columns between tabulator stops.
const TAB: usize = 4;

/// Lines shown before and after the marked one.
const CONTEXT: usize = 1;

/// The signs of drawings, each with the letter that stands for it where a stream shows ASCII only.
const SIGNS: [(char, char); 10] = [
    ('×', 'x'),
    ('│', '|'),
    ('─', '-'),
    ('┬', '|'),
    ('╰', '`'),
    ('├', '|'),
    ('╭', ','),
    ('▶', '>'),
    ('▲', '^'),
    ('·', ':'),
];

/// Prints errors with styles, which the stream removes where they cannot be shown.
#[derive(Debug)]
pub(crate) struct ErrorReport {
    /// Whether signs are drawn as letters of ASCII.
    ascii: bool,
    /// Columns of a line, if lines are wrapped.
    width: Option<usize>,
}

impl ErrorReport {
    /// The form that suits standard error.
    ///
    /// Lines are wrapped on a terminal only: scripts search for an unbroken `file:line:column`.
    pub(crate) fn of_stderr() -> Self {
        let terminal = std::io::stderr().is_terminal();
        let columns = || terminal_size::terminal_size().map_or(80, |(width, _)| width.0.into());
        Self {
            ascii: !supports_unicode::on(supports_unicode::Stream::Stderr),
            width: terminal.then(columns),
        }
    }

    /// A drawing of signs, as the stream can show it.
    fn drawn(&self, signs: &str) -> String {
        let shown = |sign: char| {
            let known = SIGNS.iter().find(|(own, _)| self.ascii && *own == sign);
            known.map_or(sign, |(_, letter)| *letter)
        };
        signs.chars().map(shown).collect()
    }

    /// A text behind an indent that is styled: one for its first line and one for the others.
    fn paragraph(
        &self,
        out: &mut dyn fmt::Write,
        style: Style,
        indents: [&str; 2],
        words: &str,
    ) -> fmt::Result {
        let [first, next] = indents.map(|indent| self.drawn(indent));
        let room = |width: usize| width.saturating_sub(2 + first.width()).max(1);
        let words = printable(words);
        let wrapped = match self.width.map(room) {
            Some(width) => text::wrapped(width, &words),
            None => words.into_owned(),
        };
        for (index, line) in wrapped.trim_end_matches('\n').split('\n').enumerate() {
            let indent = if index == 0 { &first } else { &next };
            let indent = if line.trim().is_empty() {
                indent.trim_end()
            } else {
                indent
            };
            writeln!(out, "{style}{indent}{style:#}{line}")?;
        }
        Ok(())
    }

    fn causes(&self, out: &mut dyn fmt::Write, error: &dyn Diagnostic) -> fmt::Result {
        let mut cause = error.source();
        while let Some(this) = cause {
            cause = this.source();
            let indents = match cause {
                Some(_) => ["  ├─▶ ", "  │   "],
                None => ["  ╰─▶ ", "      "],
            };
            self.paragraph(out, RED, indents, &this.to_string())?;
        }
        Ok(())
    }

    /// The line that a label marks, between its neighbours.
    fn snippet(
        &self,
        out: &mut dyn fmt::Write,
        source: &dyn SourceCode,
        label: &LabeledSpan,
    ) -> fmt::Result {
        let [bar, gap, top, hook, end] =
            ["│", "·", "╭─", "╰──", "╰────"].map(|one| self.drawn(one));
        let span = label.inner();
        let (Ok(place), Ok(context)) = (
            source.read_span(span, 0, 0),
            source.read_span(span, CONTEXT, CONTEXT),
        ) else {
            return Ok(());
        };
        let lines = lines(context.as_ref());
        let digits = lines.last().map_or(1, |line| line.number.to_string().len());
        let margin = " ".repeat(digits + 2);
        let name = printable_line(place.name().unwrap_or_default());
        let (line, column) = (place.line() + 1, place.column() + 1);
        writeln!(out, "{margin}{top}[{PLACE}{name}:{line}:{column}{PLACE:#}]")?;
        for line in &lines {
            let number = line.number;
            let text = untabbed(&line.text);
            writeln!(out, " {DIM}{number:digits$}{DIM:#} {bar} {text}")?;
            if !line.holds(span.offset()) {
                continue;
            }
            let from = line.column(span.offset());
            let to = line.column(span.offset() + span.len()).max(from + 1);
            let (marks, middle) = self.marks(span.is_empty(), from, to);
            writeln!(
                out,
                "{margin}{gap} {}{MARK}{marks}{MARK:#}",
                " ".repeat(from)
            )?;
            if let Some(label) = label.label() {
                let before = " ".repeat(middle);
                writeln!(
                    out,
                    "{margin}{gap} {before}{MARK}{hook} {}{MARK:#}",
                    printable_line(label)
                )?;
            }
        }
        writeln!(out, "{margin}{end}")
    }

    /// The line below columns `from` to `to`, and the column where its label hangs.
    fn marks(&self, empty: bool, from: usize, to: usize) -> (String, usize) {
        let middle = usize::midpoint(from, to);
        let left = "─".repeat(middle - from);
        let right = "─".repeat(to - middle - 1);
        let hanger = if empty { "▲" } else { "┬" };
        (self.drawn(&(left + hanger + &right)), middle)
    }
}

impl ReportHandler for ErrorReport {
    fn debug(&self, error: &dyn Diagnostic, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if formatter.alternate() {
            return fmt::Debug::fmt(error, formatter);
        }
        let mut out = String::new();
        if let Some(code) = error.code() {
            writeln!(out, "{RED}{code}{RED:#}\n")?;
        }
        self.paragraph(&mut out, RED, ["  × ", "  │ "], &error.to_string())?;
        self.causes(&mut out, error)?;
        if let (Some(source), Some(labels)) = (error.source_code(), error.labels()) {
            for label in labels {
                self.snippet(&mut out, source, &label)?;
            }
        }
        if let Some(help) = error.help() {
            let indents = ["  help: ", "        "];
            self.paragraph(&mut out, CYAN, indents, &help.to_string())?;
        }
        formatter.write_str(&out)
    }
}

/// A line of a file.
struct Line {
    /// From 1.
    number: usize,
    /// Offset of its first byte, and of the first one after its end.
    offset: usize,
    end: usize,
    /// Its text without its end.
    text: String,
}

impl Line {
    fn holds(&self, offset: usize) -> bool {
        (self.offset..self.end).contains(&offset)
    }

    /// The column on a terminal, from 0, of a byte; one past the text for all that comes after.
    fn column(&self, offset: usize) -> usize {
        let within = offset.saturating_sub(self.offset);
        let end = self.text.ceil_char_boundary(within.min(self.text.len()));
        let beyond = usize::from(within > self.text.len());
        untabbed(&self.text[..end]).width() + beyond
    }
}

fn lines(context: &dyn SpanContents<'_>) -> Vec<Line> {
    let text = String::from_utf8_lossy(context.data());
    let mut offset = context.span().offset();
    let numbered = text.split_inclusive('\n').zip(context.line() + 1..);
    numbered
        .map(|(line, number)| {
            let from = offset;
            offset += line.len();
            let text = line.strip_suffix('\n').unwrap_or(line);
            let text = text.strip_suffix('\r').unwrap_or(text).to_owned();
            Line {
                number,
                offset: from,
                end: offset,
                text,
            }
        })
        .collect()
}

/// A line with spaces for its tabulators, and what would steer a terminal escaped.
fn untabbed(line: &str) -> String {
    let line = &printable(line);
    let mut text = String::with_capacity(line.len());
    let mut column = 0;
    for letter in line.chars() {
        let width = match letter {
            '\t' => TAB - column % TAB,
            other => other.width().unwrap_or(0),
        };
        if letter == '\t' {
            text.push_str(&" ".repeat(width));
        } else {
            text.push(letter);
        }
        column += width;
    }
    text
}

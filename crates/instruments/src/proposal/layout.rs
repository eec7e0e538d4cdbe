//! Separator, decimal mark, header and rows of a text, found from its fields.

use gyrocal_record::SourceText;

use crate::file_format::{Decimal, Delimiter, FileFormat};
use crate::log_lines::{LogLine, log_lines};
use crate::remedy::COMMENTS;

/// Lines from which separator and decimal mark are found.
const FIRST_LINES: usize = 600;

/// Rows that are looked at, spread over the file.
const ROWS: usize = 4000;

/// Fewest numbers of a row.
const NUMBERS: usize = 3;

/// A text in columns.
pub(super) struct Table<'a> {
    pub(super) format: FileFormat,
    /// Columns by their names in a map.
    pub(super) names: Vec<String>,
    /// What a header says of each column, its unit included; empty without a header.
    pub(super) titles: Vec<String>,
    /// Rows, spread over the file.
    pub(super) rows: Vec<Vec<&'a str>>,
}

impl<'a> Table<'a> {
    /// The table of a text, which is in the encoding of `format`; `None` if no lines have three numbers.
    pub(super) fn of(source: &'a SourceText, format: &FileFormat) -> Option<Self> {
        let mut format = FileFormat {
            comment: comment(source),
            ..format.clone()
        };
        let rows = RowForm::best(source, &mut format)?;
        let lines: Vec<LogLine<'a>> = log_lines(source, &format).collect();
        let first = lines.iter().position(|line| rows.holds(line, &format))?;
        let (header, units) = rows.header(&lines[..first], format.decimal);
        let first_line = source.line_and_column(lines[first].span.start).0;
        let texts = |line: &LogLine<'a>| -> Vec<&'a str> {
            line.fields.iter().map(|(_, text)| *text).collect()
        };
        let mut names: Vec<String> = (1..=rows.fields).map(|number| number.to_string()).collect();
        let mut titles = vec![String::new(); rows.fields];
        match header.map(texts) {
            Some(header) => {
                format.skip_rows = usize::from(units.is_some());
                for (title, name) in titles.iter_mut().zip(&header) {
                    *title = (*name).to_owned();
                }
                names = header.into_iter().map(str::to_owned).collect();
            }
            None => {
                format.header = false;
                format.skip_lines = first_line - 1;
                titles = commented(source, &lines[first], &format, rows.fields).unwrap_or(titles);
            }
        }
        names.resize(rows.fields, String::new());
        for (title, unit) in titles.iter_mut().zip(units.map(texts).unwrap_or_default()) {
            title.push_str(&format!(" [{unit}]"));
        }
        let has_header = format.header;
        let is_title = |line: &&LogLine<'_>| {
            line.fields
                .iter()
                .map(|(_, text)| *text)
                .eq(names.iter().map(String::as_str))
        };
        let rest = lines[first..]
            .iter()
            .filter(|line| rows.fits(line) && !(has_header && is_title(line)));
        let stride = rest.clone().count().div_ceil(ROWS).max(1);
        let rows: Vec<Vec<&str>> = rest.step_by(stride).map(texts).collect();
        (!rows.is_empty()).then_some(Self {
            format,
            names,
            titles,
            rows,
        })
    }

    /// Whether a map can call a column by its name.
    pub(super) fn has_name(&self, column: usize) -> bool {
        let name = &self.names[column];
        !name.is_empty() && self.names.iter().filter(|other| *other == name).count() == 1
    }

    /// The number of a field; not a number where it is none.
    pub(super) fn number(&self, row: usize, column: usize) -> f64 {
        let text = self.rows[row].get(column).copied().unwrap_or_default();
        self.format.decimal.number(text).unwrap_or(f64::NAN)
    }

    /// The numbers of a column.
    pub(super) fn numbers(&self, column: usize) -> Vec<f64> {
        (0..self.rows.len())
            .map(|row| self.number(row, column))
            .collect()
    }

    /// Share of the fields of a column that are finite numbers.
    pub(super) fn share_of_numbers(&self, column: usize) -> f64 {
        let finite = self
            .numbers(column)
            .into_iter()
            .filter(|value| value.is_finite());
        finite.count() as f64 / self.rows.len().max(1) as f64
    }
}

/// Form of the rows.
struct RowForm {
    /// Number of fields, an empty last one included.
    fields: usize,
    /// Which of them are numbers.
    numbers: Vec<bool>,
}

impl RowForm {
    /// The form with the most numbers, whose separator and decimal mark go to the format.
    fn best(source: &SourceText, format: &mut FileFormat) -> Option<Self> {
        // Blanks stand within names and dates, and decimal commas within fields.
        let delimiters = [
            Delimiter::Semicolon,
            Delimiter::Tab,
            Delimiter::Bar,
            Delimiter::Comma,
            Delimiter::Space,
        ];
        let mut best: Option<(usize, Self, FileFormat)> = None;
        for delimiter in delimiters {
            if delimiter == Delimiter::Space && best.is_some() {
                continue;
            }
            for decimal in [Decimal::Point, Decimal::Comma] {
                let format = FileFormat {
                    delimiter,
                    decimal,
                    ..format.clone()
                };
                let Some((score, form)) = Self::of(source, &format) else {
                    continue;
                };
                if best.as_ref().is_none_or(|(most, ..)| score > *most) {
                    best = Some((score, form, format));
                }
            }
        }
        let (_, form, found) = best?;
        *format = found;
        Some(form)
    }

    /// The usual form of the lines by a format, with the count of its numbers.
    fn of(source: &SourceText, format: &FileFormat) -> Option<(usize, Self)> {
        let mut forms: Vec<(usize, Vec<bool>)> = Vec::new();
        for line in log_lines(source, format).take(FIRST_LINES) {
            let form = numbers(&line, format.decimal);
            match forms.iter_mut().find(|(_, known)| *known == form) {
                Some((count, _)) => *count += 1,
                None => forms.push((1, form)),
            }
        }
        let of_form = |(count, form): (usize, Vec<bool>)| {
            let numbers = form.iter().filter(|number| **number).count();
            (numbers >= NUMBERS).then_some((count * numbers, form))
        };
        let scored = forms.into_iter().filter_map(of_form);
        let (score, numbers) = scored.max_by_key(|(score, _)| *score)?;
        let fields = numbers.len();
        Some((score, Self { fields, numbers }))
    }

    /// Whether a line has numbers wherever the usual row has.
    fn holds(&self, line: &LogLine<'_>, format: &FileFormat) -> bool {
        let own = numbers(line, format.decimal);
        own.len() == self.fields
            && self
                .numbers
                .iter()
                .zip(own)
                .all(|(usual, own)| own || !usual)
    }

    /// Whether a line has as many fields.
    fn fits(&self, line: &LogLine<'_>) -> bool {
        line.fields.len() == self.fields && !(line.begins_with_word() && self.numbers[0])
    }

    /// The header among the lines before the first row, and a line of units below it.
    fn header<'l, 'a>(
        &self,
        before: &'l [LogLine<'a>],
        decimal: Decimal,
    ) -> (Option<&'l LogLine<'a>>, Option<&'l LogLine<'a>>) {
        let is_one = |line: &&LogLine<'_>| {
            let fields = line.fields.len();
            let named = line.fields.iter().filter(|(_, text)| !text.is_empty());
            // The empty field behind the last separator of each row may have no name.
            (fields == self.fields || fields + 1 == self.fields)
                && named.clone().count() + 1 >= self.fields
                && named
                    .clone()
                    .all(|(_, text)| decimal.number(text).is_none())
        };
        let Some(last) = before.last().filter(is_one) else {
            // Blank units leave few words.
            let units = before.last().filter(|line| is_of_units(line));
            let above = before
                .len()
                .checked_sub(2)
                .map(|at| &before[at])
                .filter(is_one);
            return (above.filter(|_| units.is_some()), units);
        };
        let above = before
            .len()
            .checked_sub(2)
            .map(|at| &before[at])
            .filter(is_one);
        match above {
            Some(above) if is_of_units(last) => (Some(above), Some(last)),
            _ => (Some(last), None),
        }
    }
}

fn numbers(line: &LogLine<'_>, decimal: Decimal) -> Vec<bool> {
    let finite = |text: &str| decimal.number(text).is_some_and(f64::is_finite);
    line.fields.iter().map(|(_, text)| finite(text)).collect()
}

/// Whether a line has units and nothing else.
fn is_of_units(line: &LogLine<'_>) -> bool {
    const UNITS: [&str; 40] = [
        "", "-", "s", "ms", "us", "µs", "ns", "min", "h", "d", "sec", "seconds", "hh:mm:ss", "utc",
        "date", "time", "g", "mg", "ug", "µg", "m/s2", "m/s^2", "m/s²", "m/s/s", "ft/s2", "ft/s^2",
        "gal", "v", "mv", "counts", "lsb", "hz", "c", "degc", "°c", "k", "f", "degf", "°f", "deg",
    ];
    let bare = |text: &str| text.trim_matches(['[', ']', '(', ')']).to_lowercase();
    line.fields
        .iter()
        .all(|(_, text)| UNITS.contains(&bare(text).as_str()))
}

/// Beginning of the lines that are comments.
fn comment(source: &SourceText) -> Option<String> {
    let plain = FileFormat {
        delimiter: Delimiter::Bar,
        ..FileFormat::default()
    };
    // Stars stand within files of LabVIEW.
    let signs = COMMENTS.into_iter().filter(|sign| *sign != "*");
    let begins = |sign: &&str| {
        log_lines(source, &plain).any(|line| source.text()[line.span].starts_with(sign))
    };
    signs.into_iter().find(begins).map(str::to_owned)
}

/// Titles in the comment in front of the first row.
fn commented(
    source: &SourceText,
    first: &LogLine<'_>,
    format: &FileFormat,
    fields: usize,
) -> Option<Vec<String>> {
    let sign = format.comment.as_deref()?;
    let before = source.text()[..first.span.start].trim_end();
    let line = before.rsplit(['\n', '\r']).next()?.trim_start();
    let text = line.strip_prefix(sign)?.trim();
    let header = SourceText::new(text, source.name()).ok()?;
    let plain = FileFormat {
        comment: None,
        skip_lines: 0,
        ..format.clone()
    };
    let line = log_lines(&header, &plain).next()?;
    let mut titles: Vec<String> = line
        .fields
        .iter()
        .map(|(_, text)| (*text).to_owned())
        .collect();
    // A separator may end each row.
    titles.resize(
        titles.len() + usize::from(titles.len() + 1 == fields),
        String::new(),
    );
    (titles.len() == fields).then_some(titles)
}

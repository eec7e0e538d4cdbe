//! Columns of time, and the format of dates, by names and values.

use super::layout::Table;
use super::numbers::{gps, numbers};
use crate::date_time::DateTimes;

/// Dates and times of day by `strftime`, and what stands between and behind them; the likelier first.
const DATES: [&str; 23] = [
    "%Y-%m-%d",
    "%d.%m.%Y",
    "%m/%d/%Y",
    "%d/%m/%Y",
    "%Y/%m/%d",
    "%Y.%m.%d",
    "%d-%m-%Y",
    "%m-%d-%Y",
    "%d.%m.%y",
    "%m/%d/%y",
    "%d/%m/%y",
    "%d-%b-%Y",
    "%d-%b-%y",
    "%d %b %Y",
    "%b %d %Y",
    "%b %d, %Y",
    "%d %B %Y",
    "%a %b %d %Y",
    "%Y%m%d",
    "%Y %j",
    "%Y-%j",
    "%Y/%j",
    "%Y:%j",
];
const TIMES: [&str; 10] = [
    "%H:%M:%S",
    "%H:%M:%S%.f",
    "%I:%M:%S %p",
    "%I:%M:%S%.f %p",
    "%H:%M",
    "%I:%M %p",
    "%H.%M.%S",
    "%H-%M-%S",
    "%H%M%S",
    "%H:%M:%S:%3f",
];
const BETWEEN: [&str; 6] = [" ", "T", ", ", "_", "-", ":"];
const BEHIND: [&str; 6] = ["", "Z", " UTC", " GMT", " %z", "%z"];

/// Columns of year, month, day, hour, minute and second.
const PARTS: [[&str; 4]; 6] = [
    ["year", "yr", "yyyy", "jahr"],
    ["month", "mon", "mm", "monat"],
    ["day", "dd", "mday", "tag"],
    ["hour", "hr", "hh", "stunde"],
    ["minute", "min", "mi", "minute"],
    ["second", "sec", "ss", "sekunde"],
];

/// Words in the names of days of the year.
const DAYS_OF_YEAR: [&str; 5] = ["doy", "jday", "yday", "day", "ddd"];

/// Times of the rows.
pub(super) enum Stamps {
    /// Dates and times by a format; of RFC 3339 without one.
    Dates {
        columns: Vec<usize>,
        format: Option<String>,
    },
    /// Numbers, of this many seconds.
    Numbers { column: usize, unit_s: f64 },
    /// Seconds of the week, and weeks.
    Gps { column: usize, week: usize },
    /// None.
    Rate,
}

impl Stamps {
    /// The columns.
    pub(super) fn columns(&self) -> Vec<usize> {
        match self {
            Self::Dates { columns, .. } => columns.clone(),
            Self::Numbers { column, .. } => vec![*column],
            Self::Gps { column, week } => vec![*column, *week],
            Self::Rate => Vec::new(),
        }
    }
}

/// The times of a table.
pub(super) fn stamps(table: &Table<'_>) -> Stamps {
    dates(table)
        .or_else(|| gps(table))
        .or_else(|| numbers(table))
        .unwrap_or(Stamps::Rate)
}

/// Lower-case words of a title.
pub(super) fn words(title: &str) -> Vec<String> {
    let lower = title.to_lowercase();
    let words = lower.split(|sign: char| !(sign.is_alphanumeric() || sign == '°'));
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

pub(super) fn column_of(table: &Table<'_>, names: &[&str]) -> Option<usize> {
    let has = |title: &String| {
        words(title)
            .iter()
            .any(|word| names.contains(&word.as_str()))
    };
    table.titles.iter().position(has)
}

/// Dates and times in words, or in columns of their parts.
fn dates(table: &Table<'_>) -> Option<Stamps> {
    let is_text = |column: &usize| {
        table.share_of_numbers(*column) < 0.5 && !text(table, 0, &[*column]).is_empty()
    };
    let texts: Vec<usize> = (0..table.names.len()).filter(is_text).collect();
    for column in &texts {
        if fits(table, &[*column], None).is_some() {
            return Some(Stamps::Dates {
                columns: vec![*column],
                format: None,
            });
        }
    }
    let year = column_of(table, &PARTS[0]);
    let day = column_of(table, &DAYS_OF_YEAR);
    let compact = (0..table.names.len()).find(|column| is_compact_date(table, *column));
    let mut choices: Vec<Vec<usize>> = texts.iter().map(|column| vec![*column]).collect();
    for first in texts.iter().copied().chain(compact) {
        choices.extend(
            texts
                .iter()
                .filter(|other| **other != first)
                .map(|other| vec![first, *other]),
        );
    }
    choices.extend(
        compact
            .filter(|at| at + 1 < table.names.len())
            .map(|at| vec![at, at + 1]),
    );
    if let (Some(year), Some(day)) = (year, day) {
        choices.extend(texts.iter().map(|time| vec![year, day, *time]));
    }
    let found = choices.into_iter().find_map(|columns| {
        let format = best_format(table, &columns, true)?;
        let format = Some(format);
        Some(Stamps::Dates { columns, format })
    });
    found.or_else(|| parts(table)).or_else(|| {
        // Times of day alone.
        let format = texts
            .iter()
            .find_map(|column| Some((*column, best_format(table, &[*column], false)?)));
        format.map(|(column, format)| Stamps::Dates {
            columns: vec![column],
            format: Some(format),
        })
    })
}

/// A column of dates such as 20260328.
fn is_compact_date(table: &Table<'_>, column: usize) -> bool {
    let is_one = |row: &Vec<&str>| {
        let text = row.get(column).copied().unwrap_or_default();
        text.len() == 8
            && (text.starts_with("19") || text.starts_with("20"))
            && text.bytes().all(|b| b.is_ascii_digit())
    };
    table.rows.iter().all(is_one)
}

/// Columns of year to second.
fn parts(table: &Table<'_>) -> Option<Stamps> {
    let columns = PARTS.map(|names| column_of(table, &names));
    let columns: Vec<usize> = columns.into_iter().collect::<Option<_>>()?;
    let formats = ["%Y %m %d %H %M %S", "%Y %m %d %H %M %S%.f"];
    let format = formats
        .into_iter()
        .find(|format| fits(table, &columns, Some(format)).is_some())?;
    Some(Stamps::Dates {
        columns,
        format: Some(format.to_owned()),
    })
}

/// The format of some columns, with a date or of times of day: of those that read every row the one with the shortest
/// of longest intervals, as day and month may be either.
fn best_format(table: &Table<'_>, columns: &[usize], dated: bool) -> Option<String> {
    let mut best: Option<(f64, String)> = None;
    let mut consider = |format: String| {
        if let Some(longest_s) = fits(table, columns, Some(&format))
            && best.as_ref().is_none_or(|(least, _)| longest_s < *least)
        {
            best = Some((longest_s, format));
        }
    };
    for time in TIMES {
        for behind in BEHIND {
            if !dated {
                consider(format!("{time}{behind}"));
                continue;
            }
            for date in DATES {
                let between = if columns.len() == 1 {
                    &BETWEEN[..]
                } else {
                    &BETWEEN[..1]
                };
                for between in between {
                    consider(format!("{date}{between}{time}{behind}"));
                }
                consider(format!("{time} {date}{behind}"));
            }
        }
    }
    best.map(|(_, format)| format)
}

/// Text of some columns of a row.
fn text(table: &Table<'_>, row: usize, columns: &[usize]) -> String {
    let texts = columns
        .iter()
        .map(|column| table.rows[row].get(*column).copied().unwrap_or_default());
    texts.collect::<Vec<&str>>().join(" ")
}

/// The longest interval of rows that are all dates and times of a format, most of which rise.
fn fits(table: &Table<'_>, columns: &[usize], format: Option<&str>) -> Option<f64> {
    let mut reader = match format {
        Some(format) => DateTimes::of_format(format)?,
        None => DateTimes::rfc3339(),
    };
    let mut times = Vec::with_capacity(table.rows.len());
    for row in 0..table.rows.len() {
        times.push(reader.seconds(&text(table, row, columns))?);
    }
    let longest_s = times
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .fold(0.0, f64::max);
    rises(&times).then_some(longest_s)
}

/// Whether nearly all times rise.
pub(super) fn rises(times: &[f64]) -> bool {
    const MOST_FALLING: f64 = 0.02;
    let pairs = times.len().saturating_sub(1) as f64;
    let falling = times
        .windows(2)
        .filter(|pair| pair[1] < pair[0] || pair[1].is_nan())
        .count() as f64;
    let equal = times.windows(2).filter(|pair| pair[1] == pair[0]).count() as f64;
    // A restart of a short record.
    falling <= (MOST_FALLING * pairs).max(1.0)
        && equal <= 0.9 * pairs
        && pairs - falling - equal > falling
}

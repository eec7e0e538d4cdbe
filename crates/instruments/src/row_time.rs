//! The time of a row from the cells of its columns.

use gyrocal_record::InputErrorKind;

use crate::cell::{Cell, Fault};
use crate::date_time::DateTimes;
use crate::description::time::WEEK_S;
use crate::description::{Description, Time};
use crate::file_format::FileFormat;
use crate::remedy;

/// Reader of the times of successive rows.
#[derive(Debug, Clone)]
pub(crate) struct RowTime<'a> {
    time: &'a Time,
    format: &'a FileFormat,
    dates: Option<DateTimes>,
}

impl<'a> RowTime<'a> {
    pub(crate) fn new(description: &'a Description) -> Self {
        Self {
            time: &description.time,
            format: &description.file,
            dates: description.time.dates(),
        }
    }

    /// Names of its columns; none of a rate.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'a str> {
        let week = self.time.week_column.as_deref();
        self.time.stamps().iter().map(String::as_str).chain(week)
    }

    /// Time of a row \[s\] from the cells of its columns, by its number from 0. A fault has the place among them.
    pub(crate) fn of(&mut self, cells: &[Cell<'_>], row: usize) -> Result<f64, Fault> {
        if cells.is_empty() {
            return Ok(row as f64 / self.time.rate_hz.unwrap_or(1.0));
        }
        if let Cell::Seconds(seconds) = cells[0] {
            return Ok(seconds);
        }
        if let Some(dates) = &mut self.dates {
            return date(dates, cells).ok_or_else(|| {
                let (expected, advice) = match &self.time.format {
                    Some(format) => (
                        format!("a date and time as `format = \"{format}\"` says"),
                        "correct `format` in `[time]` of the map".to_owned(),
                    ),
                    None => (
                        "a date and time of RFC 3339, as 2026-03-01T12:00:00.5Z".to_owned(),
                        joined(cells)
                            .and_then(|text| remedy::of_time(self.format, &text))
                            .unwrap_or_else(|| {
                                "give its `format` in `[time]` of the map".to_owned()
                            }),
                    ),
                };
                fault(0, expected, advice)
            });
        }
        let week_s = match self.time.week_column {
            Some(_) => self.number(cells, cells.len() - 1)? * WEEK_S,
            None => 0.0,
        };
        Ok(self.number(cells, 0)? * self.time.numeric_unit_s() + week_s)
    }

    fn number(&self, cells: &[Cell<'_>], column: usize) -> Result<f64, Fault> {
        let number = match cells[column] {
            Cell::Text(text) => self.format.decimal.number(text),
            Cell::Number(value) => Some(value),
            Cell::Seconds(_) | Cell::Missing => None,
        };
        number.filter(|value| value.is_finite()).ok_or_else(|| {
            let advice = match cells[column] {
                Cell::Text(text) => remedy::of_time(self.format, text),
                _ => None,
            };
            let expected = "a time in numbers in every row".to_owned();
            fault(column, expected, advice.unwrap_or_default())
        })
    }
}

/// The date and time of cells that are joined by blanks.
fn date(dates: &mut DateTimes, cells: &[Cell<'_>]) -> Option<f64> {
    dates.seconds(&joined(cells)?)
}

/// The text of cells that are joined by blanks.
fn joined(cells: &[Cell<'_>]) -> Option<String> {
    let texts = cells.iter().map(|cell| match cell {
        Cell::Text(text) => Some((*text).to_owned()),
        Cell::Number(value) => Some(value.to_string()),
        Cell::Seconds(_) | Cell::Missing => None,
    });
    Some(texts.collect::<Option<Vec<String>>>()?.join(" "))
}

fn fault(column: usize, expected: String, advice: String) -> Fault {
    Fault {
        column,
        kind: InputErrorKind::Time,
        expected,
        advice,
    }
}

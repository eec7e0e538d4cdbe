//! One row of a stable platform's record from the cells of a described file.

use gyrocal_record::{InputErrorKind, Record};

use crate::cell::Cell;
use crate::date_time::seconds_of;
use crate::description::time::WEEK_S;
use crate::description::{Accel, Description};
use crate::error::{InstrumentError, Unfit};
use crate::remedy;
use crate::scale::accel_scale;

/// One row of a record.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) time_s: f64,
    pub(crate) accel_g: [f64; 3],
    /// `NaN` where it is missing.
    pub(crate) temperature_c: Option<f64>,
}

impl Row {
    pub(crate) fn push_to(self, record: &mut Record) {
        record.time_s.push(self.time_s);
        record.accel_g.push(self.accel_g);
        if let Some(temperature_c) = self.temperature_c {
            record
                .temperature_c
                .get_or_insert_default()
                .push(temperature_c);
        }
    }
}

/// What is wrong with a cell.
pub(crate) struct Fault {
    /// Its column, by the order of [`PlatformRow::names`].
    pub(crate) column: usize,
    pub(crate) kind: InputErrorKind,
    pub(crate) expected: &'static str,
    pub(crate) advice: String,
}

/// Columns of a row and their conversion.
#[derive(Debug)]
pub(crate) struct PlatformRow<'a> {
    description: &'a Description,
    accel: &'a Accel,
    scale: [f64; 3],
    names: Vec<&'a str>,
    time: Option<usize>,
    week: Option<usize>,
    temperature: Option<usize>,
}

impl<'a> PlatformRow<'a> {
    pub(crate) fn new(description: &'a Description) -> Result<Self, InstrumentError> {
        let accel = description.accelerometers()?;
        let mut names: Vec<&str> = accel.columns.iter().map(String::as_str).collect();
        let mut also = |name: Option<&'a String>| {
            let name = name?;
            names.push(name);
            Some(names.len() - 1)
        };
        let time = also(description.time.column.as_ref());
        let week = also(description.time.week_column.as_ref());
        let temperature = also(description.temperature.as_ref().map(|it| &it.column));
        let scale = accel_scale(accel, &description.site)?.ok_or_else(|| {
            InstrumentError::unfit(
                Unfit::NoScale,
                "`counts_per_g = \"from-stops\"` for a record of a stable platform",
                "counts per g",
                "give the number of `counts_per_g`: only the log of a six-sensor unit in many attitudes \
                 determines it",
            )
        })?;
        Ok(Self {
            description,
            accel,
            scale,
            names,
            time,
            week,
            temperature,
        })
    }

    /// Names of the columns: accelerometers, time, week, temperature.
    pub(crate) fn names(&self) -> &[&'a str] {
        &self.names
    }

    /// The row of some cells, which has this number from 0.
    pub(crate) fn of(&self, cells: &[Cell<'_>], row: usize) -> Result<Row, Fault> {
        let mut raw = [0.0; 3];
        for (axis, value) in raw.iter_mut().enumerate() {
            *value = (self.value(cells, axis, row)? - self.accel.zero_counts) * self.scale[axis];
        }
        let temperature_c = match (self.temperature, &self.description.temperature) {
            (Some(column), Some(temperature)) => {
                Some(temperature.unit.celsius(self.value(cells, column, row)?))
            }
            _ => None,
        };
        Ok(Row {
            time_s: self.time_s(cells, row)?,
            accel_g: self.accel.axes.map(|direction| direction.of(raw)),
            temperature_c,
        })
    }

    fn time_s(&self, cells: &[Cell<'_>], row: usize) -> Result<f64, Fault> {
        let time = &self.description.time;
        let Some(column) = self.time else {
            return Ok(row as f64 / time.rate_hz.unwrap_or(1.0));
        };
        let format = &self.description.file;
        let fault = |column: usize, expected: &'static str, advice: Option<String>| Fault {
            column,
            kind: InputErrorKind::Time,
            expected,
            advice: advice.unwrap_or_default(),
        };
        let number = |column: usize| match cells[column] {
            Cell::Text(text) => {
                let number = format
                    .decimal
                    .number(text)
                    .filter(|value| value.is_finite());
                number.ok_or_else(|| {
                    fault(column, "a time in numbers", remedy::of_time(format, text))
                })
            }
            Cell::Number(value) if value.is_finite() => Ok(value),
            _ => Err(fault(column, "a time in every row", None)),
        };
        match cells[column] {
            Cell::Seconds(seconds) => return Ok(seconds),
            Cell::Text(text) if time.is_text() => {
                return seconds_of(text).ok_or_else(|| {
                    let advice = "write 2026-03-01T12:00:00Z, with a fraction and an offset if there \
                                  are any";
                    fault(column, "a date and time of RFC 3339", Some(advice.to_owned()))
                });
            }
            _ => {}
        }
        let week_s = match self.week {
            Some(week) => number(week)? * WEEK_S,
            None => 0.0,
        };
        Ok(number(column)? * time.numeric_unit_s() + week_s)
    }

    /// A value; `NaN` if it is missing.
    fn value(&self, cells: &[Cell<'_>], column: usize, row: usize) -> Result<f64, Fault> {
        let format = &self.description.file;
        match cells[column] {
            Cell::Text(text) => {
                if text.is_empty() || format.missing.iter().any(|missing| missing == text) {
                    return Ok(f64::NAN);
                }
                let number = format.decimal.number(text);
                number
                    .filter(|value| !value.is_infinite())
                    .ok_or_else(|| Fault {
                        column,
                        kind: InputErrorKind::NotANumber,
                        expected: "a finite number, or an empty field for a missing one",
                        advice: remedy::of_value(format, text, row).unwrap_or_default(),
                    })
            }
            Cell::Number(value) => Ok(value),
            Cell::Missing => Ok(f64::NAN),
            Cell::Seconds(_) => Err(Fault {
                column,
                kind: InputErrorKind::WrongType,
                expected: "a column of numbers",
                advice: String::new(),
            }),
        }
    }
}

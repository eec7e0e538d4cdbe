//! One row of a stable platform's record from the cells of a described file.

use gyrocal_record::{InputErrorKind, Record};

use crate::cell::{Cell, Fault};
use crate::description::{Accel, Description};
use crate::error::{InstrumentError, Unfit};
use crate::remedy;
use crate::row_time::RowTime;
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

/// Columns of a row and their conversion.
#[derive(Debug)]
pub(crate) struct PlatformRow<'a> {
    description: &'a Description,
    accel: &'a Accel,
    scale: [f64; 3],
    names: Vec<&'a str>,
    temperature: Option<usize>,
    time: RowTime<'a>,
    /// Place of the first column of times, which are the last.
    first_time: usize,
}

impl<'a> PlatformRow<'a> {
    pub(crate) fn new(description: &'a Description) -> Result<Self, InstrumentError> {
        let accel = description.accelerometers()?;
        let mut names: Vec<&str> = accel.columns.iter().map(String::as_str).collect();
        let temperature = description.temperature.as_ref().map(|temperature| {
            names.push(&temperature.column);
            names.len() - 1
        });
        let first_time = names.len();
        let time = RowTime::new(description);
        names.extend(time.names());
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
            temperature,
            time,
            first_time,
        })
    }

    /// Names of the columns: accelerometers, temperature, time.
    pub(crate) fn names(&self) -> &[&'a str] {
        &self.names
    }

    /// The row of some cells, which has this number from 0.
    pub(crate) fn of(&mut self, cells: &[Cell<'_>], row: usize) -> Result<Row, Fault> {
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
        let time_s = self.time.of(&cells[self.first_time..], row);
        Ok(Row {
            time_s: time_s.map_err(|fault| fault.behind(self.first_time))?,
            accel_g: self.accel.axes.map(|direction| direction.of(raw)),
            temperature_c,
        })
    }

    /// A value; `NaN` if it is missing.
    fn value(&self, cells: &[Cell<'_>], column: usize, row: usize) -> Result<f64, Fault> {
        let format = &self.description.file;
        match cells[column] {
            Cell::Text(text) => {
                if format.is_missing(text) {
                    return Ok(f64::NAN);
                }
                let number = format.decimal.number(text);
                number
                    .filter(|value| !value.is_infinite())
                    .ok_or_else(|| Fault {
                        column,
                        kind: InputErrorKind::NotANumber,
                        expected: "a finite number, or an empty field for a missing one".to_owned(),
                        advice: remedy::of_value(format, text, row).unwrap_or_default(),
                    })
            }
            Cell::Number(value) => Ok(value),
            Cell::Missing => Ok(f64::NAN),
            Cell::Seconds(_) => Err(Fault {
                column,
                kind: InputErrorKind::WrongType,
                expected: "a column of numbers".to_owned(),
                advice: String::new(),
            }),
        }
    }
}

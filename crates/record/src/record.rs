//! The record: accelerometer samples of a platform in the space-stable state.

use std::io;
use std::ops::Range;
use std::path::Path;

use crate::error::{Error, unwritable};
use crate::header::{COLUMNS, REQUIRED_COLUMNS};
use crate::output::write_whole;

/// Accelerometer samples, one a row.
///
/// The three vectors have the same length. A record that was read is never empty, its times
/// rise, and no value but a component of `accel_g` is `NaN`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Time of each row.
    pub time_s: Vec<f64>,
    /// Specific force in platform axes x, y, z \[g\], up positive; `NaN` is a missing component.
    pub accel_g: Vec<[f64; 3]>,
    /// Temperature of each row, if it was logged.
    pub temperature_c: Option<Vec<f64>>,
}

impl Record {
    /// Whether temperature was logged and changes: only then can an effect depend on it.
    #[must_use]
    pub fn temperature_changes(&self) -> bool {
        let logged = self.temperature_c.as_deref().unwrap_or_default();
        logged.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The record with some of its values, each a row and an axis, missing.
    #[must_use]
    pub fn without(&self, values: impl IntoIterator<Item = [usize; 2]>) -> Self {
        let mut rest = self.clone();
        for [row, axis] in values {
            rest.accel_g[row][axis] = f64::NAN;
        }
        rest
    }

    /// Some of its rows.
    #[must_use]
    pub fn part(&self, rows: Range<usize>) -> Self {
        let temperature_c = self.temperature_c.as_ref();
        Self {
            time_s: self.time_s[rows.clone()].to_vec(),
            accel_g: self.accel_g[rows.clone()].to_vec(),
            temperature_c: temperature_c.map(|all| all[rows].to_vec()),
        }
    }

    /// Writes the record whole or not at all. Reading it gives the same numbers.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if [`Record::read`] would refuse it, [`Error::Unwritable`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        write_whole(path, self.to_csv(path)?.as_bytes())
    }

    /// The text of the record's file; errors call it `path`.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if the columns differ in length, if time does not rise or if a
    /// value is infinite.
    pub fn to_csv(&self, path: &Path) -> Result<String, Error> {
        self.check(path)?;
        self.text(path)
    }

    /// The text of the record's file, whatever its values are.
    pub(crate) fn text(&self, path: &Path) -> Result<String, Error> {
        let text = self.format();
        text.map_err(|error| unwritable(path)(io::Error::other(error)))
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Number of rows in which at least one accelerometer has a value.
    #[must_use]
    pub fn measured_rows(&self) -> usize {
        let has_value = |row: &&[f64; 3]| row.iter().any(|component| !component.is_nan());
        self.accel_g.iter().filter(has_value).count()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Time from the first row to the last.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        match (self.time_s.first(), self.time_s.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    fn format(&self) -> Result<String, Box<dyn core::error::Error + Send + Sync>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        match self.temperature_c {
            Some(_) => writer.write_record(COLUMNS)?,
            None => writer.write_record(REQUIRED_COLUMNS)?,
        }
        for (row, (time_s, accel_g)) in self.time_s.iter().zip(&self.accel_g).enumerate() {
            let temperature_c = self.temperature_c.as_ref().map(|column| column[row]);
            let values = [*time_s].into_iter().chain(*accel_g).chain(temperature_c);
            writer.write_record(values.map(number))?;
        }
        Ok(String::from_utf8(writer.into_inner()?)?)
    }

    fn check(&self, path: &Path) -> Result<(), Error> {
        let invalid = |found: String, expected: &str| Error::InvalidValue {
            path: path.to_owned(),
            found,
            expected: expected.to_owned(),
        };
        let temperatures = self.temperature_c.as_ref().map_or(self.len(), Vec::len);
        if self.accel_g.len() != self.len() || temperatures != self.len() {
            let found = format!(
                "{} times, {} samples, {temperatures} temperatures",
                self.len(),
                self.accel_g.len()
            );
            return Err(invalid(found, "as many of each"));
        }
        let not_finite = |value: &&f64| !value.is_finite();
        let components = self.accel_g.iter().flatten();
        let temperatures = self.temperature_c.iter().flatten();
        if let Some(value) = components
            .filter(|component| component.is_infinite())
            .chain(self.time_s.iter().chain(temperatures).filter(not_finite))
            .next()
        {
            return Err(invalid(format!("the value {value}"), "finite values"));
        }
        if let Some(pair) = self.time_s.windows(2).find(|pair| pair[0] >= pair[1]) {
            let found = format!("time {:?} after {:?}", pair[1], pair[0]);
            return Err(invalid(found, "times that rise"));
        }
        Ok(())
    }
}

/// The shortest text that gives the same number again.
fn number(value: f64) -> String {
    if value.is_nan() {
        "nan".to_owned()
    } else {
        format!("{value:?}")
    }
}

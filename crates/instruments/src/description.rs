//! Description of a log: columns, units and axes, in a TOML file.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText};
use serde::{Deserialize, Serialize};

use crate::covariates::{TableColumn, TemperatureColumn};
use crate::file_format::FileFormat;

/// Columns, units and axes of a log: one description for all commands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Format of the file.
    #[serde(default)]
    pub file: FileFormat,
    /// Times of the samples.
    pub time: Time,
    /// The three gyros.
    pub gyro: Gyro,
    /// The three accelerometers.
    pub accel: Accel,
    /// Temperature of the unit.
    pub temperature: Option<TemperatureColumn>,
    /// Rate or angle of the turntable that carries the unit.
    pub table: Option<TableColumn>,
    /// Site of the recording.
    #[serde(default)]
    pub site: Site,
}

/// Times of the samples: a column of time stamps, or a rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// The column of time stamps.
    pub column: Option<String>,
    /// Seconds in one unit of that column.
    #[serde(default = "one")]
    pub unit_s: f64,
    /// Samples a second, on a clock that is exact; in place of a column.
    pub rate_hz: Option<f64>,
    /// Meaning of time stamps that jitter.
    #[serde(default)]
    pub jitter: Jitter,
}

/// Meaning of time stamps that jitter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Jitter {
    /// Stamps of a computer that received samples of a steady clock: equal intervals, if no sample is
    /// missing.
    #[default]
    Steady,
    /// Times of samples, used as they are.
    Use,
    /// Times of samples, which are interpolated at equal intervals.
    Resample,
}

/// The three gyros.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Gyro {
    /// The columns of x, y, z, each the mean rate over the interval that ends at its time stamp.
    pub columns: [String; 3],
    /// Their unit.
    pub unit: GyroUnit,
    /// Directions of the body axes along the columns: `["y", "-x", "z"]` says that body x is
    /// column y, and body y is column x with its sign changed.
    #[serde(default = "straight")]
    pub axes: [Direction; 3],
    /// Count at zero rate.
    #[serde(default)]
    pub zero_counts: f64,
    /// Counts per rad/s, or `"from-turns"`: estimated from turns between stops.
    pub counts_per_rad_per_s: Option<CountScale>,
}

/// The three accelerometers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Accel {
    /// The columns of x, y, z: specific force, up positive.
    pub columns: [String; 3],
    /// Their unit.
    pub unit: AccelUnit,
    /// Directions of the body axes along the columns, as for the gyros.
    #[serde(default = "straight")]
    pub axes: [Direction; 3],
    /// Count at zero specific force.
    #[serde(default)]
    pub zero_counts: f64,
    /// Counts per g, or `"from-stops"`: estimated from the norm of specific force at rest.
    pub counts_per_g: Option<CountScale>,
}

/// Site of the recording.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Site {
    /// Astronomic latitude, north positive.
    pub latitude_deg: Option<f64>,
    /// Gravity in m/s², as used for the scale of the accelerometers.
    pub gravity_m_per_s2: Option<f64>,
}

/// Units of a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum GyroUnit {
    /// rad/s
    #[serde(rename = "rad/s")]
    RadPerS,
    /// deg/s
    #[serde(rename = "deg/s")]
    DegPerS,
    /// deg/h
    #[serde(rename = "deg/h")]
    DegPerH,
    /// Raw counts.
    #[serde(rename = "counts")]
    Counts,
}

/// Units of specific force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum AccelUnit {
    /// m/s²
    #[serde(rename = "m/s2")]
    MetrePerS2,
    /// Local gravity.
    #[serde(rename = "g")]
    G,
    /// Raw counts.
    #[serde(rename = "counts")]
    Counts,
}

/// Scale of raw counts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum CountScale {
    /// Counts per unit, the same for all axes.
    Same(f64),
    /// Counts per unit of each axis.
    Each([f64; 3]),
    /// Estimated from the recording.
    Estimate(Estimate),
}

/// Source of an estimated scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Estimate {
    /// Turns between stops.
    #[serde(rename = "from-turns")]
    FromTurns,
    /// The norm of specific force at rest.
    #[serde(rename = "from-stops")]
    FromStops,
}

/// Direction of a body axis: a column and its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Direction {
    /// The first column.
    #[serde(rename = "x")]
    X,
    /// The second column.
    #[serde(rename = "y")]
    Y,
    /// The third column.
    #[serde(rename = "z")]
    Z,
    /// The first column with its sign changed.
    #[serde(rename = "-x")]
    MinusX,
    /// The second column with its sign changed.
    #[serde(rename = "-y")]
    MinusY,
    /// The third column with its sign changed.
    #[serde(rename = "-z")]
    MinusZ,
}

impl Direction {
    /// Component of three columns in this direction.
    pub(crate) fn of(self, columns: [f64; 3]) -> f64 {
        match self {
            Self::X => columns[0],
            Self::Y => columns[1],
            Self::Z => columns[2],
            Self::MinusX => -columns[0],
            Self::MinusY => -columns[1],
            Self::MinusZ => -columns[2],
        }
    }
}

impl Description {
    /// Reads a description.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for the first mistake in it.
    // As the others inline: the code of the deserialisation is made where it is used.
    #[inline]
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_source(&SourceText::read(path)?)
    }

    /// Parses the text of a description; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for the first mistake in it.
    #[inline]
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Self::from_source(&SourceText::new(text, name)?)
    }

    /// Its schema (JSON Schema, draft 2020-12).
    #[cfg(feature = "schema")]
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::generate::SchemaSettings::draft2020_12()
            .into_generator()
            .into_root_schema_for::<Self>()
    }

    #[inline]
    fn from_source(source: &SourceText) -> Result<Self, Error> {
        let description: Self = toml::from_str(source.text()).map_err(|error| {
            if let Some(swapped) = source.table_in_place_of_description() {
                return swapped;
            }
            let span = error.span().unwrap_or(0..0);
            let found = source.text().get(span.clone()).unwrap_or("").trim();
            let found = match found.lines().next() {
                Some(line) => format!("`{line}`"),
                None => "a file without it".to_owned(),
            };
            let found = format!("{found} ({})", error.message().replace('\n', ", "));
            let expected = "a description of the log";
            let advice = "docs/measured-data.md has every key";
            source.error(InputErrorKind::Syntax, span, found, expected, advice)
        })?;
        match description.mistake() {
            None => Ok(description),
            Some((key, expected)) => {
                let start = source.text().find(key).unwrap_or(0);
                let line = source.text()[start..].lines().next().unwrap_or("");
                Err(source.error(
                    InputErrorKind::OutOfRange,
                    start..start + line.len(),
                    format!("`{line}`"),
                    expected,
                    "docs/measured-data.md has every key",
                ))
            }
        }
    }

    /// First mistake beyond types: its key, and the expected value.
    fn mistake(&self) -> Option<(&'static str, &'static str)> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let count = |scale: Option<CountScale>| match scale {
            Some(CountScale::Same(value)) => positive(value),
            Some(CountScale::Each(values)) => values.into_iter().all(positive),
            Some(CountScale::Estimate(_)) | None => true,
        };
        if self.time.column.is_some() == self.time.rate_hz.is_some() {
            return Some(("[time]", "either `column` or `rate_hz`"));
        }
        if !self.time.rate_hz.is_none_or(positive) {
            return Some(("rate_hz", "a positive number"));
        }
        if !positive(self.time.unit_s) {
            return Some(("unit_s", "a positive number"));
        }
        if !count(self.gyro.counts_per_rad_per_s) {
            return Some(("counts_per_rad_per_s", "positive numbers"));
        }
        if !count(self.accel.counts_per_g) {
            return Some(("counts_per_g", "positive numbers"));
        }
        if !self.table.as_ref().is_none_or(TableColumn::has_axis) {
            return Some(("[table]", "an `axis` that is not zero"));
        }
        let latitude = self.site.latitude_deg;
        if !latitude.is_none_or(|latitude| (-90.0..=90.0).contains(&latitude)) {
            return Some(("latitude_deg", "a number from -90 to 90"));
        }
        // Gravity on the Earth is 9.76 to 9.84 m/s².
        let gravity = self.site.gravity_m_per_s2;
        if !gravity.is_none_or(|gravity| (9.7..=9.9).contains(&gravity)) {
            return Some(("gravity_m_per_s2", "a number from 9.7 to 9.9"));
        }
        if self.accel.unit == AccelUnit::MetrePerS2 && gravity.is_none() {
            return Some((
                "[accel]",
                "`gravity_m_per_s2` in `[site]` with the unit m/s2",
            ));
        }
        None
    }
}

fn one() -> f64 {
    1.0
}

fn straight() -> [Direction; 3] {
    [Direction::X, Direction::Y, Direction::Z]
}

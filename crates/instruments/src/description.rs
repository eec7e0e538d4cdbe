//! Description of a log: columns, units and axes, in a TOML file.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText, is_encoding};
use serde::{Deserialize, Serialize};

use crate::error::{InstrumentError, Unfit};
use crate::file_format::FileFormat;

mod names;
pub mod table;
pub mod temperature;
pub mod time;
pub mod units;

pub use table::{TableColumn, TableUnit};
pub use temperature::Temperature;
pub use time::{Jitter, Time, TimeUnit};
pub use units::{AccelUnit, CountScale, Estimate, GyroUnit};

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
    /// The three gyros; a record of a stable platform needs none.
    pub gyro: Option<Gyro>,
    /// The three accelerometers; an Allan analysis of gyros needs none.
    pub accel: Option<Accel>,
    /// Temperature of the unit.
    pub temperature: Option<Temperature>,
    /// Rate or angle of the turntable that carries the unit.
    pub table: Option<TableColumn>,
    /// Site of the recording.
    #[serde(default)]
    pub site: Site,
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

    /// The description of the columns that a record has without one.
    ///
    /// # Errors
    ///
    /// None: the text is this program's.
    pub fn of_records() -> Result<Self, Error> {
        Self::parse(
            "[time]\ncolumn = \"time_s\"\n[accel]\ncolumns = [\"accel_x_g\", \"accel_y_g\", \
             \"accel_z_g\"]\nunit = \"g\"\n",
            "columns of a record",
        )
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
            let advice = "docs/formats.md has every key";
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
                    "docs/formats.md has every key",
                ))
            }
        }
    }

    /// The accelerometers, for what needs them.
    pub(crate) fn accelerometers(&self) -> Result<&Accel, InstrumentError> {
        self.accel.as_ref().ok_or_else(no_accelerometers)
    }

    /// First mistake beyond types: its key, and the expected value.
    fn mistake(&self) -> Option<(&'static str, &'static str)> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let count = |scale: Option<CountScale>| match scale {
            Some(CountScale::Same(value)) => positive(value),
            Some(CountScale::Each(values)) => values.into_iter().all(positive),
            Some(CountScale::Estimate(_)) | None => true,
        };
        if self
            .file
            .encoding
            .as_ref()
            .is_some_and(|label| !is_encoding(label))
        {
            let expected = "an encoding of the Encoding Standard, as `utf-16le` or `latin1`";
            return Some(("encoding", expected));
        }
        if let Some(mistake) = self.time.mistake() {
            return Some(mistake);
        }
        let gyro = self.gyro.as_ref();
        if !count(gyro.and_then(|gyro| gyro.counts_per_rad_per_s)) {
            return Some(("counts_per_rad_per_s", "positive numbers"));
        }
        let accel = self.accel.as_ref();
        if !count(accel.and_then(|accel| accel.counts_per_g)) {
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
        if accel.is_some_and(|accel| accel.unit.needs_gravity()) && gravity.is_none() {
            return Some((
                "[accel]",
                "`gravity_m_per_s2` in `[site]` with the units m/s2 and ft/s2",
            ));
        }
        None
    }
}

/// The error of a log of gyros alone where more is needed.
pub(crate) fn no_accelerometers() -> InstrumentError {
    InstrumentError::unfit(
        Unfit::NoAccelerometers,
        "a description without `[accel]`",
        "the columns of three accelerometers, which tell attitude and rest",
        "add `[accel]` with `columns = [\"ax\", \"ay\", \"az\"]` and `unit = \"g\"` by the names and the unit of the \
         log; gyros alone suffice for gyrocal allan and gyrocal rates",
    )
}

fn straight() -> [Direction; 3] {
    [Direction::X, Direction::Y, Direction::Z]
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    use serde::de::value::{Error, StrDeserializer};

    use super::names::Named;
    use super::temperature::TemperatureUnit;
    use super::{AccelUnit, GyroUnit, TableUnit, TimeUnit};

    fn read<'de, T: Deserialize<'de>>(text: &'de str) -> Result<T, Error> {
        let text: StrDeserializer<'de, Error> = text.into_deserializer();
        T::deserialize(text)
    }

    #[test]
    fn rates_of_tables_have_the_names_of_those_of_gyros() {
        for (unit, names) in GyroUnit::NAMES {
            for name in *names {
                assert_eq!(read::<GyroUnit>(name).unwrap(), *unit);
                assert_eq!(read::<TableUnit>(name).is_ok(), *unit != GyroUnit::Counts);
            }
        }
        let refused = read::<TableUnit>("rpm").unwrap_err().to_string();
        assert!(
            refused.contains("`rpm`") && refused.contains("`deg/h`"),
            "{refused}"
        );
    }

    /// Names of all units that are read.
    fn names<T: Named>() -> Vec<&'static str> {
        T::NAMES
            .iter()
            .flat_map(|(_, names)| names.iter().copied())
            .collect()
    }

    #[test]
    fn no_name_stands_for_two_units() {
        let of_all = [
            names::<GyroUnit>(),
            names::<AccelUnit>(),
            names::<TableUnit>(),
            names::<TemperatureUnit>(),
            names::<TimeUnit>(),
        ];
        for mut names in of_all {
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{names:?}");
        }
    }

    #[cfg(feature = "schema")]
    #[test]
    fn the_schema_has_every_name_that_is_read() {
        let schema = serde_json::to_string(&super::Description::schema()).unwrap();
        let of_all = [
            names::<GyroUnit>(),
            names::<AccelUnit>(),
            names::<TableUnit>(),
            names::<TemperatureUnit>(),
            names::<TimeUnit>(),
        ];
        for name in of_all.concat() {
            assert!(schema.contains(&format!("\"{name}\"")), "{name}");
        }
    }
}

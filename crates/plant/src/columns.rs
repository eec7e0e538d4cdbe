//! A CSV file with any columns as a record of a plant, by a map of columns (TOML):
//!
//! ```toml
//! [time]
//! column = "t_ms"
//! factor = 0.001          # seconds per unit of the column
//! [inputs]
//! u = "drive"
//! [outputs]
//! y = { column = "ADC0", factor = 0.0025, offset = -1.25 }
//! [regressors]
//! temperature = "T"
//! ```
//!
//! A value is factor × number + offset. An output without a value, or `nan`, is missing.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::Path;

use gyrocal_record::{Error, open_text, printable_path};
use gyrocal_statistics::format;
use gyrocal_words::few;
use serde::Deserialize;

use crate::description::{Description, Output};
use crate::error::PlantError;
use crate::record::{NamedRecord, PlantRecord};

/// Gaps of a record that are told one by one.
const GAPS_SHOWN: usize = 3;

/// A column with the unit of the plant.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
enum Source {
    Name(String),
    Scaled(Scaled),
}

#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Scaled {
    column: String,
    #[serde(default = "one")]
    factor: f64,
    #[serde(default)]
    offset: f64,
}

fn one() -> f64 {
    1.0
}

/// Columns of a file by the names of a plant.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ColumnMap {
    time: Source,
    #[serde(default)]
    inputs: BTreeMap<String, Source>,
    outputs: BTreeMap<String, Source>,
    #[serde(default)]
    regressors: BTreeMap<String, Source>,
}

impl Source {
    fn scaled(&self) -> Scaled {
        match self {
            Self::Name(column) => Scaled {
                column: column.clone(),
                factor: 1.0,
                offset: 0.0,
            },
            Self::Scaled(scaled) => scaled.clone(),
        }
    }
}

fn refuse(origin: &str, problem: String, advice: impl Into<String>) -> PlantError {
    PlantError::Input {
        origin: origin.to_owned(),
        problem,
        advice: advice.into(),
    }
}

/// The text of an input file, which may be compressed, or UTF-16 with a byte-order mark.
pub(crate) fn read_text(path: &Path) -> Result<String, PlantError> {
    let unreadable = |reason| PlantError::Unreadable {
        path: path.to_owned(),
        reason,
    };
    let mut text = String::new();
    let read = open_text(path, None).map_err(|error| match error {
        Error::Unreadable { reason, .. } => reason,
        other => io::Error::other(other),
    });
    read.and_then(|mut read| read.read_to_string(&mut text))
        .map_err(unreadable)?;
    Ok(text)
}

impl ColumnMap {
    /// Reads a map.
    ///
    /// # Errors
    /// [`PlantError::Unreadable`], [`PlantError::Input`].
    pub fn read(path: &Path) -> Result<Self, PlantError> {
        let origin = path.display().to_string();
        toml::from_str(&read_text(path)?).map_err(|error| {
            let advice = "give [time], [inputs], [outputs] and [regressors], each `name = \"column\"` or \
                          `name = { column = \"column\", factor = 1.0, offset = 0.0 }`";
            refuse(&origin, error.to_string().trim().to_owned(), advice)
        })
    }

    /// Reads a CSV file as a record of a plant.
    ///
    /// # Errors
    /// [`PlantError::Unreadable`], [`PlantError::Input`].
    pub fn record(
        &self,
        description: &Description,
        path: &Path,
    ) -> Result<PlantRecord, PlantError> {
        Ok(self.named_record(description, path)?.record)
    }

    /// Reads the time and the inputs of a run that has not been made; columns of outputs are not read, and outputs
    /// are values within their range.
    ///
    /// # Errors
    /// As [`Self::record`].
    pub fn run(&self, description: &Description, path: &Path) -> Result<PlantRecord, PlantError> {
        self.rows(description, &RecordText::read(path)?, &[])
    }

    /// [`Self::record`] with the name of its file.
    ///
    /// # Errors
    /// As there.
    pub fn named_record(
        &self,
        description: &Description,
        path: &Path,
    ) -> Result<NamedRecord, PlantError> {
        self.record_of(description, &RecordText::read(path)?)
    }

    /// The same of a file that is read.
    ///
    /// # Errors
    /// [`PlantError::Input`].
    pub fn record_of(
        &self,
        description: &Description,
        text: &RecordText,
    ) -> Result<NamedRecord, PlantError> {
        Ok(NamedRecord {
            name: text.name.clone(),
            record: self.rows(description, text, &description.outputs)?,
        })
    }

    /// [`Self::run`] with the name of its file.
    ///
    /// # Errors
    /// As there.
    pub fn named_run(
        &self,
        description: &Description,
        path: &Path,
    ) -> Result<NamedRecord, PlantError> {
        Ok(NamedRecord {
            name: printable_path(path),
            record: self.run(description, path)?,
        })
    }

    fn rows(
        &self,
        description: &Description,
        text: &RecordText,
        outputs: &[Output],
    ) -> Result<PlantRecord, PlantError> {
        let origin = text.origin.clone();
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(text.text.as_bytes());
        let csv_fault = |error: csv::Error| {
            refuse(
                &origin,
                error.to_string(),
                "write a header and rows of as many fields",
            )
        };
        let header = reader.headers().map_err(csv_fault)?.clone();
        let names: Vec<&str> = header.iter().collect();
        let places = Places::new(self, description, outputs, (&names[..], origin.as_str()))?;
        let mut record = PlantRecord {
            regressors: vec![Vec::new(); description.regressors.len()],
            ..PlantRecord::default()
        };
        for (index, row) in reader.records().enumerate() {
            let row = row.map_err(csv_fault)?;
            let field = |place: &Place, may_miss: bool| {
                place.value(&row, may_miss).ok_or_else(|| {
                    let found = row.get(place.place).unwrap_or_default();
                    let problem = format!(
                        "row {} has `{found}` in column `{}`",
                        index + 1,
                        names[place.place]
                    );
                    refuse(&origin, problem, "a number is expected there")
                })
            };
            record.time_s.push(field(&places.time, false)?);
            for place in &places.inputs {
                record.inputs.push(field(place, false)?);
            }
            for place in &places.outputs {
                record.outputs.push(field(place, true)?);
            }
            if outputs.is_empty() {
                let all = description.outputs.iter();
                record.outputs.extend(all.map(Output::within));
            }
            for (values, place) in record.regressors.iter_mut().zip(&places.regressors) {
                values.push(field(place, false)?);
            }
        }
        match outputs.is_empty() {
            true => record.prepared_run(description, &origin),
            false => record.prepared(description, &origin),
        }
    }

    /// What is to be said of inputs where a record has no rows for a while, a sentence for each input.
    #[must_use]
    pub fn bridged(&self, description: &Description, named: &NamedRecord) -> Vec<String> {
        let record = &named.record;
        let gaps = record.gaps();
        let told = gaps.iter().map(|row| {
            let length_s = record.time_s[row + 1] - record.time_s[*row];
            let length = format::short(length_s, 3);
            format!("{length} s between rows {} and {}", row + 1, row + 2)
        });
        let told = few(told, GAPS_SHOWN);
        let inputs = description.inputs.iter().filter(|_| !gaps.is_empty());
        let words = inputs.map(|input| {
            let scaled = self.inputs.get(&input.id).map(Source::scaled);
            let column = scaled.map_or_else(|| input.id.clone(), |one| one.column);
            let how = match input.interpolate {
                true => "interpolated over gaps",
                false => "held at its last value over gaps",
            };
            format!(
                "{}: input `{}` (column `{column}`) is {how} of the rows: {told}; if it moved there, cut the record",
                named.name, input.id
            )
        });
        words.collect()
    }
}

/// A record as its file has it, read once for any number of plants.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordText {
    name: String,
    origin: String,
    text: String,
}

impl RecordText {
    /// Reads the file.
    ///
    /// # Errors
    /// [`PlantError::Unreadable`].
    pub fn read(path: &Path) -> Result<Self, PlantError> {
        Ok(Self {
            name: printable_path(path),
            origin: path.display().to_string(),
            text: read_text(path)?,
        })
    }
}

/// A column of a file.
struct Place {
    place: usize,
    factor: f64,
    offset: f64,
}

impl Place {
    fn value(&self, row: &csv::StringRecord, may_miss: bool) -> Option<f64> {
        let text = row.get(self.place)?;
        if text.is_empty() && may_miss {
            return Some(f64::NAN);
        }
        let number: f64 = text.parse().ok()?;
        (may_miss || number.is_finite()).then_some(self.factor * number + self.offset)
    }
}

/// The columns of a plant in a file.
struct Places {
    time: Place,
    inputs: Vec<Place>,
    outputs: Vec<Place>,
    regressors: Vec<Place>,
}

impl Places {
    fn new(
        map: &ColumnMap,
        description: &Description,
        outputs: &[Output],
        (names, origin): (&[&str], &str),
    ) -> Result<Self, PlantError> {
        let place = |what: &str, source: &Source| {
            let Scaled {
                column,
                factor,
                offset,
            } = source.scaled();
            let found = names.iter().position(|name| *name == column);
            let place = found.ok_or_else(|| {
                let problem =
                    format!("the map names the column `{column}` for {what}, which is not there");
                let advice = format!("the file has {}", names.join(", "));
                refuse(origin, problem, advice)
            })?;
            Ok(Place {
                place,
                factor,
                offset,
            })
        };
        let all = |kind: &str, wanted: Vec<&str>, given: &BTreeMap<String, Source>| {
            if let Some(other) = given.keys().find(|name| !wanted.contains(&name.as_str())) {
                let problem = format!("the map has the {kind} `{other}`, which the plant has not");
                let advice = format!("its {kind}s are: {}", wanted.join(", "));
                return Err(refuse(origin, problem, advice));
            }
            let places = wanted.iter().map(|name| {
                let source = given.get(*name).ok_or_else(|| {
                    let problem = format!("the map has no column for the {kind} `{name}`");
                    refuse(
                        origin,
                        problem,
                        format!("add `{name} = \"column\"` to [{kind}s]"),
                    )
                })?;
                place(&format!("{kind} `{name}`"), source)
            });
            places.collect::<Result<Vec<_>, PlantError>>()
        };
        let inputs = description
            .inputs
            .iter()
            .map(|one| one.id.as_str())
            .collect();
        let outputs: Vec<&str> = outputs.iter().map(|one| one.id.as_str()).collect();
        let regressors = description.regressors.iter().map(String::as_str).collect();
        Ok(Self {
            time: place("time", &map.time)?,
            inputs: all("input", inputs, &map.inputs)?,
            outputs: match outputs.is_empty() {
                true => Vec::new(),
                false => all("output", outputs, &map.outputs)?,
            },
            regressors: all("regressor", regressors, &map.regressors)?,
        })
    }
}

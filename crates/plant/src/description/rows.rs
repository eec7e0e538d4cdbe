//! Rows of the tables of a program.

use gyrocal_codegen::Program;
use gyrocal_codegen::program::{Table, Value};
use serde::Deserialize;
use serde::de::IntoDeserializer as _;
use serde::de::value::Error as WordError;

use super::{Channel, Delay, EffectEntry, Kind, Knee, Place};
use crate::error::PlantError;

pub(super) fn channel(row: &Row<'_>) -> Result<Channel, PlantError> {
    Ok(Channel {
        place: place(row)?,
        unit: row.text("unit")?,
        name: row.text("name")?,
        constant: row.index("constant")?,
    })
}

fn place(row: &Row<'_>) -> Result<Place, PlantError> {
    let index = row.index("index")?;
    Ok(match row.word("place")? {
        WrittenPlace::Rate => Place::Rate(index),
        WrittenPlace::Output => Place::Output(index),
        WrittenPlace::Parameter => Place::Parameter(index),
        WrittenPlace::Input => Place::Input(index),
    })
}

pub(super) fn effect(row: &Row<'_>) -> Result<EffectEntry, PlantError> {
    Ok(EffectEntry {
        id: row.text("id")?,
        name: row.text("name")?,
        formula: row.text("formula")?,
        unit: row.text("unit")?,
        kind: match row.word("kind")? {
            WrittenKind::Ramp => Kind::Ramp,
            WrittenKind::Step => Kind::Step,
            WrittenKind::Regressor => Kind::Regressor(row.index("regressor")?),
            WrittenKind::Term => Kind::Term,
            WrittenKind::Delay => Kind::Delay,
            WrittenKind::Play => Kind::Play,
        },
        place: place(row)?,
        size: row.index("size")?,
        equivalents: row.texts("equivalents")?,
    })
}

pub(super) fn knee(row: &Row<'_>) -> Result<Knee, PlantError> {
    Ok(Knee {
        size: row.index("size")?,
        constant: row.index("constant")?,
        unit: row.text("unit")?,
        value: row.number("value")?,
        sigma: row.number("sigma")?,
    })
}

pub(super) fn delay(row: &Row<'_>) -> Result<Delay, PlantError> {
    Ok(Delay {
        input: row.index("input")?,
        constant: row.index("constant")?,
        time: row.index("time")?,
    })
}

/// A [`Kind`] as a program has it.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum WrittenKind {
    Term,
    Ramp,
    Step,
    Regressor,
    Delay,
    Play,
}

/// A [`Place`] as a program has it.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum WrittenPlace {
    Rate,
    Output,
    Parameter,
    Input,
}

/// A row of a table.
pub(super) struct Row<'a> {
    program: &'a Program,
    table: &'a Table,
    values: &'a [Value],
}

pub(super) fn rows<T>(
    program: &Program,
    name: &str,
    read: impl Fn(&Row<'_>) -> Result<T, PlantError>,
) -> Result<Vec<T>, PlantError> {
    let found = program.tables.iter().find(|table| table.name == name);
    // A program has no empty tables.
    let Some(table) = found else {
        return Ok(Vec::new());
    };
    let rows = table.rows.iter().map(|values| {
        read(&Row {
            program,
            table,
            values,
        })
    });
    rows.collect()
}

impl Row<'_> {
    fn refuse(&self, found: &str) -> PlantError {
        PlantError::NoPlant {
            origin: self.program.origin.clone(),
            problem: format!("table `{}` has {found}", self.table.name),
        }
    }

    fn value(&self, field: &str) -> Result<&Value, PlantError> {
        let place = self.table.fields.iter().position(|one| one.name == field);
        place
            .and_then(|place| self.values.get(place))
            .ok_or_else(|| self.refuse(&format!("no field `{field}`")))
    }

    pub(super) fn text(&self, field: &str) -> Result<String, PlantError> {
        match self.value(field)? {
            Value::Text(text) => Ok(text.clone()),
            _ => Err(self.refuse(&format!("no text in `{field}`"))),
        }
    }

    /// One of a few words.
    fn word<T: for<'de> Deserialize<'de>>(&self, field: &str) -> Result<T, PlantError> {
        let text = self.text(field)?;
        let word: Result<T, WordError> = T::deserialize(text.as_str().into_deserializer());
        word.map_err(|error| self.refuse(&format!("in `{field}` {error}")))
    }

    pub(super) fn number(&self, field: &str) -> Result<f64, PlantError> {
        match self.value(field)? {
            Value::Number(number) => Ok(*number),
            _ => Err(self.refuse(&format!("no number in `{field}`"))),
        }
    }

    pub(super) fn truth(&self, field: &str) -> Result<bool, PlantError> {
        match self.value(field)? {
            Value::Truth(truth) => Ok(*truth),
            _ => Err(self.refuse(&format!("neither true nor false in `{field}`"))),
        }
    }

    pub(super) fn index(&self, field: &str) -> Result<usize, PlantError> {
        let number = self.number(field)?;
        if number < 0.0 || number.fract() != 0.0 {
            return Err(self.refuse(&format!("no index in `{field}`")));
        }
        Ok(number as usize)
    }

    fn texts(&self, field: &str) -> Result<Vec<String>, PlantError> {
        match self.value(field)? {
            Value::Texts(texts) => Ok(texts.clone()),
            Value::List(list) if list.is_empty() => Ok(Vec::new()),
            _ => Err(self.refuse(&format!("no list of texts in `{field}`"))),
        }
    }
}

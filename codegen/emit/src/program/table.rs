//! Tables: facts about a program, one record a row.

use super::check::{Context, DERIVE_AGAIN};
use super::names::is_pascal_case;
use super::schema::RawTable;
use crate::Error;

/// A named list of records.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Table {
    /// Name of the array.
    pub name: String,
    /// Name of the type of a record.
    pub row: String,
    /// Meaning.
    pub doc: String,
    /// What every record has.
    pub fields: Vec<Field>,
    /// The records: a value for each field, of its kind.
    pub rows: Vec<Vec<Value>>,
}

/// A field of the records of a table.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Field {
    /// Name in Rust.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// What its values are.
    pub kind: Kind,
}

/// What the values of a field are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Text.
    Text,
    /// A finite number.
    Number,
    /// Yes or no.
    Truth,
    /// Any number of texts.
    Texts,
}

/// A value of a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Text.
    Text(String),
    /// A finite number.
    Number(f64),
    /// Yes or no.
    Truth(bool),
    /// Any number of texts.
    Texts(Vec<String>),
}

impl Value {
    /// What it is.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Text(_) => Kind::Text,
            Self::Number(_) => Kind::Number,
            Self::Truth(_) => Kind::Truth,
            Self::Texts(_) => Kind::Texts,
        }
    }

    fn from_json(value: &serde_json::Value) -> Option<Self> {
        match value {
            serde_json::Value::String(text) => Some(Self::Text(text.clone())),
            serde_json::Value::Bool(truth) => Some(Self::Truth(*truth)),
            serde_json::Value::Number(number) => {
                let number = number.as_f64().filter(|number| number.is_finite())?;
                Some(Self::Number(number))
            }
            serde_json::Value::Array(items) => {
                let texts = items.iter().map(|item| item.as_str().map(str::to_owned));
                Some(Self::Texts(texts.collect::<Option<_>>()?))
            }
            _ => None,
        }
    }
}

pub(super) fn table(context: &Context<'_>, raw: RawTable) -> Result<Table, Error> {
    let place = format!("table `{}`", raw.name);
    if !is_pascal_case(&raw.row) {
        return Err(context.name(&place, &raw.row, "a Rust type name, such as `EffectRow`"));
    }
    let names = raw.fields.iter().map(|field| field.name.as_str());
    context.names(&format!("{place}, fields"), names)?;
    if raw.fields.is_empty() || raw.rows.is_empty() {
        return Err(context.error(
            &place,
            format!("{} fields and {} rows", raw.fields.len(), raw.rows.len()),
            "one of each at least",
            "fill the table, or leave it out",
        ));
    }
    let rows = raw
        .rows
        .iter()
        .enumerate()
        .map(|(number, values)| row(context, &format!("{place}, row {number}"), values))
        .collect::<Result<Vec<_>, _>>()?;
    for (number, row) in rows.iter().enumerate() {
        if row.len() != raw.fields.len() {
            return Err(context.error(
                &format!("{place}, row {number}"),
                format!("{} values", row.len()),
                format!("{}, one for each field", raw.fields.len()),
                DERIVE_AGAIN,
            ));
        }
        for (index, value) in row.iter().enumerate() {
            if value.kind() != rows[0][index].kind() {
                return Err(context.error(
                    &format!("{place}, row {number}, field `{}`", raw.fields[index].name),
                    format!("{value:?}"),
                    format!("{:?}, as in the first row", rows[0][index].kind()),
                    "give all values of a field the same kind",
                ));
            }
        }
    }
    let fields = raw.fields.into_iter().zip(&rows[0]);
    Ok(Table {
        name: raw.name,
        row: raw.row,
        doc: raw.doc,
        fields: fields
            .map(|(field, value)| Field {
                name: field.name,
                doc: field.doc,
                kind: value.kind(),
            })
            .collect(),
        rows,
    })
}

fn row(
    context: &Context<'_>,
    place: &str,
    values: &[serde_json::Value],
) -> Result<Vec<Value>, Error> {
    let value = |value| {
        Value::from_json(value).ok_or_else(|| {
            context.error(
                place,
                value,
                "text, a finite number, true, false or a list of texts",
                DERIVE_AGAIN,
            )
        })
    };
    values.iter().map(value).collect()
}

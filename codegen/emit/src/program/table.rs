//! Tables: facts about a program, one record a row.

use super::context::{Context, DERIVE_AGAIN};
use super::names::{is_pascal_case, is_snake_case};
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
    /// Module of the scalar crate that declares this type and those of its fields; the emitter
    /// declares the type where this is `None`.
    pub module: Option<String>,
    /// Meaning.
    pub doc: String,
    /// Fields of every record.
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
    /// Type of its values.
    pub kind: Kind,
}

/// Type of the values of a field.
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
    /// A value of a type that a module of the scalar crate declares.
    Typed,
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
    /// An index.
    Index(usize),
    /// A variant of an enum, by its path, with what it holds.
    Variant(String, Vec<Value>),
    /// A struct, by its name, with its fields.
    Record(String, Vec<(String, Value)>),
    /// Any number of values of one type.
    List(Vec<Value>),
}

impl Value {
    /// Meaning.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Text(_) => Kind::Text,
            Self::Number(_) => Kind::Number,
            Self::Truth(_) => Kind::Truth,
            Self::Texts(_) => Kind::Texts,
            Self::Index(_) | Self::Variant(..) | Self::Record(..) | Self::List(_) => Kind::Typed,
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
            serde_json::Value::Object(object) => Self::from_object(object),
            serde_json::Value::Null => None,
        }
    }

    /// `{"index": 3}`, `{"variant": "Shape::Round", "arguments": [...]}`,
    /// `{"record": "Ring", "fields": {...}}` or `{"list": [...]}`.
    fn from_object(object: &serde_json::Map<String, serde_json::Value>) -> Option<Self> {
        let all = |name: &str| -> Option<Vec<Self>> {
            let items = object.get(name)?.as_array()?;
            items.iter().map(Self::from_json).collect()
        };
        if let Some(index) = object.get("index") {
            return Some(Self::Index(usize::try_from(index.as_u64()?).ok()?));
        }
        if let Some(path) = object.get("variant") {
            let path = path.as_str().filter(|path| is_path(path))?;
            return Some(Self::Variant(path.to_owned(), all("arguments")?));
        }
        if let Some(name) = object.get("record") {
            let name = name.as_str().filter(|name| is_pascal_case(name))?;
            let fields = object.get("fields")?.as_object()?;
            let fields = fields.iter().map(|(field, value)| {
                let value = Self::from_json(value)?;
                is_snake_case(field).then(|| (field.clone(), value))
            });
            return Some(Self::Record(
                name.to_owned(),
                fields.collect::<Option<_>>()?,
            ));
        }
        Some(Self::List(all("list")?))
    }
}

/// Whether a text is the name of an enum and one of its variants, or of a variant alone.
fn is_path(text: &str) -> bool {
    text.split("::").all(is_pascal_case) && text.split("::").count() <= 2
}

pub(super) fn table(context: &Context<'_>, raw: RawTable) -> Result<Table, Error> {
    let place = format!("table `{}`", raw.name);
    if !is_pascal_case(&raw.row) {
        return Err(context.name(&place, &raw.row, "a Rust type name, such as `EffectRow`"));
    }
    let names = raw.fields.iter().map(|field| field.name.as_str());
    context.names(&format!("{place}, fields"), names)?;
    if let Some(module) = &raw.module
        && !is_snake_case(module)
    {
        return Err(context.name(
            &place,
            module,
            "the name of a Rust module, such as `effect`",
        ));
    }
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
            let declared_here = raw.module.is_none();
            if declared_here && value.kind() == Kind::Typed {
                return Err(context.error(
                    &format!("{place}, row {number}, field `{}`", raw.fields[index].name),
                    format!("{value:?}"),
                    "text, a finite number, true, false or a list of texts",
                    "name the module that declares the type of the rows",
                ));
            }
            if declared_here && value.kind() != rows[0][index].kind() {
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
        module: raw.module,
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
                "text, a finite number, true, false, a list of texts or a typed value",
                DERIVE_AGAIN,
            )
        })
    };
    values.iter().map(value).collect()
}

//! The JSON form of a program, as it stands in the file.

mod instruction;
mod numbers;

use serde::Deserialize;
use serde_json::Value;

pub(super) use instruction::{RawInstruction, RawOperands};

use super::SCHEMA_VERSION;
use crate::Error;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawProgram {
    #[serde(rename = "schema_version")]
    _schema_version: u32,
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) casadi_version: String,
    pub(super) groups: Vec<RawGroup>,
    pub(super) functions: Vec<RawFunction>,
    pub(super) model: Option<RawModel>,
    #[serde(default)]
    pub(super) tables: Vec<RawTable>,
    #[serde(default)]
    pub(super) externals: Vec<RawExternal>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawExternal {
    pub(super) name: String,
    pub(super) path: String,
    pub(super) doc: String,
    pub(super) arguments: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawTable {
    pub(super) name: String,
    pub(super) row: String,
    #[serde(default)]
    pub(super) module: Option<String>,
    pub(super) doc: String,
    pub(super) fields: Vec<RawField>,
    pub(super) rows: Vec<Vec<Value>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawField {
    pub(super) name: String,
    pub(super) doc: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawGroup {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) elements: Vec<RawElement>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawElement {
    pub(super) name: String,
    #[serde(default)]
    pub(super) id: String,
    pub(super) unit: String,
    pub(super) doc: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFunction {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) source: String,
    pub(super) domain: String,
    pub(super) inputs: Vec<RawInput>,
    pub(super) outputs: Vec<RawOutput>,
    pub(super) work_size: usize,
    pub(super) instructions: Vec<RawInstruction>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawInput {
    pub(super) group: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawOutput {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) unit: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) row_names: Vec<String>,
    pub(super) column_names: Vec<String>,
    pub(super) nonzeros: Vec<(usize, usize)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawModel {
    pub(super) name: String,
    pub(super) doc: String,
    pub(super) moving: String,
    pub(super) parameters: Option<String>,
    pub(super) noise: Option<String>,
    pub(super) inputs: Vec<String>,
    pub(super) rates: RawModelFunction,
    pub(super) output: RawModelFunction,
    #[serde(default = "yes")]
    pub(super) flat: bool,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawModelFunction {
    pub(super) value: String,
    pub(super) jacobian: String,
    #[serde(default)]
    pub(super) jacobian_at_origin: Option<String>,
}

/// The version is read alone first, so that a newer form is named as such.
#[derive(Deserialize)]
struct Version {
    schema_version: Option<Value>,
}

pub(super) fn parse(text: &str, origin: &str) -> Result<RawProgram, Error> {
    let json = |error: serde_json::Error| Error::Json {
        origin: origin.to_owned(),
        reason: error.to_string(),
    };
    // Numbers that JSON has not are texts from here on, which the checks name with their place.
    let repaired = numbers::unreadable_as_texts(text);
    let text = repaired.as_deref().unwrap_or(text);
    let version: Version = serde_json::from_str(text).map_err(json)?;
    if version.schema_version != Some(Value::from(SCHEMA_VERSION)) {
        return Err(Error::SchemaVersion {
            origin: origin.to_owned(),
            found: version
                .schema_version
                .map_or_else(|| "none".to_owned(), |found| found.to_string()),
            expected: SCHEMA_VERSION,
        });
    }
    serde_json::from_str(text).map_err(json)
}

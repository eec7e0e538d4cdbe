//! JSON Schemas of results.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

/// JSON Schema (draft 2020-12) of a value as it is written.
#[must_use]
pub fn written_schema<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator()
        .into_root_schema_for::<T>()
}

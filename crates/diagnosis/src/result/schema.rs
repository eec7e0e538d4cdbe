//! The JSON Schema of the contract.

use schemars::generate::SchemaSettings;

use super::DiagnosisResult;

/// JSON Schema (draft 2020-12) of a written [`DiagnosisResult`].
#[must_use]
pub fn schema() -> schemars::Schema {
    SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator()
        .into_root_schema_for::<DiagnosisResult>()
}

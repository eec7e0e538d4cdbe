//! JSON result of an instrument test.

use gyrocal_record::{Manifest, SCHEMA_VERSION};
use serde::Serialize;

/// A result with its manifest. The fields of the result are at the same level as those of this
/// type.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ResultFile<T> {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// The result.
    #[serde(flatten)]
    pub result: T,
}

impl<T> ResultFile<T> {
    /// A result with its manifest.
    #[must_use]
    pub fn new(manifest: Manifest, result: T) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            manifest,
            result,
        }
    }
}

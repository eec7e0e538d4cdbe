use gyrocal_record::{Manifest, SCHEMA_VERSION};
use serde::Serialize;

/// A result for programs: where it comes from, and its own fields beside that.
#[derive(Debug, Clone, Serialize)]
pub struct ResultFile<T> {
    schema_version: u32,
    manifest: Manifest,
    #[serde(flatten)]
    result: T,
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

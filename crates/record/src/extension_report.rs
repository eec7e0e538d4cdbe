//! The JSON result of `gyrocal extend`.

use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;

/// Result of `gyrocal extend`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExtensionReport {
    /// `SCHEMA_VERSION` of `gyrocal-record` at the time of writing.
    pub schema_version: u32,
    /// Origin of the result.
    pub manifest: Manifest,
    /// Whether the model is that of gyros and accelerometers that are fixed to a body, in their own axes.
    #[serde(default)]
    pub strapdown: bool,
    /// The effects of the model file.
    pub effects: Vec<String>,
    /// Findings without a place in the model file.
    pub left_out: Vec<LeftOut>,
}

/// A finding without a place in the model file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeftOut {
    /// Its effect.
    pub effect: String,
    /// The reason, as the rest of a sentence that begins with the effect.
    pub why: String,
}

//! Origin of a result.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::content::digest_of;
use crate::error::Error;

/// Program, inputs and command line of a result.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Manifest {
    /// Name of the program.
    pub program: String,
    /// Its version.
    pub version: String,
    /// Hash of the symbolic model that its filter was generated from; empty if it used none.
    pub model_hash: String,
    /// The files that were read.
    pub inputs: Vec<Input>,
    /// Seed of whatever was drawn at random; 0 if nothing was.
    pub seed: u64,
    /// The command line.
    pub command: String,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Input {
    /// The path as it was given.
    pub path: String,
    /// SHA-256 of the content, in hexadecimal.
    pub sha256: String,
    /// What it is to the command, where a next command needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<InputRole>,
    /// `[identification]` of a bench file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub identification: BTreeMap<String, String>,
}

/// What a file is to the command that reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum InputRole {
    /// A record.
    Record,
    /// A bench description: of all records, or of one of them in their order.
    Bench,
    /// The axes of a strapdown unit's instruments in a record, in the order of the records.
    GyroAxes,
    /// A later record, which takes no part in the fit.
    LaterRecord,
    /// Its bench description.
    LaterBench,
    /// The axes of the instruments in it.
    LaterGyroAxes,
    /// The map of the columns of all records.
    Columns,
    /// The result of a diagnosis.
    Diagnosis,
}

impl Input {
    /// A file by its hash: of the bytes that this process read last, if it read all, else of those that it has now.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`] if it cannot be read.
    pub fn of(path: &Path) -> Result<Self, Error> {
        Ok(Self {
            path: path.display().to_string(),
            sha256: digest_of(path)?,
            ..Self::default()
        })
    }

    /// The same as a file of a role.
    #[must_use]
    pub fn with_role(self, role: InputRole) -> Self {
        Self {
            role: Some(role),
            ..self
        }
    }
}

//! Declaration of a derivation: the file `derivation.toml`.

use std::path::Path;

use serde::Deserialize;

use super::error::{Error, at};
use super::fingerprint::normalised;

/// Name of the declaration inside a derivation directory.
pub const DECLARATION_FILE: &str = "derivation.toml";

/// Pinned wheels of CasADi, each with its hash.
const REQUIREMENTS: &str = include_str!("../../exporter/requirements.lock");

/// The declaration, as written. Paths are relative to the derivation directory.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Declaration {
    /// Name of the directory in headers and messages.
    pub(super) source: String,
    /// The command that rewrites the committed files.
    pub(super) write_command: String,
    /// Requirements on Python; by default those of this crate, with its lock file.
    #[serde(default)]
    pub(super) python: PythonDeclaration,
    /// The programs that become Rust modules.
    #[serde(rename = "module")]
    pub(super) modules: Vec<ModuleDeclaration>,
    /// Files of evaluated numbers.
    #[serde(default)]
    pub(super) numbers: Vec<NumbersDeclaration>,
    /// Products that are added become fused multiply-adds where the target has them.
    #[serde(default)]
    pub(super) fused_multiply_add: bool,
    /// Settings for variants of other packages.
    #[serde(default)]
    pub(super) variants: VariantsDeclaration,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct VariantsDeclaration {
    /// Path of the traits of generated code in those packages.
    pub(super) scalar_crate: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PythonDeclaration {
    /// Oldest minor version that will do.
    pub(super) minimum: Minor,
    /// Newest minor version for which the lock file holds wheels.
    pub(super) newest: Minor,
    /// The lock file; `None` is that of this crate.
    pub(super) requirements: Option<String>,
}

impl Default for PythonDeclaration {
    fn default() -> Self {
        Self {
            minimum: Minor(11),
            newest: Minor(14),
            requirements: None,
        }
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ModuleDeclaration {
    /// The derivation writes `PROGRAM.json`; the emitted file is `PROGRAM.rs`.
    pub(super) program: String,
    /// Committed Rust file.
    pub(super) rust: String,
    /// Committed program, if it is committed.
    pub(super) json: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NumbersDeclaration {
    /// File that the derivation writes.
    pub(super) file: String,
    /// Path of the committed copy. It is written when a module changed or it is missing, and
    /// never compared: the last bits of evaluated numbers depend on the processor.
    pub(super) committed: String,
}

/// A minor version of Python 3, written `3.11`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(try_from = "String")]
pub(super) struct Minor(pub(super) u32);

impl TryFrom<String> for Minor {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.strip_prefix("3.")
            .and_then(|minor| minor.parse().ok())
            .map(Minor)
            .ok_or_else(|| format!("found `{text}`, expected a version like \"3.11\""))
    }
}

impl std::fmt::Display for Minor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "3.{}", self.0)
    }
}

impl Declaration {
    /// Reads and checks the declaration of the derivation in `directory`.
    pub(super) fn read(directory: &Path) -> Result<Self, Error> {
        let path = directory.join(DECLARATION_FILE);
        let text = std::fs::read_to_string(&path).map_err(at("read", &path))?;
        let reject = |reason: String| Error::Declaration {
            path: path.clone(),
            reason,
        };
        let declaration: Self = toml::from_str(&text).map_err(|e| reject(e.to_string()))?;
        for module in &declaration.modules {
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if module.program.is_empty() || !module.program.chars().all(plain) {
                return Err(reject(format!(
                    "module program: found `{}`, expected letters, digits and `_`",
                    module.program
                )));
            }
        }
        Ok(declaration)
    }
}

/// The lock file of a derivation, as far as the build has to understand it.
#[derive(Debug, Clone)]
pub(super) struct Lock {
    /// Its contents with line endings normalised.
    pub(super) text: String,
    /// The pinned version of CasADi.
    pub(super) casadi: String,
}

impl Lock {
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path).map_err(at("read", path))?;
        Self::parse(path, &text)
    }

    /// The lock file of this crate, for derivations that declare none.
    pub(super) fn of_this_crate() -> Result<Self, Error> {
        Self::parse(Path::new("exporter/requirements.lock"), REQUIREMENTS)
    }

    fn parse(path: &Path, text: &str) -> Result<Self, Error> {
        let text = normalised(text);
        let casadi = text
            .lines()
            .find_map(|line| line.strip_prefix("casadi=="))
            .and_then(|rest| rest.split([' ', ';', '\\']).next())
            .map(str::to_owned)
            .ok_or_else(|| Error::Declaration {
                path: path.to_owned(),
                reason: "found no line `casadi==VERSION`, expected a lock file with hashes, as \
                         `pip-compile --generate-hashes` writes it"
                    .into(),
            })?;
        Ok(Self { text, casadi })
    }
}

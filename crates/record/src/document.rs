//! TOML files.

use std::path::Path;

use toml::de::DeTable;

use crate::error::{Error, InputErrorKind};
use crate::source::{SourceText, quoted};
use crate::table::Table;

/// A TOML file that [`Table`]s are taken from.
#[derive(Debug, Clone)]
pub struct Document {
    source: SourceText,
}

impl Document {
    /// Reads a TOML file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`] if that is not possible, [`Error::Input`] if it is empty or not
    /// UTF-8.
    pub fn read(path: &Path) -> Result<Self, Error> {
        SourceText::read(path).map(|source| Self { source })
    }

    /// Takes the text of a TOML file.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is empty.
    pub fn new(text: &str, name: &str) -> Result<Self, Error> {
        SourceText::new(text, name).map(|source| Self { source })
    }

    /// Parses the file and hands its root table, which may have the keys `known`, to `interpret`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the file is not TOML or has an unknown key, and what `interpret`
    /// says.
    pub fn interpret<T>(
        &self,
        known: &[&str],
        interpret: impl FnOnce(&Table<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let root = DeTable::parse(self.source.text()).map_err(|error| {
            if let Some(swapped) = self.source.table_in_place_of_description() {
                return swapped;
            }
            let span = error.span().unwrap_or(0..0);
            let there = self.source.text().get(span.clone()).unwrap_or("");
            self.source.error(
                InputErrorKind::Syntax,
                span,
                quoted(there),
                format!("valid TOML ({})", error.message().replace('\n', ", ")),
                "see toml.io for the format",
            )
        })?;
        interpret(&Table::root(&self.source, root.get_ref(), known)?)
    }
}

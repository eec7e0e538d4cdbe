//! Pieces of an answer in words.

use serde::Serialize;

/// A piece of an answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Block {
    /// Sentences.
    Paragraph(String),
    /// One entry of a numbered list, with paragraphs below its title.
    Entry {
        /// Its number.
        number: usize,
        /// Its title.
        title: String,
        /// Its text.
        paragraphs: Vec<String>,
    },
    /// A list with a title.
    List {
        /// Its title, with a colon at the end.
        title: String,
        /// Its entries.
        entries: Vec<String>,
    },
    /// A table with a title.
    Table(Table),
}

/// A table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// Its title, with a colon at the end.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, each with one cell for every column.
    pub rows: Vec<Vec<String>>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Its head.
    pub head: String,
    /// Whether its cells are numbers, to be aligned at the right.
    pub is_number: bool,
}

impl Column {
    /// A column of words.
    #[must_use]
    pub fn words(head: &str) -> Self {
        Self {
            head: head.to_owned(),
            is_number: false,
        }
    }

    /// A column of numbers.
    #[must_use]
    pub fn numbers(head: &str) -> Self {
        Self {
            head: head.to_owned(),
            is_number: true,
        }
    }
}

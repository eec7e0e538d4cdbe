//! Pieces of a section that are read.

use serde::{Deserialize, Serialize};

/// A piece of a document that is read: of a section, or of an answer in words.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Words {
    /// Sentences.
    Paragraph(String),
    /// A list with a title.
    List(List),
    /// A table with a title.
    Table(Table),
    /// A command to copy.
    Command(String),
}

impl Words {
    /// A list; `None` without entries.
    #[must_use]
    pub fn list(title: &str, entries: impl IntoIterator<Item = String>) -> Option<Self> {
        List::of(title, entries).map(Self::List)
    }
}

/// A list.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct List {
    /// Its title, without a colon; may be empty.
    pub title: String,
    /// Its entries.
    pub entries: Vec<String>,
}

impl List {
    /// A list; `None` without entries.
    #[must_use]
    pub fn of(title: &str, entries: impl IntoIterator<Item = String>) -> Option<Self> {
        let entries: Vec<String> = entries.into_iter().collect();
        let title = title.to_owned();
        (!entries.is_empty()).then_some(Self { title, entries })
    }
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub struct Table {
    /// Its title, without a colon; may be empty.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, each with one cell for every column.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table of plain cells.
    #[must_use]
    pub fn new<Row>(title: &str, columns: Vec<Column>, rows: impl IntoIterator<Item = Row>) -> Self
    where
        Row: IntoIterator<Item = String>,
    {
        let rows = rows.into_iter();
        Self {
            title: title.to_owned(),
            columns,
            rows: rows
                .map(|row| row.into_iter().map(Cell::from).collect())
                .collect(),
        }
    }

    /// A table of plain cells, with the heads of [`Column::heads`].
    #[must_use]
    pub fn of<Row>(title: &str, heads: &str, rows: impl IntoIterator<Item = Row>) -> Self
    where
        Row: IntoIterator<Item = String>,
    {
        Self::new(title, Column::heads(heads), rows)
    }

    /// The table; `None` without rows.
    #[must_use]
    pub fn filled(self) -> Option<Self> {
        (!self.rows.is_empty()).then_some(self)
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Column {
    /// Its head, with the unit where all cells have one.
    pub head: String,
    /// Whether its cells are numbers, to be aligned at the right.
    pub is_number: bool,
}

impl Column {
    /// Columns by their heads, between `|`; `>` stands before those of numbers: `coefficient | > estimate`.
    #[must_use]
    pub fn heads(heads: &str) -> Vec<Self> {
        let heads = heads.split('|').map(str::trim);
        heads
            .map(|head| match head.strip_prefix("> ") {
                Some(head) => Self::numbers(head),
                None => Self::words(head),
            })
            .collect()
    }

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

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Cell {
    /// Its text.
    pub text: String,
    /// Whether it is to be noticed.
    pub strong: bool,
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self {
            text,
            strong: false,
        }
    }
}

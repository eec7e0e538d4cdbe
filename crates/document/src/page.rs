//! Pages: answers with their sections.

use serde::Serialize;

use crate::{Bars, Chart, Estimates, Fact, List, Screen, Table, Words};

/// A page: one answer, or several below each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Title of the document.
    pub title: String,
    /// The answers.
    pub parts: Vec<Part>,
}

/// One answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name of what was examined: that of the record.
    pub name: String,
    /// Its size: `2880 rows over 2.00 days`.
    pub size: String,
    /// What a person reads first.
    pub first: Screen,
    /// The answer in detail.
    pub sections: Vec<Section>,
    /// Where it comes from.
    pub origin: Origin,
}

/// A section with a heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Its anchor, unique within a part.
    pub id: String,
    /// Its heading.
    pub title: String,
    /// A sentence that says how to read it.
    pub lead: String,
    /// Its content.
    pub items: Vec<Item>,
}

/// A piece of a section.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Item {
    /// Text, a list, a table or a command.
    Words(Words),
    /// Panels with lines.
    Chart(Chart),
    /// Horizontal bars in groups.
    Bars(Bars),
    /// Estimates of several models side by side.
    Estimates(Estimates),
}

impl Item {
    /// A paragraph.
    #[must_use]
    pub fn text(words: impl Into<String>) -> Self {
        Self::Words(Words::Paragraph(words.into()))
    }

    /// A command to copy.
    #[must_use]
    pub fn command(command: impl Into<String>) -> Self {
        Self::Words(Words::Command(command.into()))
    }
}

impl From<List> for Item {
    fn from(list: List) -> Self {
        Self::Words(Words::List(list))
    }
}

impl From<Table> for Item {
    fn from(table: Table) -> Self {
        Self::Words(Words::Table(table))
    }
}

/// Where an answer comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Origin {
    /// What identifies unit and run.
    pub identification: Vec<Fact>,
    /// The foot of each printed page: report, unit, program and model.
    pub foot: String,
    /// Program and version.
    pub program: String,
    /// Hash of the symbolic model; empty if there is none.
    pub model_hash: String,
    /// Seed of what was drawn at random.
    pub seed: String,
    /// The command line.
    pub command: String,
    /// The files that were read.
    pub files: Vec<OriginFile>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct OriginFile {
    /// Its path.
    pub path: String,
    /// SHA-256 of its content.
    pub sha256: String,
}

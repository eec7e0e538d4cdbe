//! The content of a page.

use serde::Serialize;

use super::chart::{Chart, Tint};

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
    /// The answer in short.
    pub summary: Summary,
    /// The answer in detail.
    pub sections: Vec<Section>,
    /// Where it comes from.
    pub origin: Origin,
}

/// The first screen of an answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Whether anything is wrong.
    pub tone: Tone,
    /// The verdict in a few words.
    pub headline: String,
    /// The verdict in a sentence, with its probabilities.
    pub sentence: String,
    /// What a person wants to know first.
    pub cards: Vec<Card>,
}

/// Whether anything is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tone {
    /// Nothing was found.
    Good,
    /// Something was found and is explained.
    Found,
    /// Something is wrong and is not explained.
    Bad,
    /// Neither: a result without a verdict.
    Plain,
}

impl Tone {
    /// Letter that stands beside the colour.
    pub(crate) fn sign(self) -> &'static str {
        match self {
            Self::Good => "✓",
            Self::Found => "!",
            Self::Bad => "✕",
            Self::Plain => "i",
        }
    }
}

/// A tile of the first screen.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Card {
    /// Its title.
    pub title: String,
    /// The main word, large.
    pub main: String,
    /// The main number with sigma and unit, below the word.
    pub number: String,
    /// Sentences.
    pub text: Vec<String>,
    /// A short table.
    pub table: Option<Table>,
    /// A command to copy.
    pub command: String,
    /// Columns of twelve that it spans.
    pub columns: usize,
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
    /// A paragraph.
    Text(String),
    /// A list.
    List(List),
    /// A table.
    Table(Table),
    /// Panels with lines.
    Chart(Chart),
    /// Horizontal bars in groups.
    Bars(Bars),
    /// Estimates of several models side by side.
    Estimates(Estimates),
    /// A command to copy.
    Command(String),
}

/// A list.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct List {
    /// Its title; may be empty.
    pub title: String,
    /// Its entries.
    pub entries: Vec<String>,
}

/// A table, which a reader can sort and copy.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Table {
    /// Its title.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, each with one cell for every column.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Its head, with the unit where all cells have one.
    pub head: String,
    /// Whether its cells are numbers.
    pub is_number: bool,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
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

/// Horizontal bars in groups, with a threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// Its title.
    pub title: String,
    /// Quantity of the bars, with its unit.
    pub quantity: String,
    /// The threshold and its name.
    pub threshold: Option<(f64, String)>,
    /// The groups from top to bottom.
    pub groups: Vec<BarGroup>,
    /// A sentence on what is left out; may be empty.
    pub omitted: String,
}

/// A group of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    /// Its heading.
    pub label: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

/// A bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Its name.
    pub label: String,
    /// Its length; nan where it was not determined.
    pub value: f64,
    /// Its colour.
    pub tint: Tint,
    /// A remark beside it; may be empty.
    pub note: String,
}

/// Estimates of several models side by side, as numbers and on a scale of each quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimates {
    /// Its title.
    pub title: String,
    /// The models with their colours.
    pub models: Vec<(String, Tint)>,
    /// The quantities.
    pub rows: Vec<EstimateRow>,
    /// Head of the column of remarks; may be empty.
    pub note_head: String,
}

/// The estimates of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimateRow {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// An estimate of each model.
    pub values: Vec<ValueWithSigma>,
    /// A remark; may be empty.
    pub note: String,
    /// Whether the remark is to be noticed.
    pub strong: bool,
}

/// An estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueWithSigma {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// Where an answer comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Origin {
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

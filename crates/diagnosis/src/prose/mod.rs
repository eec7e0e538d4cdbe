//! The sentences and tables of an answer, as plain data.
//!
//! Everything here is made from [`gyrocal_answer`] alone, so that a terminal, a report and a program
//! in another language say the same words. [`diagnosis`] gives all of it in reading order; whoever
//! shows it breaks lines and draws tables. [`first_screen`] gives what a person reads first.

mod catalogue;
mod clean_screen;
mod findings;
mod first_screen;
mod format;
mod gain;
mod limits;
mod records;
mod screen;
mod tables;
mod tests;
mod verdict;

use serde::Serialize;

use gyrocal_answer::{Answer, Verdict};

pub use catalogue::{explained, is_correlation, tested, typical_size};
pub use findings::{likelihood, parameter_values};
pub use first_screen::{first_screen, may_also_be};
pub use format::{NO_P, counted, tested as tested_p};
pub use limits::{
    SET_UPS_WITHOUT_ANGLES, groups, near_twins, not_tested, time_is_temperature,
    why_not_distinguished, would_distinguish,
};
pub use records::files;
pub use screen::{
    Fact, NextStep, Screen, Standing, command_files, few, first_input_files, input_files,
    record_and_bench,
};
pub use tests::residual_description;
pub use verdict::{not_settled, setup};

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

/// The whole answer in reading order: record, verdict, magnitude test, findings, limits, gain,
/// residual test, tables.
#[must_use]
pub fn diagnosis(result: &Answer) -> Vec<Block> {
    let mut blocks = vec![
        Block::Paragraph(verdict::record(result)),
        Block::Paragraph(verdict::verdict(result)),
    ];
    blocks.extend(verdict::setup(&result.setup));
    if result.verdict == Verdict::Setup {
        return blocks;
    }
    blocks.extend(verdict::unfinished(result).map(Block::Paragraph));
    blocks.push(Block::Paragraph(tests::magnitude(result)));
    blocks.extend(findings::entries(result));
    blocks.extend(records::table(result).map(Block::Table));
    blocks.extend(tests::filter(result).map(Block::Paragraph));
    blocks.extend(limits::indistinguishable(result));
    blocks.extend(gain::paragraphs(result).map(Block::Paragraph));
    blocks.push(Block::Paragraph(tests::whiteness(result)));
    blocks.push(Block::Paragraph(tests::allan(result)));
    blocks.extend(tables::all(result));
    blocks.extend(tests::noise_audit(result).map(Block::Paragraph));
    blocks.extend(limits::untested(result));
    blocks
}

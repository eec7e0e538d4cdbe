//! Pieces of an answer in words as pieces of a page.

use gyrocal_document::{Block, Table};
use gyrocal_report::page::{self, Cell, Column, Item, List};

/// Each block as an item; blocks of a kind that a page does not know are left out.
pub(crate) fn items(blocks: &[Block]) -> Vec<Item> {
    blocks.iter().filter_map(item).collect()
}

fn item(block: &Block) -> Option<Item> {
    Some(match block {
        Block::Paragraph(words) => Item::Text(words.clone()),
        Block::Entry {
            number,
            title,
            paragraphs,
        } => Item::List(List {
            title: format!("{number}. {title}"),
            entries: paragraphs.clone(),
        }),
        Block::List { title, entries } => Item::List(List {
            title: heading(title),
            entries: entries.clone(),
        }),
        Block::Table(content) => Item::Table(table(content)),
        _ => return None,
    })
}

pub(crate) fn table(content: &Table) -> page::Table {
    let columns = content.columns.iter().map(|column| Column {
        head: column.head.clone(),
        is_number: column.is_number,
    });
    let rows = content.rows.iter();
    page::Table {
        title: heading(&content.title),
        columns: columns.collect(),
        rows: rows
            .map(|row| row.iter().cloned().map(Cell::from).collect())
            .collect(),
    }
}

/// A title without its colon.
fn heading(title: &str) -> String {
    title.trim_end_matches(':').to_owned()
}

//! Pieces of an answer in words as pieces of a page.

use gyrocal_document::{Table, Words};
use gyrocal_report::page::{self, Cell, Column, Item, List};

/// Each piece as an item.
pub(crate) fn items(pieces: &[Words]) -> Vec<Item> {
    pieces.iter().map(item).collect()
}

fn item(piece: &Words) -> Item {
    match piece {
        Words::Paragraph(words) => Item::Text(words.clone()),
        Words::Entry(entry) => Item::List(List {
            title: format!("{}. {}", entry.number, entry.title),
            entries: entry.paragraphs.clone(),
        }),
        Words::List(list) => Item::List(List {
            title: list.title.clone(),
            entries: list.entries.clone(),
        }),
        Words::Table(content) => Item::Table(table(content)),
        Words::Command(command) => Item::Command(command.clone()),
    }
}

pub(crate) fn table(content: &Table) -> page::Table {
    let columns = content.columns.iter().map(|column| Column {
        head: column.head.clone(),
        is_number: column.is_number,
    });
    let rows = content.rows.iter();
    page::Table {
        title: content.title.clone(),
        columns: columns.collect(),
        rows: rows
            .map(|row| {
                row.iter()
                    .map(|cell| Cell::from(cell.text.clone()))
                    .collect()
            })
            .collect(),
    }
}

//! Layout of an answer for a terminal: lines, lists and tables.

use comfy_table::Cell;
use gyrocal_document::{Block, Table};

use crate::tables::{right, table};
use crate::text::{bullet, indented, paragraph};

/// Blocks of an answer, an empty line between any two.
pub(crate) fn layout(blocks: &[Block]) -> String {
    let texts: Vec<String> = blocks.iter().map(block).collect();
    texts.join("\n")
}

fn block(block: &Block) -> String {
    match block {
        Block::Paragraph(words) => paragraph(words),
        Block::Entry {
            number,
            title,
            paragraphs,
        } => {
            let body = paragraphs.iter().map(|words| indented("   ", words));
            format!("{number}. {title}\n{}", body.collect::<String>())
        }
        Block::List { title, entries } => {
            let entries = entries.iter().map(|entry| bullet(entry));
            format!("{title}\n{}", entries.collect::<String>())
        }
        Block::Table(content) => format!("{}\n{}\n", paragraph(&content.title), drawn(content)),
        // A block of a kind that this layout does not know.
        _ => String::new(),
    }
}

pub(crate) fn drawn(content: &Table) -> String {
    let heads: Vec<&str> = content.columns.iter().map(|column| &*column.head).collect();
    let mut table = table(heads);
    for row in &content.rows {
        let cells = row.iter().zip(&content.columns).map(|(cell, column)| {
            if column.is_number {
                right(cell)
            } else {
                Cell::new(cell)
            }
        });
        table.add_row(cells.collect::<Vec<_>>());
    }
    table.trim_fmt()
}

//! Layout of an answer for a terminal: lines, lists and tables.

use comfy_table::Cell;
use gyrocal_document::{Table, Words};

use crate::tables::{right, table};
use crate::text::{bullet, indented, paragraph};

/// An answer in words, an empty line between any two pieces.
pub(crate) fn layout(pieces: &[Words]) -> String {
    let texts: Vec<String> = pieces.iter().map(piece).collect();
    texts.join("\n")
}

fn piece(piece: &Words) -> String {
    match piece {
        Words::Paragraph(words) => paragraph(words),
        Words::Entry(entry) => {
            let body = entry.paragraphs.iter();
            let body = body.map(|words| indented("   ", words));
            format!(
                "{}. {}\n{}",
                entry.number,
                entry.title,
                body.collect::<String>()
            )
        }
        Words::List(list) => {
            let entries = list.entries.iter().map(|entry| bullet(entry));
            format!("{}{}", titled(&list.title), entries.collect::<String>())
        }
        Words::Table(content) => {
            let title = match content.title.is_empty() {
                true => String::new(),
                false => paragraph(&format!("{}:", content.title)) + "\n",
            };
            format!("{title}{}\n", drawn(content))
        }
        Words::Command(command) => format!("{command}\n"),
    }
}

/// A title above what it stands for.
fn titled(title: &str) -> String {
    match title.is_empty() {
        true => String::new(),
        false => format!("{title}:\n"),
    }
}

pub(crate) fn drawn(content: &Table) -> String {
    let heads: Vec<&str> = content.columns.iter().map(|column| &*column.head).collect();
    let mut table = table(heads);
    for row in &content.rows {
        let cells = row.iter().zip(&content.columns).map(|(cell, column)| {
            if column.is_number {
                right(&cell.text)
            } else {
                Cell::new(&cell.text)
            }
        });
        table.add_row(cells.collect::<Vec<_>>());
    }
    table.trim_fmt()
}

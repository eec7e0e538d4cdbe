//! Layout of an answer for a terminal: lines, lists and tables.

use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, TableStyle};
use gyrocal_document::{Table, Words};

use crate::text::{bullet, paragraph};
use crate::width;

/// An answer in words, an empty line between any two pieces.
pub(crate) fn layout(pieces: &[Words]) -> String {
    let texts: Vec<String> = pieces.iter().map(piece).collect();
    texts.join("\n")
}

fn piece(piece: &Words) -> String {
    match piece {
        Words::Paragraph(words) => paragraph(words),
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

/// A table with a rule below its head and no other lines.
pub(crate) fn drawn(content: &Table) -> String {
    let rule = LineStyle::none().fill('─').junction('─');
    let mut table = comfy_table::Table::new();
    table
        .load_style(TableStyle::new().header_separator(rule))
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_header(content.columns.iter().map(|column| &column.head));
    if let Some(columns) = width::columns() {
        table.set_width(u16::try_from(columns).unwrap_or(u16::MAX));
    }
    for row in &content.rows {
        let cells = row.iter().zip(&content.columns);
        table.add_row(cells.map(|(cell, column)| {
            Cell::new(&cell.text).set_alignment(match column.is_number {
                true => CellAlignment::Right,
                false => CellAlignment::Left,
            })
        }));
    }
    table.trim_fmt()
}

//! Layout of an answer for a terminal: lines, lists and tables.

use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, TableStyle};
use gyrocal_document::{Column, Estimates, Item, Section, Table, Words};
use gyrocal_statistics::format;

use crate::text::{bullet, indented, paragraph};
use crate::width;

/// An answer in words, an empty line between any two pieces.
pub(crate) fn layout(pieces: &[Words]) -> String {
    let texts: Vec<String> = pieces.iter().map(piece).collect();
    texts.join("\n")
}

/// What is read of sections: all but charts and bars, which pages and pictures have.
pub(crate) fn sections(sections: &[Section]) -> String {
    let texts = sections.iter().filter_map(|section| {
        let items = section.items.iter().filter_map(|item| match item {
            Item::Words(words) => Some(piece(words)),
            Item::Estimates(estimates) => Some(piece(&Words::Table(side_by_side(estimates)))),
            _ => None,
        });
        let items: Vec<String> = items.collect();
        let lead = paragraph(&section.lead);
        (!items.is_empty()).then(|| format!("{}\n\n{lead}\n{}", section.title, items.join("\n")))
    });
    texts.collect::<Vec<_>>().join("\n")
}

fn side_by_side(estimates: &Estimates) -> Table {
    let models = estimates
        .models
        .iter()
        .map(|(name, _)| Column::numbers(name));
    let mut columns = vec![Column::words("coefficient")];
    columns.extend(models.chain([Column::words("unit"), Column::numbers(&estimates.note_head)]));
    let rows = estimates.rows.iter().map(|row| {
        let values = row.values.iter().map(|one| match one.value.is_nan() {
            true => String::new(),
            false => format::estimate(one.value, one.sigma).join(" ± "),
        });
        let mut cells = vec![row.name.clone()];
        cells.extend(values.chain([row.unit.clone(), row.note.clone()]));
        cells
    });
    let mut table = Table::new(&estimates.title, columns, rows);
    if estimates.note_head.is_empty() {
        table.columns.pop();
    }
    table
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

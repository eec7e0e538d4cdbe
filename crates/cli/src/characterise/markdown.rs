//! Sections with tables as Markdown.

use std::fmt::Write as _;

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use gyrocal_document::{Item, Section, Words};

/// The page of the documentation: a table of each section, and how to read it.
pub(super) fn page(sections: &[Section], command: &str) -> String {
    let mut page = format!(
        "# Operating characteristics\n\nPrinted by `{command}`. \
         [characteristics.md](../characteristics.md) explains the figures.\n"
    );
    for section in sections {
        let Some(Item::Words(Words::Table(content))) = section.items.first() else {
            continue;
        };
        let heads = content.columns.iter().map(|column| &column.head);
        let mut table = Table::new();
        table
            .load_style(presets::ASCII_MARKDOWN)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(heads)
            .add_rows(
                content
                    .rows
                    .iter()
                    .map(|row| row.iter().map(|cell| &cell.text)),
            );
        for (cells, column) in table.column_iter_mut().zip(&content.columns) {
            if column.is_number {
                cells.set_cell_alignment(CellAlignment::Right);
            }
        }
        let (title, lead) = (&section.title, &section.lead);
        let _ = write!(page, "\n## {title}\n\n{table}\n\n{lead}\n");
    }
    page
}

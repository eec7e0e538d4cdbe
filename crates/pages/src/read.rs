//! What is read of an answer, for whoever draws no charts: a terminal, a notebook.

use gyrocal_document::{Column, Estimates, Item, List, Part, Screen, Section, Table, Words};
use gyrocal_statistics::format;

/// An answer: its first screen, then its sections.
#[must_use]
pub fn read(part: &Part) -> Vec<Words> {
    let mut words = of_screen(&part.first);
    words.extend(read_sections(&part.sections));
    words
}

/// Sections without charts and bars: title, lead and items of each that has others.
#[must_use]
pub fn read_sections(sections: &[Section]) -> Vec<Words> {
    let mut words = Vec::new();
    for section in sections {
        let items = section.items.iter().filter_map(|item| match item {
            Item::Words(words) => Some(words.clone()),
            Item::Estimates(estimates) => Some(Words::Table(side_by_side(estimates))),
            _ => None,
        });
        let items: Vec<Words> = items.collect();
        if !items.is_empty() {
            let heads = [&section.title, &section.lead];
            words.extend(heads.map(|text| Words::Paragraph(text.clone())));
            words.extend(items);
        }
    }
    words
}

fn of_screen(screen: &Screen) -> Vec<Words> {
    let facts = screen.facts.iter();
    let facts = facts.map(|fact| format!("{}: {}", fact.label, fact.words));
    let mut words = vec![Words::List(List {
        title: screen.headline(),
        entries: facts.collect(),
    })];
    words.extend(screen.table.clone().map(Words::Table));
    for next in &screen.next {
        words.push(Words::Paragraph(format!("Next, {}:", next.why)));
        words.push(Words::Command(next.command.clone()));
    }
    words
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

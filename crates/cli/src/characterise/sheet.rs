//! The tables of `gyrocal characterise`, for a terminal and as Markdown.

use std::fmt::Write as _;

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use gyrocal_evaluation::{CellReport, Characteristic};
use gyrocal_statistics::Proportion;

use crate::tables::{right, table};
use crate::text::paragraph;

/// Failed records that are shown; the JSON has all.
const FAILURES_SHOWN: usize = 5;

/// A table with its heading and explanation.
struct Sheet {
    heading: &'static str,
    words: &'static str,
    /// Number of columns with text, from the left; the others are numbers.
    text_columns: usize,
    header: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

/// All tables for a terminal.
pub(super) fn text(reports: &[CellReport]) -> String {
    let mut text = String::new();
    for sheet in sheets(reports) {
        let _ = writeln!(text, "{}\n", sheet.heading);
        let mut table = table(sheet.header.clone());
        for row in &sheet.rows {
            let cells = row.iter().enumerate().map(|(index, cell)| {
                if index < sheet.text_columns {
                    cell.into()
                } else {
                    right(cell)
                }
            });
            table.add_row(cells.collect::<Vec<comfy_table::Cell>>());
        }
        let _ = writeln!(text, "{}\n", table.trim_fmt());
        text.push_str(&paragraph(sheet.words));
        text.push('\n');
    }
    for report in reports {
        for failure in report.failures.iter().take(FAILURES_SHOWN) {
            let _ = writeln!(
                text,
                "{}, seed {}: {}",
                report.cell, failure.seed, failure.message
            );
        }
        if report.failures.len() > FAILURES_SHOWN {
            let more = report.failures.len() - FAILURES_SHOWN;
            let _ = writeln!(text, "{}: {more} more records failed", report.cell);
        }
    }
    text
}

/// All tables as Markdown.
pub(super) fn page(reports: &[CellReport], command: &str) -> String {
    let mut page = format!(
        "# Operating characteristics\n\nPrinted by `{command}`. \
         [characteristics.md](../characteristics.md) explains the figures.\n"
    );
    for sheet in sheets(reports) {
        let mut table = Table::new();
        table
            .load_style(presets::ASCII_MARKDOWN)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(sheet.header.clone());
        for row in &sheet.rows {
            table.add_row(row.clone());
        }
        for column in table.column_iter_mut().skip(sheet.text_columns) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let _ = write!(
            page,
            "\n## {}\n\n{table}\n\n{}\n",
            sheet.heading, sheet.words
        );
    }
    page
}

fn sheets(reports: &[CellReport]) -> Vec<Sheet> {
    [figures(reports), families(reports), comparison(reports)]
        .into_iter()
        .filter(|sheet| !sheet.rows.is_empty())
        .collect()
}

fn figures(reports: &[CellReport]) -> Sheet {
    let rows = reports.iter().flat_map(|report| {
        report.characteristics.iter().map(|figure| {
            vec![
                report.title.clone(),
                figure.figure.clone(),
                holds(figure).to_owned(),
                target(figure),
                figure
                    .measured
                    .map_or_else(String::new, |value| format!("{value:.3}")),
                interval(figure),
                figure.runs.to_string(),
                format!("{}..{}", figure.seeds[0], figure.seeds[1]),
            ]
        })
    });
    Sheet {
        heading: "Figures",
        words: "Intervals are 95 %. On fewer records than 1000 (clean: 2000), and for a family of \
                effects, a figure holds if its one-sided 95 % bound meets the target, and does not if \
                its 99.9 % bound misses it (of a family among all records: 95 %); otherwise the records \
                are too few to tell.",
        text_columns: 3,
        header: vec![
            "records", "figure", "holds", "target", "measured", "interval", "runs", "seeds",
        ],
        rows: rows.collect(),
    }
}

fn families(reports: &[CellReport]) -> Sheet {
    let rows = reports.iter().flat_map(|report| {
        report.families.iter().map(|row| {
            let of_detected = |hits| {
                share(Proportion {
                    hits,
                    trials: row.detected,
                })
            };
            vec![
                report.title.clone(),
                row.family.clone(),
                row.runs.to_string(),
                share(row.detected()),
                of_detected(row.in_set),
                of_detected(row.class_first),
                row.mean_set_size
                    .map_or_else(String::new, |size| format!("{size:.2}")),
            ]
        })
    });
    Sheet {
        heading: "By effect",
        words: "i, j, k stand for axes. Columns after the detections are proportions of the detections.",
        text_columns: 2,
        header: vec![
            "records",
            "effect",
            "runs",
            "detected, %",
            "set holds it, %",
            "class first, %",
            "set size",
        ],
        rows: rows.collect(),
    }
}

fn comparison(reports: &[CellReport]) -> Sheet {
    let mut rows = Vec::new();
    for report in reports.iter().filter(|report| report.comparison.len() > 1) {
        for row in &report.comparison {
            let of_detected = |hits: Option<u64>| {
                hits.map_or_else(String::new, |hits| share(row.of_detected(hits)))
            };
            rows.push(vec![
                report.title.clone(),
                row.method.clone(),
                row.runs.to_string(),
                share(row.detected()),
                of_detected(row.class_first),
                of_detected(row.all_named),
                of_detected(row.too_many),
                row.mean_names
                    .map_or_else(String::new, |names| format!("{names:.2}")),
            ]);
        }
    }
    Sheet {
        heading: "Comparison with baseline methods, on the same records",
        words: "Detected: the method reports a fault, on fault-free records a false alarm. The next \
                columns are proportions of the detections: the first name is of the right class; all \
                hidden effects are named (by gyrocal in a confidence set); more effects are named than \
                hidden. nis and ljung-box do not identify.",
        text_columns: 2,
        header: vec![
            "records",
            "method",
            "runs",
            "detected, %",
            "class first, %",
            "all named, %",
            "too many, %",
            "names",
        ],
        rows,
    }
}

fn share(of: Proportion) -> String {
    if of.trials == 0 {
        return String::new();
    }
    format!("{:.1}", 100.0 * of.share())
}

fn holds(figure: &Characteristic) -> &'static str {
    match figure.holds {
        Some(true) => "yes",
        Some(false) => "NO",
        None if figure.too_few => "too few records to tell",
        None => "",
    }
}

pub(super) fn target(figure: &Characteristic) -> String {
    figure
        .target
        .map_or_else(String::new, |target| target.to_string())
}

fn interval(figure: &Characteristic) -> String {
    figure
        .interval
        .map_or_else(String::new, |[low, high]| format!("{low:.3} to {high:.3}"))
}

//! Pages of figures, `docs/figures/TOPIC.md`: a section for each part, written by the night of figures and compared
//! with by the small version.

use std::path::PathBuf;

use gyrocal_statistics::Proportion;
use gyrocal_testkit::{timing, workspace};

use super::topic::Part;
use crate::error::Error;
use crate::figure::Figure;
pub(crate) use crate::page::commit;

/// Confidence of the intervals of a share, here and on the page, that must overlap: a hundred rows are
/// compared at once, and none is to differ by chance.
const CONFIDENCE: f64 = 0.999;

/// First words of the header of a table of figures.
const HEADER: [&str; 3] = ["figure", "target", "measured"];

/// Path of the page of a topic.
pub(crate) fn path(topic: &str) -> PathBuf {
    let page = workspace().join("docs/figures").join(topic);
    page.with_extension("md")
}

/// The section of a part: how it was measured, and its table.
pub(crate) fn section(part: &Part, command: &str, table: &str) -> Result<String, Error> {
    let (commit, sources) = (commit(&workspace()), part.sources.hash()?);
    let processor = timing::processor();
    let about = &part.about;
    Ok(format!(
        "{about}\n\nPrinted by `{command}` of commit {commit}, sources {sources}, on {processor}. Times and \
         ratios of times are those of that machine, and instruction counts those of its compiler. All else \
         differs by rounding at most: where the target fuses multiplication and addition, last bits differ.\n\n\
         {table}\n"
    ))
}

/// Renews the section of a part in the page of its topic. The other sections keep what they are: each says
/// which commit it was measured at. Sections stand in the order of `parts`.
///
/// # Errors
/// If the file cannot be read or written.
pub(crate) fn write_section(
    topic: &str,
    part: &str,
    parts: &[&str],
    body: &str,
) -> Result<(), Error> {
    let path = path(topic);
    let page = match std::fs::read_to_string(&path) {
        Ok(page) => page,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
        Err(error) => return Err(format!("{}: {error}", path.display()).into()),
    };
    let page = with_section(&page, topic, part, parts, body);
    gyrocal_record::write_whole(&path, page.as_bytes())?;
    Ok(())
}

/// A page with the section of a part replaced or added.
fn with_section(page: &str, topic: &str, part: &str, parts: &[&str], body: &str) -> String {
    let sections = page.split("\n## ").skip(1);
    let sections: Vec<(&str, &str)> = sections
        .filter_map(|section| section.split_once("\n\n"))
        .collect();
    let mut renewed = format!("# Figures: {topic}\n");
    for name in parts {
        let kept = sections.iter().find(|(heading, _)| heading == name);
        let body = match kept {
            _ if *name == part => body,
            Some((_, body)) => body.trim_end(),
            None => continue,
        };
        renewed = format!("{renewed}\n## {name}\n\n{}\n", body.trim_end());
    }
    renewed
}

/// Comparison of the figures of a small run with the committed page of the topic: each share of this run
/// must be consistent with that of the page. Rows that the page lacks are told as a note.
pub(crate) fn compared(topic: &str, figures: &[Figure]) -> Vec<Figure> {
    let name = format!("docs/figures/{topic}.md");
    let renewed_by = &format!("cargo figures night --topic {topic}");
    match std::fs::read_to_string(path(topic)) {
        Ok(text) => compared_with(&name, renewed_by, &rows(&text), figures),
        Err(_) => vec![Figure::note(
            &format!("{name}: the page"),
            format!("there is none: measure it with `{renewed_by}`"),
        )],
    }
}

/// Names of the rows on the page of a topic.
pub(crate) fn names(topic: &str) -> Vec<String> {
    let page = std::fs::read_to_string(path(topic)).unwrap_or_default();
    rows(&page).into_iter().map(|row| row.name).collect()
}

fn compared_with(page: &str, renewed_by: &str, rows: &[Row], figures: &[Figure]) -> Vec<Figure> {
    let mut lacking: Vec<&str> = Vec::new();
    let mut differing = Vec::new();
    let mut agreeing = 0;
    for figure in figures {
        let Some(row) = rows.iter().find(|row| row.name == figure.name) else {
            lacking.push(&figure.name);
            continue;
        };
        let (Some(here), Some(there)) = (figure.share, row.share()) else {
            continue;
        };
        if are_consistent(here, there) {
            agreeing += 1;
        } else {
            let of = |one: Proportion| format!("{:.3} of {}", one.share(), one.trials);
            let (name, here, there) = (&figure.name, of(here), of(there));
            differing.push(format!("`{name}` is {there} on the page and {here} here"));
        }
    }
    let mut result = Vec::new();
    let compared = agreeing + differing.len();
    if compared > 0 {
        let measured = match differing.as_slice() {
            [] => format!("{agreeing} of {compared}"),
            rows => format!("{agreeing} of {compared}: {}", rows.join("; ")),
        };
        let name = format!("{page}: shares of this run agree");
        let target = format!("{compared} of {compared}");
        let figure = Figure::told(&name, &target, measured, differing.is_empty());
        result.push(figure.over(compared, "rows"));
    }
    if let Some(first) = lacking.first() {
        let what = match lacking.len() {
            1 => format!("page lacks this row: `{first}`"),
            count => format!("page lacks {count} rows, the first `{first}`"),
        };
        let measured = format!("{what}: measure it again with `{renewed_by}`");
        result.push(Figure::note(&format!("{page}: its rows"), measured));
    }
    result
}

/// `true` if the exact intervals of both shares overlap.
fn are_consistent(one: Proportion, other: Proportion) -> bool {
    let ([low, high], [least, most]) = (one.interval(CONFIDENCE), other.interval(CONFIDENCE));
    low <= most && least <= high
}

/// A row of a committed table.
#[derive(Debug)]
struct Row {
    name: String,
    measured: String,
    runs: u64,
}

impl Row {
    /// The share that begins its measured value; `None` if it begins with none.
    fn share(&self) -> Option<Proportion> {
        let first = self.measured.split([' ', ',']).next()?;
        let number: f64 = first.parse().ok()?;
        let is_percent = self.name.contains(": % of ");
        let share = number / if is_percent { 100.0 } else { 1.0 };
        let is_share = (0.0..=1.0).contains(&share) && first.contains('.');
        is_share.then(|| Proportion {
            hits: (share * self.runs as f64).round() as u64,
            trials: self.runs,
        })
    }
}

/// The rows of the tables of figures of a page; other tables are passed over.
fn rows(page: &str) -> Vec<Row> {
    let cells = |line: &str| -> Vec<String> {
        let line = line.trim().trim_matches('|');
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut rows = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        let cells = cells(line);
        let is_header = cells.iter().zip(HEADER).all(|(cell, word)| cell == word);
        inside = (inside || (is_header && cells.len() > HEADER.len())) && line.starts_with('|');
        if let [name, _, measured, runs, ..] = cells.as_slice()
            && inside
            && let Ok(runs) = runs.parse()
        {
            let [name, measured] = [name, measured].map(String::clone);
            rows.push(Row {
                name,
                measured,
                runs,
            });
        }
    }
    rows
}

#[cfg(test)]
mod tests;

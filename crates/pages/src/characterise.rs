//! The page of operating characteristics.

mod screen;

use gyrocal_document::{List, Part, Section, Table};
use gyrocal_evaluation::{CellReport, CharacteriseReport, Characteristic};
use gyrocal_statistics::Proportion;
use gyrocal_words::counted;

use crate::origin::part;
use crate::words::section;

/// Failed records of a cell that are listed; the result for programs has all.
const FAILURES_SHOWN: usize = 5;

/// The page of operating characteristics.
#[must_use]
pub fn of_characterise(report: &CharacteriseReport) -> Part {
    let cells = &report.cells;
    let mut sections = vec![figures(cells)];
    sections.extend(families(cells));
    sections.extend(comparison(cells));
    sections.extend(failures(cells));
    let name = "operating characteristics".to_owned();
    let (size, first) = (counted(cells.len(), "cell"), screen::first(cells));
    part(&report.manifest, name, size, first, sections)
}

fn failures(reports: &[CellReport]) -> Option<Section> {
    let entries = reports.iter().flat_map(|report| {
        let first = report.failures.iter().take(FAILURES_SHOWN);
        let first = first.map(|one| format!("{}, seed {}: {}", report.cell, one.seed, one.message));
        let more = report.failures.len().saturating_sub(FAILURES_SHOWN);
        let more = (more > 0).then(|| format!("{}: {more} more records failed", report.cell));
        first.chain(more)
    });
    let lead = "Records on which the diagnosis failed.";
    let list = List::of("", entries)?.into();
    Some(section("failures", "Failed records", lead, vec![list]))
}

fn figures(reports: &[CellReport]) -> Section {
    let rows = reports.iter().flat_map(|report| {
        report.characteristics.iter().map(|figure| {
            vec![
                report.title.clone(),
                figure.figure.clone(),
                holds(figure).to_owned(),
                target(figure),
                measured(figure),
                interval(figure),
                figure.runs.to_string(),
                format!("{}..{}", figure.seeds[0], figure.seeds[1]),
            ]
        })
    });
    let heads = "records | figure | holds | > target | > measured | > interval | > runs | > seeds";
    let words = "Intervals are 95 %. On fewer records than 1000 (clean: 2000), and for a family of \
                effects, a figure holds if its one-sided 95 % bound meets the target, and does not if \
                its 99.9 % bound misses it (of a family among all records: 95 %); otherwise the records \
                are too few to tell.";
    let table = Table::of("", heads, rows);
    section("figures", "Figures", words, vec![table.into()])
}

fn families(reports: &[CellReport]) -> Option<Section> {
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
    let heads = "records | effect | > runs | > detected, % | > set holds it, % | > class first, % | > set size";
    let words =
        "i, j, k stand for axes. Columns after the detections are proportions of the detections.";
    let table = Table::of("", heads, rows).filled()?.into();
    Some(section("families", "By effect", words, vec![table]))
}

fn comparison(reports: &[CellReport]) -> Option<Section> {
    let compared = reports.iter().filter(|report| report.comparison.len() > 1);
    let rows = compared.flat_map(|report| {
        report.comparison.iter().map(|row| {
            let of_detected = |hits: Option<u64>| {
                hits.map_or_else(String::new, |hits| share(row.of_detected(hits)))
            };
            [
                report.title.clone(),
                row.method.clone(),
                row.runs.to_string(),
                share(row.detected()),
                of_detected(row.class_first),
                of_detected(row.all_named),
                of_detected(row.too_many),
                row.mean_names
                    .map_or_else(String::new, |names| format!("{names:.2}")),
            ]
        })
    });
    let heads = "records | method | > runs | > detected, % | > class first, % | > all named, % | > too many, % | > names";
    let words = "Detected: the method reports a fault, on fault-free records a false alarm. The next \
                columns are proportions of the detections: the first name is of the right class; all \
                hidden effects are named (by gyrocal in a confidence set); more effects are named than \
                hidden. nis and ljung-box do not identify.";
    let table = Table::of("", heads, rows).filled()?.into();
    let title = "Comparison with baseline methods, on the same records";
    Some(section("comparison", title, words, vec![table]))
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

fn target(figure: &Characteristic) -> String {
    figure
        .target
        .map_or_else(String::new, |target| target.to_string())
}

fn interval(figure: &Characteristic) -> String {
    let interval = figure.interval;
    interval.map_or_else(String::new, |[low, high]| format!("{low:.3} to {high:.3}"))
}

fn measured(figure: &Characteristic) -> String {
    let measured = figure.measured;
    measured.map_or_else(String::new, |value| format!("{value:.3}"))
}

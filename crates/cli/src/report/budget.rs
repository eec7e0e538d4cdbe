//! The words of uncertainty budgets.

use std::fmt::Write as _;

use comfy_table::Cell;
use gyrocal_diagnosis::{RecordUncertainty, UncertaintyResult, by_source};
use gyrocal_document::{Screen, Standing};
use gyrocal_statistics::format;

use crate::tables::{right, table};

/// The first screen of some budgets.
pub(super) fn screen(found: &UncertaintyResult) -> Screen {
    let what = match &found.spread {
        None => "95 % intervals of the coefficients".to_owned(),
        Some(spread) => format!("coefficients over {} runs", spread.runs),
    };
    let mut screen = Screen::new(Standing::Neutral, "UNCERTAINTY", what);
    if found.spread.is_none() {
        for one in found.records.iter().flat_map(|record| &record.coefficients) {
            let sources = by_source(one);
            let largest = sources.iter().max_by(|a, b| a.3.total_cmp(&b.3));
            screen.fact(
                &one.name,
                format!(
                    "{} {} (k = {}), most by {}",
                    format::with_sigma(one.estimate, one.expanded),
                    one.unit,
                    format::short(one.coverage_factor, 3),
                    largest.map_or("", |line| line.0),
                ),
            );
        }
    }
    if let Some(spread) = &found.spread {
        // Intervals of each run are in the tables: those of many do not fit on a screen.
        for one in &spread.coefficients {
            let [mean, expected] = format::estimate(one.mean, one.expected);
            screen.fact(
                &one.name,
                format!(
                    "mean {mean} {}, deviation {} ({expected} expected)",
                    one.unit,
                    format::short(one.standard_deviation, 2),
                ),
            );
        }
        let larger = spread.coefficients.iter().filter(|one| one.is_larger);
        let names: Vec<&str> = larger.map(|one| one.name.as_str()).collect();
        let words = match names.is_empty() {
            true => "consistent with the uncertainties".to_owned(),
            false => format!("larger than the uncertainties: {}", names.join(", ")),
        };
        screen.fact("scatter", format!("of {} runs {words}", spread.runs));
    }
    screen
}

/// All contributions, and the scatter over runs.
pub(super) fn text(found: &UncertaintyResult) -> String {
    let mut text: String = found.records.iter().map(of_record).collect();
    if let Some(spread) = &found.spread {
        let _ = writeln!(text, "Scatter over {} runs of one platform.", spread.runs);
        let mut rows = table([
            "term",
            "coefficient",
            "mean",
            "deviation",
            "expected",
            "p",
            "scatter",
            "unit",
        ]);
        for one in &spread.coefficients {
            rows.add_row([
                Cell::new(&one.term),
                Cell::new(&one.name),
                right(format::short(one.mean, 5)),
                right(format::short(one.standard_deviation, 2)),
                right(format::short(one.expected, 2)),
                right(format::short(one.p_value, 2)),
                Cell::new(one.answer()),
                Cell::new(&one.unit),
            ]);
        }
        let _ = writeln!(text, "{rows}\n");
    }
    text + &found.not_stated + "\n"
}

fn of_record(record: &RecordUncertainty) -> String {
    let mut text = format!(
        "Uncertainty budget (GUM) of {}: {} accelerometer values, mean normalised innovation squared of a \
         value {:.3}, {} of model.\n",
        record.name,
        record.accelerometer_values,
        record.nis_of_value,
        match record.models.len() {
            1 => "no choice".to_owned(),
            some => format!("choice among {some}"),
        },
    );
    let mut rows = table(["coefficient", "source", "type", "distribution", "standard"]);
    for one in &record.coefficients {
        for (source, kind, distribution, standard) in by_source(one) {
            rows.add_row([
                Cell::new(format!("{} {}", one.term, one.name)),
                Cell::new(source),
                Cell::new(kind.letter()),
                Cell::new(distribution),
                right(format!("{} {}", format::short(standard, 2), one.unit)),
            ]);
        }
    }
    let _ = writeln!(text, "{rows}\n");
    text
}

//! The sections of an uncertainty budget, and of the scatter over runs.

use gyrocal_diagnosis::{
    CoefficientUncertainty, NOT_STATED, RecordUncertainty, RunSpread, by_source,
};
use gyrocal_document::{Cell, Column, Item, Section, Table};
use gyrocal_statistics::format;

use crate::diagnosis::section;

/// The budget of each coefficient: a table of the results, one of the contributions, one of the conditions
/// of the test.
#[must_use]
pub fn of_budget(budget: &RecordUncertainty) -> Section {
    let results = Table {
        title: "Results".to_owned(),
        columns: columns(
            &["term", "coefficient"],
            &[
                "estimate",
                "standard uncertainty",
                "effective degrees of freedom",
                "coverage factor",
                "expanded, 95 %",
            ],
            &["unit"],
        ),
        rows: budget.coefficients.iter().map(result_row).collect(),
    };
    let names: Vec<&str> = budget
        .coefficients
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let sources = budget
        .coefficients
        .first()
        .map_or(0, |one| by_source(one).len());
    let contributions = Table {
        title: "Contributions, each as a standard uncertainty in the unit of its coefficient"
            .to_owned(),
        columns: columns(&["source", "type", "distribution"], &names, &[]),
        rows: (0..sources).map(|line| source_row(budget, line)).collect(),
    };
    let mut lead = format!(
        "Combined by the GUM (JCGM 100:2008). Type A is evaluated from the record, type B from what the \
         bench description declares. {NOT_STATED}"
    );
    if budget.models.len() > 1 {
        lead += &format!(
            " The estimates are means over {} models that the record leaves open.",
            budget.models.len()
        );
    }
    section(
        "uncertainty",
        "Uncertainty",
        &lead,
        vec![
            Item::from(results),
            Item::from(contributions),
            Item::from(conditions(budget)),
        ],
    )
}

/// The scatter of the coefficients over runs.
#[must_use]
pub fn of_spread(spread: &RunSpread) -> Section {
    let rows = spread.coefficients.iter().map(|one| {
        let [mean, _] = format::estimate(one.mean, one.standard_deviation);
        [
            one.term.clone(),
            one.name.clone(),
            mean,
            format!("{:.2e}", one.standard_deviation),
            format!("{:.2e}", one.expected),
            format!("{:.2}", one.p_value),
            one.answer().to_owned(),
            one.unit.clone(),
        ]
        .map(Cell::from)
        .to_vec()
    });
    let table = Table {
        title: format!("Scatter over {} runs", spread.runs),
        columns: columns(
            &["term", "coefficient"],
            &[
                "mean",
                "standard deviation between runs",
                "expected of the uncertainties",
                "p",
            ],
            &["scatter", "unit"],
        ),
        rows: rows.collect(),
    };
    section(
        "spread",
        "Scatter over runs",
        "Each record is a run of the same platform. The scatter is larger where noise, attitude and declared \
         turn-on scatter do not explain it, by a chi-square test with a false alarm of 1 % for all \
         coefficients together.",
        vec![Item::from(table)],
    )
}

/// Columns of words, of numbers, and again of words.
fn columns(words: &[&str], numbers: &[&str], last: &[&str]) -> Vec<Column> {
    let of = |heads: &[&str], is_number| -> Vec<Column> {
        let heads = heads.iter().map(|head| Column {
            head: (*head).to_owned(),
            is_number,
        });
        heads.collect()
    };
    [of(words, false), of(numbers, true), of(last, false)].concat()
}

fn result_row(one: &CoefficientUncertainty) -> Vec<Cell> {
    let degrees = match one.effective_degrees_of_freedom {
        Some(few) if few < 1e6 => format!("{few:.0}"),
        _ => "∞".to_owned(),
    };
    let [estimate, _] = format::estimate(one.estimate, one.combined);
    [
        one.term.clone(),
        one.name.clone(),
        estimate,
        format!("{:.2e}", one.combined),
        degrees,
        format::short(one.coverage_factor, 3),
        format!("{:.2e}", one.expanded),
        one.unit.clone(),
    ]
    .map(Cell::from)
    .to_vec()
}

fn source_row(budget: &RecordUncertainty, line: usize) -> Vec<Cell> {
    let mut row = Vec::new();
    for one in &budget.coefficients {
        let sources = by_source(one);
        let Some((source, kind, distribution, standard)) = sources.get(line) else {
            continue;
        };
        if row.is_empty() {
            row.extend([*source, kind.letter(), *distribution].map(|it| Cell::from(it.to_owned())));
        }
        row.push(Cell::from(match *standard {
            0.0 => "0".to_owned(),
            some => format!("{some:.1e}"),
        }));
    }
    row
}

/// Conditions of the test.
fn conditions(budget: &RecordUncertainty) -> Table {
    let of = &budget.conditions;
    let mut rows = vec![
        ("record", budget.name.clone()),
        ("bench", of.bench.clone()),
        ("astronomic latitude", format!("{}°", of.latitude_deg)),
        (
            "specific force at rest",
            format!("{} g", of.specific_force_at_rest_g),
        ),
        (
            "duration, rows",
            format!("{:.2} h, {}", of.duration_h, of.rows),
        ),
        (
            "declared noise of accelerometers, of gyros",
            format!(
                "{:e} g, {} deg/h",
                of.accel_noise_g, of.gyro_noise_deg_per_h
            ),
        ),
    ];
    rows.push((
        "initial angles",
        of.initial_angles_deg
            .map_or("not declared".to_owned(), |[x, y, z]| {
                format!("{x:.4}°, {y:.4}°, {z:.4}°")
            }),
    ));
    rows.push((
        "temperature",
        of.temperature_c
            .map_or("not logged".to_owned(), |[low, high]| {
                format!("{low:.2} °C to {high:.2} °C")
            }),
    ));
    Table {
        title: "Test conditions".to_owned(),
        columns: columns(&["condition", "value"], &[], &[]),
        rows: rows
            .into_iter()
            .map(|(name, value)| vec![Cell::from(name.to_owned()), Cell::from(value)])
            .collect(),
    }
}

//! The section of an uncertainty budget.

use gyrocal_calibration::{CoefficientBudget, UncertaintyBudget};
use gyrocal_report::page::{Cell, Column, Item, Section, Table};
use gyrocal_statistics::format;

use crate::diagnosis::section;

/// The budget of each coefficient: a table of the results, and one of the contributions.
#[must_use]
pub fn of_budget(budget: &UncertaintyBudget) -> Section {
    let column = |head: &str, is_number| Column {
        head: head.to_owned(),
        is_number,
    };
    let results = Table {
        title: "Results".to_owned(),
        columns: vec![
            column("coefficient", false),
            column("estimate", true),
            column("standard uncertainty", true),
            column("degrees of freedom", true),
            column("coverage factor", true),
            column("expanded, 95 %", true),
            column("unit", false),
        ],
        rows: budget.coefficients.iter().map(result_row).collect(),
    };
    let mut columns = vec![column("source", false), column("type", false)];
    columns.extend(budget.coefficients.iter().map(|one| column(one.id, true)));
    let sources = budget
        .coefficients
        .first()
        .map_or(0, |one| one.contributions.len());
    let contributions = Table {
        title: "Contributions, each as a standard uncertainty in the unit of its coefficient"
            .to_owned(),
        columns,
        rows: (0..sources).map(|line| source_row(budget, line)).collect(),
    };
    section(
        "uncertainty",
        "Uncertainty",
        "Combined by the GUM (JCGM 100:2008). Type A is evaluated from the record, type B from what the bench \
         description declares. Only a laboratory certifies.",
        vec![Item::Table(results), Item::Table(contributions)],
    )
}

fn result_row(one: &CoefficientBudget) -> Vec<Cell> {
    let degrees = match one.degrees_of_freedom {
        many if many > 1e6 => "∞".to_owned(),
        few => format!("{few:.0}"),
    };
    [
        one.id.to_owned(),
        format!("{:.3e}", one.estimate),
        format!("{:.2e}", one.combined),
        degrees,
        format::short(one.coverage_factor, 3),
        format!("{:.2e}", one.expanded()),
        one.unit.to_owned(),
    ]
    .map(Cell::from)
    .to_vec()
}

fn source_row(budget: &UncertaintyBudget, line: usize) -> Vec<Cell> {
    let first = budget
        .coefficients
        .first()
        .and_then(|one| one.contributions.get(line));
    let mut row = vec![
        Cell::from(first.map_or("", |it| it.source.name()).to_owned()),
        Cell::from(
            first
                .map_or("", |it| if it.source.is_type_a() { "A" } else { "B" })
                .to_owned(),
        ),
    ];
    row.extend(budget.coefficients.iter().map(|one| {
        let standard = one.contributions.get(line).map_or(0.0, |it| it.standard);
        Cell::from(match standard {
            0.0 => "0".to_owned(),
            some => format!("{some:.1e}"),
        })
    }));
    row
}

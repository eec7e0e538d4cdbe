//! The page of a multi-position test with many stops.

mod charts;

use gyrocal_document::{
    Cell, Column, EstimateRow, Estimates, Item, Part, Screen, Section, Table, Tint, ValueWithSigma,
};
use gyrocal_instruments::multi_position::{MultiPositionReport, PreparedTest};
use gyrocal_record::Manifest;
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};
use crate::words::listed;
use charts::{contributions, residuals};

/// The page of a multi-position test with its first screen.
#[must_use]
pub fn of_tumble(
    manifest: &Manifest,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
    first: Screen,
) -> Part {
    let mut sections = vec![section(
        "residual",
        "Residual at the stops",
        "Gyro output less drift law at each static stop, before and after the terms that the search added.",
        vec![Item::Chart(residuals(prepared, report))],
    )];
    if !report.findings.is_empty() {
        sections.push(section(
            "terms",
            "Terms that the nominal law lacks",
            "Gyro output less all other terms of the extended law, against the regressor of the term: a \
             line through the points is the term.",
            vec![Item::Chart(contributions(prepared, report)), Item::from(findings(report))],
        ));
    }
    sections.push(laws(report));
    sections.push(controls(report));
    Part {
        name: file_name(manifest, 0, "log"),
        size: format!("{} static stops", report.stops),
        first,
        sections,
        origin: origin(manifest),
    }
}

fn findings(report: &MultiPositionReport) -> Table {
    let rows = report.findings.iter().map(|one| {
        let [estimate, sigma] = format::estimate(one.estimate, one.sigma);
        vec![
            Cell::from(one.effect.clone()),
            Cell::from(format!("{estimate} ± {sigma}").replace('-', "−")),
            Cell::from(one.unit.clone()),
            Cell::from(format!("{:.1}", one.estimate.abs() / one.sigma)),
            Cell::from(format::p_cell(one.p_value)),
        ]
    });
    Table {
        title: "Significant terms, in the order of finding".to_owned(),
        columns: vec![
            Column::words("term"),
            Column::numbers("estimate ± σ"),
            Column::words("unit"),
            Column::numbers("sigmas"),
            Column::numbers("p, family-wise"),
        ],
        rows: rows.collect(),
    }
}

/// Nominal and extended law of each gyro.
fn laws(report: &MultiPositionReport) -> Section {
    let mut rows = Vec::new();
    for gyro in &report.gyros {
        for one in &gyro.extended.coefficients {
            let mut nominal = gyro.nominal.coefficients.iter();
            let before = nominal.find(|before| before.name == one.name);
            rows.push(EstimateRow {
                name: one.name.clone(),
                unit: one.unit.clone(),
                values: vec![
                    ValueWithSigma {
                        value: before.map_or(f64::NAN, |before| before.estimate),
                        sigma: before.map_or(f64::NAN, |before| before.sigma),
                    },
                    ValueWithSigma {
                        value: one.estimate,
                        sigma: one.sigma,
                    },
                ],
                note: String::new(),
                strong: false,
            });
        }
    }
    let undetermined = report
        .gyros
        .iter()
        .filter(|gyro| !gyro.undetermined.is_empty());
    let undetermined = undetermined.map(|gyro| {
        let names = gyro.undetermined.join(", ");
        Item::text(format!(
            "{}: not identifiable from these attitudes: {names}.",
            gyro.gyro
        ))
    });
    let mut items = vec![Item::Estimates(Estimates {
        title: "Drift laws; sigmas include the scatter beyond the standard errors".to_owned(),
        models: vec![
            ("nominal law".to_owned(), Tint::Nominal),
            ("extended law".to_owned(), Tint::Extended),
        ],
        rows,
        note_head: String::new(),
    })];
    items.extend(undetermined);
    section(
        "laws",
        "Drift laws",
        "Coefficients of each gyro in the nominal law and in the one with the terms found.",
        items,
    )
}

fn control_sentences(report: &MultiPositionReport) -> Vec<String> {
    let controls = &report.controls;
    let mut sentences = vec![format!(
        "In {} data sets with permuted stops the search finds something in {}.",
        controls.shuffles, controls.shuffles_with_findings
    )];
    sentences.push(
        match controls.renamed_as_expected {
            true => "With renamed axes it finds the same under the new names.",
            false => "With renamed axes it finds something else: the search depends on names.",
        }
        .to_owned(),
    );
    if !report.not_confirmed.is_empty() {
        let names: Vec<&str> = report.not_confirmed.iter().map(String::as_str).collect();
        sentences.push(format!(
            "Significant, but no gain on held-out stops: {}.",
            listed(&names)
        ));
    }
    sentences
}

fn controls(report: &MultiPositionReport) -> Section {
    let mut items: Vec<Item> = control_sentences(report)
        .into_iter()
        .map(Item::text)
        .collect();
    if let Some(found) = &report.cross_validation {
        let rows = found
            .found_in_blocks
            .iter()
            .map(|(term, count)| [term.clone(), format!("{count} of {}", found.blocks)]);
        items.push(Item::from(Table::new(
            "Terms found without a block",
            vec![Column::words("term"), Column::numbers("found in")],
            rows,
        )));
    }
    section(
        "controls",
        "Controls",
        "What the search finds in stops that are permuted, and how often it finds each term when a block of stops is \
         held out.",
        items,
    )
}

//! The page of a multi-position test with many stops.

mod charts;

use gyrocal_instruments::multi_position::{MultiPositionReport, PreparedTest};
use gyrocal_record::{AXES, Manifest};
use gyrocal_report::page::{
    Card, Cell, Column, EstimateRow, Estimates, Item, Part, Section, Summary, Table, Tint, Tone,
    ValueWithSigma,
};
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};
use crate::words::listed;
use charts::{contributions, residuals};

/// Findings named on the first screen.
const SHOWN: usize = 8;

/// The page of a multi-position test.
#[must_use]
pub fn of_tumble(
    manifest: &Manifest,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
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
            vec![Item::Chart(contributions(prepared, report)), Item::Table(findings(report))],
        ));
    }
    sections.push(laws(report));
    sections.extend(controls(report));
    Part {
        name: file_name(manifest, 0, "log"),
        size: format!("{} static stops", report.stops),
        summary: summary(report),
        sections,
        origin: origin(manifest),
    }
}

fn summary(report: &MultiPositionReport) -> Summary {
    let [before, after] = report
        .residual_rms_deg_per_h()
        .map(|rms| format::short(rms, 2));
    let (tone, headline, sentence) = match report.findings.len() {
        0 => (
            Tone::Good,
            "The nominal drift law holds".to_owned(),
            format!("No term of the catalogue is significant; residual {before} deg/h rms."),
        ),
        count => (
            Tone::Found,
            format!("The nominal drift law lacks {count} terms"),
            format!(
                "Residual at the stops {before} deg/h rms with the nominal law, {after} deg/h with the \
                 extended one."
            ),
        ),
    };
    let mut cards = Vec::new();
    if !report.findings.is_empty() {
        let mut table = findings(report);
        table.title = String::new();
        table.rows.truncate(SHOWN);
        cards.push(Card {
            title: "Causes".to_owned(),
            table: Some(table),
            columns: 8,
            ..Card::default()
        });
    }
    cards.push(gain(report, &before, &after));
    cards.push(alternatives(report));
    cards.push(Card {
        title: "Controls".to_owned(),
        text: control_sentences(report),
        columns: 6,
        ..Card::default()
    });
    Summary {
        tone,
        headline,
        sentence,
        cards,
    }
}

fn gain(report: &MultiPositionReport, before: &str, after: &str) -> Card {
    let mut text = Vec::new();
    if let Some(found) = &report.cross_validation {
        text.push(format!(
            "{:+.1} ± {:.1} nats on held-out stops, in {} blocks of {}",
            found.cross_validated_log_score_nats,
            found.standard_error_nats,
            found.blocks,
            found.left_out
        ));
        for (axis, name) in AXES.iter().enumerate() {
            text.push(format!(
                "gyro {}: prediction error {} → {} deg/h, standard error of a stop {}",
                name,
                format::short(found.rms_before_deg_per_h[axis], 2),
                format::short(found.rms_after_deg_per_h[axis], 2),
                format::short(found.noise_deg_per_h[axis], 2)
            ));
        }
    }
    Card {
        title: "Gain".to_owned(),
        main: match report.findings.len() {
            0 => format!("{before} deg/h"),
            _ => format!("{before} → {after} deg/h"),
        },
        number: "residual at the stops, rms".to_owned(),
        text,
        columns: 4,
        ..Card::default()
    }
}

fn alternatives(report: &MultiPositionReport) -> Card {
    let entries = report
        .findings
        .iter()
        .filter(|one| !one.alternatives.is_empty());
    let mut text: Vec<String> = entries
        .map(|one| {
            let others: Vec<&str> = one
                .alternatives
                .iter()
                .map(|other| &*other.effect)
                .collect();
            format!("{}: {}", one.effect, listed(&others))
        })
        .collect();
    let mut main = String::new();
    if text.is_empty() {
        main = match report.findings.is_empty() {
            true => "Nothing was found".to_owned(),
            false => "No other term of the catalogue".to_owned(),
        };
        if !report.findings.is_empty() {
            text.push("Every other term is excluded in place of each of them.".to_owned());
        }
    }
    text.push(
        "Not distinguishable in any such test: squares along all three axes and the bias, which sum to \
         1 g²."
            .to_owned(),
    );
    Card {
        title: "What else it might be".to_owned(),
        main,
        text,
        columns: 6,
        ..Card::default()
    }
}

fn column(head: &str, is_number: bool) -> Column {
    Column {
        head: head.to_owned(),
        is_number,
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
            column("term", false),
            column("estimate ± σ", true),
            column("unit", false),
            column("sigmas", true),
            column("p, family-wise", true),
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
        Item::Text(format!(
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

fn controls(report: &MultiPositionReport) -> Option<Section> {
    let found = report.cross_validation.as_ref()?;
    let rows = found.found_in_blocks.iter().map(|(term, count)| {
        vec![
            Cell::from(term.clone()),
            Cell::from(format!("{count} of {}", found.blocks)),
        ]
    });
    Some(section(
        "controls",
        "Held-out stops",
        "How often the search finds each term when a block of stops is held out.",
        vec![Item::Table(Table {
            title: "Terms found without a block".to_owned(),
            columns: vec![column("term", false), column("found in", true)],
            rows: rows.collect(),
        })],
    ))
}

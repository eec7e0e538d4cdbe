//! Sets, parameters, records and gain of a plant in tables.

use gyrocal_plant::Diagnosed;
use gyrocal_plant::answer::{Diagnosis, Estimate, Found, OutputError};
use gyrocal_report::page::{
    Cell, Column, EstimateRow, Estimates, Item, Section, Table, Tint, ValueWithSigma,
};
use gyrocal_statistics::format;

use super::{over_time, with_unit};
use crate::diagnosis::section;
use crate::panels;

fn word(head: &str) -> Column {
    Column {
        head: head.to_owned(),
        is_number: false,
    }
}

fn number(head: &str) -> Column {
    Column {
        head: head.to_owned(),
        is_number: true,
    }
}

/// Each finding with its set; `None` if nothing was found.
pub(super) fn sets(answer: &Diagnosis) -> Option<Section> {
    if !answer.has_findings() {
        return None;
    }
    let mut items: Vec<Item> = answer
        .findings
        .iter()
        .map(|one| Item::Table(set(one)))
        .collect();
    let unexplained = answer.unexplained.iter();
    items.extend(unexplained.map(|one| Item::Text(one.sentence())));
    Some(section(
        "sets",
        "Sets",
        "The set is the result, not the first name: each effect of it explains the record about as well.",
        items,
    ))
}

fn set(found: &Found) -> Table {
    let sizes: Vec<String> = found.sizes.iter().map(|size| size.words()).collect();
    let named = [
        found.effect.clone(),
        found.name.clone(),
        sizes.join(", "),
        "named".to_owned(),
    ];
    let rival = |(id, deficit): &(String, f64)| {
        let lacks = format!("{deficit:.1}");
        [id.clone(), String::new(), lacks, "in the set".to_owned()]
    };
    let equal = |id: &String| {
        let same = "no record tells it from the named one".to_owned();
        [id.clone(), String::new(), "0".to_owned(), same]
    };
    let rivals = found.rivals.iter().map(rival);
    let equivalents = found.equivalents.iter().map(equal);
    let rows = rivals.chain(equivalents);
    let rows = core::iter::once(named.map(Cell::from).to_vec())
        .chain(rows.map(|row| row.map(Cell::from).to_vec()));
    Table {
        title: match found.rivals.len() + found.equivalents.len() {
            0 => format!("{}: its set has no other effect", found.effect),
            count => format!("{} and {count} more in its set", found.effect),
        },
        columns: vec![
            word("effect"),
            word("meaning"),
            number("size, or nats less likely"),
            word("place"),
        ],
        rows: rows.collect(),
    }
}

/// Parameters, and initial states of a record that is alone.
pub(super) fn parameters(answer: &Diagnosis) -> Section {
    section(
        "parameters",
        "Parameters",
        "Estimates with their standard deviations.",
        vec![Item::Estimates(estimates(
            "Parameters of the nominal model and with all findings",
            &answer.parameters,
            answer.has_findings(),
        ))],
    )
}

fn estimates(title: &str, all: &[Estimate], has_findings: bool) -> Estimates {
    let mut models = vec![(panels::NOMINAL.to_owned(), Tint::Nominal)];
    if has_findings {
        models.push((panels::EXTENDED.to_owned(), Tint::Extended));
    }
    let rows = all.iter().map(|one| {
        let nominal = ValueWithSigma {
            value: one.nominal,
            sigma: one.nominal_sigma,
        };
        let extended = ValueWithSigma {
            value: one.value,
            sigma: one.sigma,
        };
        EstimateRow {
            name: one.name.clone(),
            unit: one.unit.clone(),
            values: [nominal, extended].into_iter().take(models.len()).collect(),
            note: format::short(one.declared, 4).replace('-', "−"),
            strong: false,
        }
    });
    Estimates {
        title: title.to_owned(),
        rows: rows.collect(),
        models,
        note_head: "declared".to_owned(),
    }
}

/// Each of several records; `None` of one.
pub(super) fn records(answer: &Diagnosis) -> Option<Section> {
    if answer.records.is_empty() {
        return None;
    }
    let rows = answer.records.iter().map(|one| {
        let cells = [
            one.name.clone(),
            one.rows.to_string(),
            format::short(one.duration_s, 4),
            one.alone.verdict.clone(),
        ];
        cells.map(Cell::from).to_vec()
    });
    let mut items = vec![Item::Table(Table {
        title: "Each record alone".to_owned(),
        columns: vec![
            word("record"),
            number("rows"),
            number("duration, s"),
            word("verdict alone"),
        ],
        rows: rows.collect(),
    })];
    for one in &answer.records {
        items.push(Item::Table(error_table(
            format!(
                "{}: open-loop error with the models of all records",
                one.name
            ),
            &one.errors,
            answer.has_findings(),
        )));
        let title = format!("Initial states of {}", one.name);
        let own = estimates(&title, &one.initial, answer.has_findings());
        items.push(Item::Estimates(own));
    }
    Some(section(
        "records",
        "Records",
        "Parameters and effects are those of all records together, initial states those of each.",
        items,
    ))
}

fn error_table(title: String, errors: &[OutputError], has_findings: bool) -> Table {
    let mut columns = vec![word("output"), number("nominal model, rms")];
    if has_findings {
        columns.push(number("with what was found, rms"));
    }
    let count = columns.len();
    let rows = errors.iter().map(|error| {
        let cells = [
            error.output.clone(),
            with_unit(error.nominal, &error.unit),
            with_unit(error.extended, &error.unit),
        ];
        cells.into_iter().take(count).map(Cell::from).collect()
    });
    Table {
        title,
        rows: rows.collect(),
        columns,
    }
}

/// The gain in the record and on a later one; `None` if nothing was found.
pub(super) fn gain(diagnosed: &Diagnosed) -> Option<Section> {
    let answer = &diagnosed.answer;
    if !answer.has_findings() {
        return None;
    }
    let horizon = |horizon_s: f64| format!("simulated over {} s", format::short(horizon_s, 4));
    let mut items = vec![Item::Table(error_table(
        format!(
            "Open-loop error in the diagnosed data, {}",
            horizon(answer.horizon_s)
        ),
        &answer.errors,
        true,
    ))];
    match (&answer.later_record, &diagnosed.later) {
        (Some(later), Some(series)) => {
            items.push(Item::Text(later.sentence(true)));
            let title = format!(
                "{:+.1} nats of predictive log score in the later record",
                later.gain_nats
            );
            let title = title.replace('-', "−");
            let whole = diagnosed.is_simulated_whole();
            items.push(Item::Chart(over_time::residual(title, series, whole)));
            items.push(Item::Table(error_table(
                format!(
                    "Open-loop error in the later record, {}",
                    horizon(later.horizon_s)
                ),
                &later.errors,
                true,
            )));
        }
        _ => items.push(Item::Text(
            "No later record was given: --validate LATER.csv measures the gain where nothing was fitted."
                .to_owned(),
        )),
    }
    Some(section(
        "gain",
        "Gain",
        "What the extended model predicts better than the nominal one.",
        items,
    ))
}

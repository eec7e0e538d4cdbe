//! Sets, parameters, records and gain of a plant in tables.

use gyrocal_answer::{AlternativeKind, Answer, Coefficients, Finding, OutputError};
use gyrocal_document::{Column, EstimateRow, Estimates, Item, Section, Table, Tint};
use gyrocal_plant::Diagnosed;
use gyrocal_statistics::format;

use super::{over_time, rms};
use crate::panels;
use crate::words::section;

/// Each finding with its set; `None` if nothing was found.
pub(super) fn sets(answer: &Answer) -> Option<Section> {
    if !answer.has_findings() {
        return None;
    }
    let mut items: Vec<Item> = answer
        .findings
        .iter()
        .map(|one| Item::from(set(answer, one)))
        .collect();
    let unmodelled = answer.remainder.unmodelled.iter();
    items.extend(unmodelled.map(|one| Item::text(gyrocal_words::plant::unmodelled(one))));
    let lead = "The set is the result, not the first name: each effect of it explains the record about as well.";
    Some(section("sets", "Sets", lead, items))
}

/// The way from the nominal model to that with all findings; `None` where the likelihood judged alone.
pub(super) fn path(answer: &Answer) -> Option<Section> {
    let steps = answer.path.iter().flat_map(|step| {
        let model = step.effect.as_ref();
        let model = model.map_or_else(
            || panels::NOMINAL.to_owned(),
            |effect| format!("+ {effect}"),
        );
        let stands = step.refused.map_or("stands", gyrocal_words::plant::why);
        let row = move |error: &gyrocal_answer::PathError| {
            [
                model.clone(),
                error.output.clone(),
                rms(error.left_out, &error.unit),
                error
                    .later
                    .map_or_else(String::new, |later| rms(Some(later), &error.unit)),
                stands.to_owned(),
            ]
        };
        step.outputs.iter().map(row)
    });
    let heads = "model | output | > left-out parts, rms | > later record, rms | effect";
    let table = Table::of(
        "Each effect beside those before it that stand",
        heads,
        steps,
    );
    let words =
        "Open-loop simulations of four parts of the record, each left out of the fit in its turn.";
    let items = vec![Item::from(table)];
    (!answer.path.is_empty()).then(|| section("path", "Left-out parts", words, items))
}

fn set(answer: &Answer, found: &Finding) -> Table {
    let sizes: Vec<String> = found
        .parameters
        .iter()
        .map(gyrocal_words::plant::parameter)
        .collect();
    let named = [
        found.effect.clone(),
        found.name.clone(),
        sizes.join(", "),
        "named".to_owned(),
    ];
    let others = found.alternatives.iter().map(|other| {
        let lacks = other.log_likelihood_deficit;
        let lacks = lacks.map_or_else(String::new, |nats| format!("{nats:.1}"));
        let place = match other.kind {
            AlternativeKind::ExactEquivalent => "no record tells it from the named one",
            AlternativeKind::NotExcluded => "in the set",
            _ => "not searched",
        };
        [other.effect.clone(), String::new(), lacks, place.to_owned()]
    });
    let title = match found.alternatives.len() {
        0 if answer.is_settled() => format!("{}: its set has no other effect", found.effect),
        0 => format!("{}: no other effect of what was compared", found.effect),
        count => format!("{} and {count} more in its set", found.effect),
    };
    let heads = "effect | meaning | > size, or nats less likely | place";
    Table::of(&title, heads, [named].into_iter().chain(others))
}

/// Parameters, and initial states of a record that is alone; `None` without a fit.
pub(super) fn parameters(answer: &Answer) -> Option<Section> {
    let all = answer.coefficients.as_ref()?;
    let lead = "Estimates with their standard deviations.";
    let items = vec![Item::Estimates(estimates(
        "Parameters of the nominal model and with all findings",
        all,
    ))];
    Some(section("parameters", "Parameters", lead, items))
}

pub(super) fn estimates(title: &str, all: &Coefficients) -> Estimates {
    let mut models = vec![(panels::NOMINAL, Tint::Nominal)];
    if all.extended.is_some() {
        models.push((panels::EXTENDED, Tint::Extended));
    }
    let pairs = all.nominal.iter().zip(all.best());
    let rows = all.declared.iter().zip(pairs);
    let rows = rows.map(|(declared, (nominal, extended))| {
        let values = [nominal, extended].map(|one| [one.estimate, one.sigma]);
        let values = values.into_iter().take(models.len());
        EstimateRow {
            note: format::short(*declared, 4).replace('-', "−"),
            ..EstimateRow::new(&nominal.name, &nominal.unit, values)
        }
    });
    Estimates {
        note_head: "declared".to_owned(),
        ..Estimates::new(title, &models, rows)
    }
}

/// Each of several records; `None` of one.
pub(super) fn records(answer: &Answer) -> Option<Section> {
    if answer.records.is_empty() {
        return None;
    }
    let rows = answer.records.iter().map(|one| {
        [
            one.name.clone(),
            one.record.rows.to_string(),
            format::short(one.record.duration_s, 4),
            gyrocal_words::plant::alone(one),
        ]
    });
    let heads = "record | > rows | > duration, s | verdict alone";
    let mut items = vec![Item::from(Table::of("Each record alone", heads, rows))];
    for one in &answer.records {
        let title = format!(
            "{}: open-loop error with the models of all records",
            one.name
        );
        let table = error_table(&title, &one.open_loop, answer.has_findings());
        items.push(Item::from(table));
        let title = format!("Initial states of {}", one.name);
        let initial = one.initial.iter();
        items.extend(initial.map(|all| Item::Estimates(estimates(&title, all))));
    }
    let lead =
        "Parameters and effects are those of all records together, initial states those of each.";
    Some(section("records", "Records", lead, items))
}

fn error_table(title: &str, errors: &[OutputError], has_findings: bool) -> Table {
    let mut columns = Column::heads("output | > nominal model, rms | > with what was found, rms");
    let count = if has_findings { 3 } else { 2 };
    columns.truncate(count);
    let rows = errors.iter().map(|error| {
        let cells = [
            error.output.clone(),
            rms(error.nominal, &error.unit),
            rms(error.extended, &error.unit),
        ];
        cells.into_iter().take(count)
    });
    Table::new(title, columns, rows)
}

/// The gain in the record and on a later one, with charts of the later one if its diagnosis is there; `None` if
/// nothing was found.
pub(super) fn gain(answer: &Answer, diagnosed: Option<&Diagnosed>) -> Option<Section> {
    if !answer.has_findings() {
        return None;
    }
    let open_loop = |of: &str, horizon_s: Option<f64>, errors: &[OutputError]| {
        let over = format::short(horizon_s.unwrap_or_default(), 4);
        let title = format!("Open-loop error in {of}, simulated over {over} s");
        Item::from(error_table(&title, errors, true))
    };
    let mut items = vec![open_loop(
        "the diagnosed data",
        answer.horizon_s,
        &answer.open_loop,
    )];
    let gain = answer.gain.as_ref();
    let later = gain.and_then(|gain| gain.validation.as_ref());
    match later {
        Some(later) => {
            items.extend(gyrocal_words::plant::later_record(answer).map(Item::text));
            let title = format!(
                "{:+.1} nats of predictive log score in the later record",
                later.log_score_nats
            );
            let title = title.replace('-', "−");
            let series = diagnosed.and_then(|own| Some((own, own.later.as_ref()?)));
            items.extend(series.map(|(own, series)| {
                Item::Chart(over_time::residual(title, series, own.is_simulated_whole()))
            }));
            items.push(open_loop(
                "the later record",
                later.horizon_s,
                &later.open_loop,
            ));
        }
        None => items.push(Item::text(
            "No later record was given: --validate LATER.csv measures the gain where nothing was fitted."
                .to_owned(),
        )),
    }
    let lead = "What the extended model predicts better than the nominal one.";
    Some(section("gain", "Gain", lead, items))
}

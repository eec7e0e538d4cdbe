//! Bars and intervals on a scale, as parts of a width.

use serde::Serialize;

use crate::number::{short, with_uncertainty};
use gyrocal_document::{Bars, EstimateRow, Estimates};

/// Width of an interval, in standard deviations each way.
const SIGMAS: f64 = 2.0;

/// Bars with their lengths in percent of the longest.
#[derive(Serialize)]
pub(super) struct DrawnBars {
    title: String,
    quantity: String,
    threshold: Option<DrawnThreshold>,
    groups: Vec<DrawnGroup>,
    omitted: String,
}

#[derive(Serialize)]
struct DrawnThreshold {
    percent: String,
    label: String,
    value: String,
}

#[derive(Serialize)]
struct DrawnGroup {
    label: String,
    bars: Vec<DrawnBar>,
}

#[derive(Serialize)]
struct DrawnBar {
    label: String,
    value: String,
    percent: String,
    tint: &'static str,
    note: String,
}

pub(super) fn bars(bars: &Bars) -> DrawnBars {
    let all = bars.groups.iter().flat_map(|group| &group.bars);
    let threshold = bars.threshold.as_ref().map_or(0.0, |threshold| threshold.0);
    let values = all.map(|bar| bar.value).filter(|value| value.is_finite());
    let longest = values
        .fold(1.1 * threshold, f64::max)
        .max(f64::MIN_POSITIVE);
    let percent = |value: f64| format!("{:.2}", 100.0 * (value.max(0.0) / longest).min(1.0));
    let groups = bars.groups.iter().map(|group| DrawnGroup {
        label: group.label.clone(),
        bars: group
            .bars
            .iter()
            .map(|bar| DrawnBar {
                label: bar.label.clone(),
                value: if bar.value.is_nan() {
                    "not tested".to_owned()
                } else {
                    format!("{:.1}", bar.value).replace('-', "−")
                },
                percent: percent(bar.value),
                tint: bar.tint.name(),
                note: bar.note.clone(),
            })
            .collect(),
    });
    DrawnBars {
        title: bars.title.clone(),
        quantity: bars.quantity.clone(),
        threshold: bars
            .threshold
            .as_ref()
            .map(|(value, label)| DrawnThreshold {
                percent: percent(*value),
                label: label.clone(),
                value: short(*value, 3),
            }),
        groups: groups.collect(),
        omitted: bars.omitted.clone(),
    }
}

/// Estimates with their intervals in percent of the width of a strip.
#[derive(Serialize)]
pub(super) struct DrawnEstimates {
    title: String,
    models: Vec<DrawnModel>,
    rows: Vec<DrawnRow>,
    note_head: String,
}

#[derive(Serialize)]
struct DrawnModel {
    label: String,
    tint: &'static str,
}

#[derive(Serialize)]
struct DrawnRow {
    name: String,
    unit: String,
    values: Vec<DrawnValue>,
    note: String,
    strong: bool,
}

#[derive(Serialize)]
struct DrawnValue {
    text: String,
    tint: &'static str,
    label: String,
    low: String,
    middle: String,
    width: String,
}

pub(super) fn estimates(estimates: &Estimates) -> DrawnEstimates {
    let models = estimates.models.iter().map(|(label, tint)| DrawnModel {
        label: label.clone(),
        tint: tint.name(),
    });
    let rows = estimates.rows.iter().map(|row| drawn_row(estimates, row));
    DrawnEstimates {
        title: estimates.title.clone(),
        models: models.collect(),
        rows: rows.collect(),
        note_head: estimates.note_head.clone(),
    }
}

fn drawn_row(estimates: &Estimates, row: &EstimateRow) -> DrawnRow {
    let ends = |value: f64, sigma: f64| [value - SIGMAS * sigma, value + SIGMAS * sigma];
    let all = row.values.iter().flat_map(|one| ends(one.value, one.sigma));
    let (low, high) = all
        .filter(|end| end.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
            (low.min(end), high.max(end))
        });
    let margin = 0.06 * (high - low).max(f64::MIN_POSITIVE);
    let place = |value: f64| 100.0 * (value - low + margin) / (high - low + 2.0 * margin);
    let values = row.values.iter().zip(&estimates.models);
    DrawnRow {
        name: row.name.clone(),
        unit: row.unit.clone(),
        values: values
            .map(|(one, (label, tint))| {
                let [from, to] = ends(one.value, one.sigma).map(place);
                DrawnValue {
                    text: match one.value.is_nan() {
                        true => "none".to_owned(),
                        false => with_uncertainty(one.value, one.sigma),
                    },
                    tint: tint.name(),
                    label: label.clone(),
                    low: format!("{from:.2}"),
                    middle: format!("{:.2}", place(one.value)),
                    width: format!("{:.2}", to - from),
                }
            })
            .collect(),
        note: row.note.clone(),
        strong: row.strong,
    }
}

//! Bars and intervals on a scale, as parts of a width.

use gyrocal_document::{Bar, BarGroup, Bars, EstimateRow, Estimates};
use serde_json::{Value, json};

use crate::estimates::ends;
use crate::number::{short, with_uncertainty};
use crate::span::Span;

/// Bars with their lengths in percent of the longest.
pub(super) fn bars(bars: &Bars) -> Value {
    let all = bars.groups.iter().flat_map(|group| &group.bars);
    let threshold = bars.threshold.as_ref().map_or(0.0, |threshold| threshold.0);
    let values = all.map(|bar| bar.value).filter(|value| value.is_finite());
    let longest = values
        .fold(1.1 * threshold, f64::max)
        .max(f64::MIN_POSITIVE);
    let percent = |value: f64| format!("{:.2}", 100.0 * (value.max(0.0) / longest).min(1.0));
    let bar = |bar: &Bar| {
        let value = match bar.value.is_nan() {
            true => "not tested".to_owned(),
            false => format!("{:.1}", bar.value).replace('-', "−"),
        };
        json!({
            "label": bar.label,
            "value": value,
            "percent": percent(bar.value),
            "tint": bar.tint,
            "note": bar.note,
        })
    };
    let group = |group: &BarGroup| {
        let bars: Vec<Value> = group.bars.iter().map(bar).collect();
        json!({ "label": group.label, "bars": bars })
    };
    let threshold = bars.threshold.as_ref().map(|(value, label)| {
        json!({ "percent": percent(*value), "label": label, "value": short(*value, 3) })
    });
    json!({
        "title": bars.title,
        "quantity": bars.quantity,
        "threshold": threshold,
        "groups": bars.groups.iter().map(group).collect::<Vec<_>>(),
        "omitted": bars.omitted,
    })
}

/// Estimates with their intervals in percent of the width of a strip.
pub(super) fn estimates(estimates: &Estimates) -> Value {
    let models = estimates.models.iter();
    let models = models.map(|(label, tint)| json!({ "label": label, "tint": tint }));
    let rows = estimates.rows.iter().map(|row| drawn_row(estimates, row));
    json!({
        "title": estimates.title,
        "models": models.collect::<Vec<_>>(),
        "rows": rows.collect::<Vec<_>>(),
        "note_head": estimates.note_head,
    })
}

fn drawn_row(estimates: &Estimates, row: &EstimateRow) -> Value {
    let span = Span::of(row.values.iter().flat_map(ends));
    let Span { lo: low, hi: high } = span.unwrap_or(Span::new(0.0, 0.0));
    let margin = 0.06 * (high - low).max(f64::MIN_POSITIVE);
    let place = |value: f64| 100.0 * (value - low + margin) / (high - low + 2.0 * margin);
    let values = row.values.iter().zip(&estimates.models);
    let values = values.map(|(one, (label, tint))| {
        let [from, to] = ends(one).map(place);
        let text = match one.value.is_nan() {
            true => "none".to_owned(),
            false => with_uncertainty(one.value, one.sigma),
        };
        json!({
            "text": text,
            "tint": tint,
            "label": label,
            "low": format!("{from:.2}"),
            "middle": format!("{:.2}", place(one.value)),
            "width": format!("{:.2}", to - from),
        })
    });
    json!({
        "name": row.name,
        "unit": row.unit,
        "values": values.collect::<Vec<_>>(),
        "note": row.note,
        "strong": row.strong,
    })
}

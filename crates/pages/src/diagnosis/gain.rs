//! Gain of the extended model.

use gyrocal_answer::{Answer, Gain, Prediction};
use gyrocal_diagnosis::LaterPrediction;
use gyrocal_document::{Chart, Item, Level, Line, LineKind, Panel, Section, Table, TimeAxis, Tint};

use crate::panels::{EXTENDED, NOMINAL, line};
use crate::words::{listed, micro_g, section as titled};

/// `None` without a cause and a later record.
pub(super) fn section(result: &Answer, later: Option<&LaterPrediction>) -> Option<Section> {
    let gain = result.gain.as_ref();
    let mut items = Vec::new();
    if let Some(gain) = gain {
        items.extend([Item::text(validated(gain)), Item::Chart(blocks(gain))]);
    }
    items.extend(later.map(|later| Item::Chart(drift(later))));
    if let Some(gain) = gain {
        items.extend([figures(gain), gyrocal_words::shifts(gain)].map(Item::from));
    }
    if result.later_record.is_some() && gain.is_none_or(|gain| gain.validation.is_none()) {
        let words = "The later record was predicted with the nominal model only: no effect is in an extended one.";
        items.push(Item::text(words));
    }
    if items.is_empty() {
        return None;
    }
    let lead = "What the extended model predicts better than the nominal one, in data that it was not fitted to.";
    Some(titled("gain", "Gain", lead, items))
}

/// The outcome of cross-validation.
fn validated(gain: &Gain) -> String {
    let nats = gain.cross_validated_log_score_nats;
    let (folds, effects) = (gain.block_log_score_nats.len(), gain.effects.join(", "));
    let how = match gain.prediction {
        Prediction::CrossValidated => format!("{folds}-fold blocked cross-validation"),
        Prediction::Forward => format!("Each of {folds} blocks predicted from those before it"),
    };
    if nats <= 0.0 {
        return format!(
            "{how}: no extended model, as {effects} would not improve the predictive log score ({nats:.1} nats). \
             What follows is of that model."
        );
    }
    let improves = match gain.effects.len() {
        1 => "improves",
        _ => "improve",
    };
    format!("{how}: {effects} {improves} the predictive log score by {nats:.1} nats.")
}

fn blocks(gain: &Gain) -> Chart {
    let nats = &gain.block_log_score_nats;
    let better = nats.iter().flatten().filter(|nats| **nats > 0.0).count();
    let part = |sign: f64| -> Vec<f64> {
        let kept = |nats: &Option<f64>| nats.filter(|nats| nats * sign > 0.0).unwrap_or(f64::NAN);
        nats.iter().map(kept).collect()
    };
    let effects: Vec<&str> = gain.effects.iter().map(String::as_str).collect();
    let bars = |model: &str, tint, sign| {
        let label = format!("{model} predicts better");
        Line::new(&label, tint, LineKind::Bars, part(sign))
    };
    let mut lines = vec![bars(EXTENDED, Tint::Extended, 1.0)];
    if better < nats.len() {
        lines.push(bars(NOMINAL, Tint::Nominal, -1.0));
    }
    Chart {
        title: format!(
            "{}: {:+.1} nats of predictive log score, better in {better} of {} blocks",
            listed(&effects),
            gain.cross_validated_log_score_nats,
            nats.len()
        ),
        caption: match gain.prediction {
            Prediction::CrossValidated => "Each block of the record is predicted from all others.",
            Prediction::Forward => "Each block of the record is predicted from those before it.",
        }
        .to_owned(),
        abscissa: "held-out block, in order of time".to_owned(),
        quantity: "gain".to_owned(),
        unit: "nats".to_owned(),
        panels: vec![Panel {
            name: "cross-validation".to_owned(),
            abscissa: (1..=nats.len()).map(|block| block as f64).collect(),
            lines,
            levels: vec![Level::zero()],
            no_gaps: true,
            ..Panel::default()
        }],
        columns: 1,
        height_px: 180,
        ..Chart::default()
    }
}

/// Error of the attitude in a later record.
fn drift(later: &LaterPrediction) -> Chart {
    let errors = &later.attitude;
    let time = TimeAxis::of(&errors.time_s);
    Chart {
        title: "Attitude error under compensation in the later record".to_owned(),
        caption:
            "Predicted from the diagnosed record, and compared with the attitude that the later \
                  record's own accelerometers determine."
                .to_owned(),
        abscissa: "time from the start of the prediction".to_owned(),
        abscissa_unit: time.unit.to_owned(),
        quantity: "attitude error".to_owned(),
        unit: "arcmin".to_owned(),
        panels: vec![Panel {
            name: "later record".to_owned(),
            abscissa: time.values,
            lines: vec![
                Line {
                    kind: LineKind::Dashed,
                    ..line("expected", Tint::Expected, errors.expected_arcmin.clone())
                },
                line(NOMINAL, Tint::Nominal, errors.nominal_arcmin.clone()),
                line(EXTENDED, Tint::Extended, errors.extended_arcmin.clone()),
            ],
            no_gaps: true,
            ..Panel::default()
        }],
        columns: 1,
        height_px: 220,
        ..Chart::default()
    }
}

fn figures(gain: &Gain) -> Table {
    let mut rows = Vec::new();
    rows.extend(gain.free_run_rms_g.map(|rms| {
        [
            "open-loop error, rms".to_owned(),
            micro_g(rms.before),
            micro_g(rms.after),
            format!("{} (accelerometer noise)", micro_g(rms.noise)),
        ]
    }));
    let later = gain.validation.as_ref();
    let compensation = later.and_then(|later| later.compensation.as_ref());
    rows.extend(compensation.map(|error| {
        let after_h = error.after_h;
        [
            format!("attitude error in the later record after {after_h:.1} h"),
            format!("{:.2} arcmin", error.nominal_arcmin),
            format!("{:.2} arcmin", error.extended_arcmin),
            format!("{:.2} arcmin", error.expected_arcmin),
        ]
    }));
    rows.extend(later.map(|later| {
        [
            "predictive log score of the later record, extended less nominal".to_owned(),
            String::new(),
            format!("{:+.1} nats", later.log_score_nats),
            String::new(),
        ]
    }));
    let heads = "figure | > nominal | > extended | > expected";
    Table::of("Nominal and extended model", heads, rows)
}

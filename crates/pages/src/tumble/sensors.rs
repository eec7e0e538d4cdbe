//! Stops and sensors of a multi-position test.

use gyrocal_document::{Item, Section, Table};
use gyrocal_instruments::AccelErrors;
use gyrocal_statistics::format;

use super::TumbleAnswer;
use crate::bad_samples;
use crate::words::section;

/// Stops, accelerometers and gyros.
pub(super) fn section_of(answer: &TumbleAnswer<'_>) -> Section {
    let sensors = &answer.result.sensors;
    let mut items: Vec<Item> = answer.clocks.iter().map(Item::text).collect();
    if let Some([x, y, z]) = sensors.accel_outputs_per_g {
        items.push(Item::text(format!(
            "Accelerometers, from the magnitude at the stops: {x:.1}, {y:.1}, {z:.1} counts per g."
        )));
    }
    if let Some(errors) = &sensors.accel_errors {
        accelerometers(&mut items, errors);
    }
    items.push(Item::text(format!(
        "Magnitude of specific force: 1 g within {:.1e} g rms.",
        sensors.norm_rms_g
    )));
    if let (Some([x, y, z]), Some([ax, ay, az]), Some(rms), Some(turns)) = (
        sensors.gyro_outputs_per_rad_per_s,
        sensors.gyro_misalignment_rad,
        sensors.turn_rms_g,
        &answer.prepared.turns,
    ) {
        items.push(Item::text(format!(
            "Gyros, from {} turns between stops: {x:.5}, {y:.5}, {z:.5} outputs per rad/s, input axes {ax:.3}, \
             {ay:.3}, {az:.3} rad from those of the accelerometers; gravity predicted over the turns within \
             {rms:.1e} g rms.",
            turns.turns,
        )));
    }
    let left_out = sensors.saturated_turns.iter().map(|turn| {
        [
            format!("{:.2}", turn.from_s),
            format!("{:.2}", turn.to_s),
            turn.column.clone(),
            turn.end.to_string(),
            turn.samples.to_string(),
            turn.first_sample.to_string(),
        ]
    });
    if left_out.len() > 0 {
        let heads =
            "> from, s | > to, s | gyro | > end of its range | > samples there | > first of them";
        let title = "Turns left out, since a gyro is at the end of its range";
        items.push(Table::of(title, heads, left_out).into());
    }
    let logs = answer.manifest.inputs.len() - 1;
    items.extend(bad_samples::table(&sensors.bad_samples, logs));
    let list = |values: [f64; 3], digits: usize| {
        values.map(|value| format!("{value:.digits$}")).join(", ")
    };
    let rows = sensors.stops.iter().map(|stop| {
        [
            format!("{:.2}", stop.from_s),
            format!("{:.2}", stop.to_s),
            list(stop.force_g, 4),
            list(stop.rate_deg_per_h, 1),
        ]
    });
    let heads = "> from, s | > to, s | > force x, y, z, g | > rate x, y, z, deg/h";
    items.push(Table::of("Stops", heads, rows).into());
    let lead = "What the stops and the turns between them tell of the instruments.";
    section("stops", "Stops and sensors", lead, items)
}

fn accelerometers(items: &mut Vec<Item>, errors: &AccelErrors) {
    let (determined, open): (Vec<_>, Vec<_>) =
        errors.coefficients.iter().partition(|one| one.determined);
    let rows = determined.iter().map(|one| {
        let estimate = format::estimate(one.estimate, one.sigma).join(" ± ");
        [one.name.clone(), estimate, one.unit.to_owned()]
    });
    let heads = "coefficient | > estimate ± σ | unit";
    items.push(Table::of("Accelerometers, from the magnitude", heads, rows).into());
    if !open.is_empty() {
        let open: Vec<&str> = open.iter().map(|one| &*one.name).collect();
        items.push(Item::text(format!(
            "Not determined by these positions: {}.",
            open.join(", ")
        )));
    }
    if errors.excess_g > 0.0 {
        items.push(Item::text(format!(
            "Scatter of the magnitude beyond the standard errors of the stops: {:.1e} g; it is included.",
            errors.excess_g
        )));
    }
}

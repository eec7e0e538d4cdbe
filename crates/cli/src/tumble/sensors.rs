//! Stops and sensors of a multi-position test as text.

use std::fmt::Write as _;

use comfy_table::{Cell, Table};
use gyrocal_instruments::AccelErrors;
use gyrocal_instruments::multi_position::{PreparedTest, SensorReport};
use gyrocal_statistics::format;

use crate::tables::{right, table};

/// Stops, accelerometers and gyros.
pub(super) fn text(prepared: &PreparedTest) -> String {
    let sensors = prepared.sensors();
    let mut text = format!("{}\n\n", stops(&sensors).trim_fmt());
    if let Some(outputs) = sensors.accel_outputs_per_g {
        let [x, y, z] = outputs;
        let _ = writeln!(
            text,
            "Accelerometers, from the magnitude at the stops: {x:.1}, {y:.1}, {z:.1} counts per g."
        );
    }
    if let Some(errors) = &sensors.accel_errors {
        accelerometers(&mut text, errors);
    }
    let _ = writeln!(
        text,
        "Magnitude of specific force: 1 g within {:.1e} g rms.",
        sensors.norm_rms_g
    );
    if let (Some(outputs), Some(angles), Some(rms), Some(turns)) = (
        sensors.gyro_outputs_per_rad_per_s,
        sensors.gyro_misalignment_rad,
        sensors.turn_rms_g,
        &prepared.turns,
    ) {
        let [x, y, z] = outputs;
        let [ax, ay, az] = angles;
        let _ = writeln!(
            text,
            "Gyros, from {} turns between stops: {x:.5}, {y:.5}, {z:.5} outputs per rad/s, input \
             axes {ax:.3}, {ay:.3}, {az:.3} rad\nfrom those of the accelerometers; gravity \
             predicted over the turns within {rms:.1e} g rms.",
            turns.turns,
        );
    }
    text.push('\n');
    text
}

fn stops(sensors: &SensorReport) -> Table {
    let mut table = table([
        "from [s]",
        "to [s]",
        "force x, y, z [g]",
        "rate x, y, z [deg/h]",
    ]);
    for stop in &sensors.stops {
        let list = |values: [f64; 3], digits: usize| {
            values.map(|value| format!("{value:.digits$}")).join(", ")
        };
        table.add_row([
            right(format!("{:.2}", stop.from_s)),
            right(format!("{:.2}", stop.to_s)),
            right(list(stop.force_g, 4)),
            right(list(stop.rate_deg_per_h, 1)),
        ]);
    }
    table
}

fn accelerometers(text: &mut String, errors: &AccelErrors) {
    let mut table = table(["accelerometers, from the magnitude", "estimate"]);
    for coefficient in errors.coefficients.iter().filter(|other| other.determined) {
        let estimate = format::estimate(coefficient.estimate, coefficient.sigma).join(" ± ");
        table.add_row([
            Cell::new(&coefficient.name),
            Cell::new(format!("{estimate} {}", coefficient.unit)),
        ]);
    }
    let _ = writeln!(text, "{}\n", table.trim_fmt());
    let open = errors.coefficients.iter().filter(|other| !other.determined);
    let open: Vec<&str> = open.map(|other| &*other.name).collect();
    if !open.is_empty() {
        let _ = writeln!(
            text,
            "Not determined by these positions: {}.",
            open.join(", ")
        );
    }
    if errors.excess_g > 0.0 {
        let _ = writeln!(
            text,
            "Scatter of the magnitude beyond the standard errors of the stops: {:.1e} g; it is included.",
            errors.excess_g
        );
    }
}

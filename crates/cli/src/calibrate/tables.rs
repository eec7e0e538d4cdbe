//! The tables below the words.

use comfy_table::Cell;
use gyrocal_calibration::{Calibration, ConsiderSensitivity, SiteQuantity};
use gyrocal_statistics::format;

use super::Found;
use super::words::site_error;
use crate::tables::{right, table};

const AXES: [&str; 3] = ["x", "y", "z"];

/// The nine, with sigmas.
pub(super) fn coefficients(calibration: &Calibration) -> String {
    let header = [
        "coefficient",
        "estimate",
        "sigma",
        "unit",
        "determined",
        "meaning",
    ];
    let mut table = table(header);
    for coefficient in calibration.coefficients() {
        let [estimate, sigma] = format::estimate(coefficient.estimate, coefficient.sigma);
        table.add_row([
            Cell::new(coefficient.id),
            right(estimate),
            right(sigma),
            Cell::new(coefficient.unit),
            Cell::new(if coefficient.determined { "yes" } else { "no" }),
            Cell::new(coefficient.meaning),
        ]);
    }
    table.trim_fmt()
}

/// What errors of the site would do that nothing in the record shows.
pub(super) fn silent_biases(calibration: &Calibration) -> String {
    let order = [
        SiteQuantity::Latitude,
        SiteQuantity::EarthRate,
        SiteQuantity::Gravity,
    ];
    let influences: Vec<&ConsiderSensitivity> = order
        .iter()
        .filter_map(|quantity| {
            calibration
                .site_sensitivities
                .iter()
                .find(|i| i.quantity == *quantity)
        })
        .collect();
    let header = influences
        .iter()
        .flat_map(|influence| [site_error(influence), "in sigmas".to_owned()]);
    let mut table = table(["coefficient".to_owned()].into_iter().chain(header));
    for (index, coefficient) in calibration.coefficients().into_iter().enumerate() {
        let shifts = influences.iter().flat_map(|influence| {
            let shift = influence.bias_per_unit[index] * influence.assumed_error();
            [
                right(format!("{shift:+.1e}")),
                right(format!("{:+.2}", shift / coefficient.sigma)),
            ]
        });
        table.add_row([Cell::new(coefficient.id)].into_iter().chain(shifts));
    }
    table.trim_fmt()
}

/// What each turn-on added to the constant drifts; `None` if turn-ons are taken as alike.
pub(super) fn turn_ons(found: &Found) -> Option<String> {
    let header = AXES.map(|axis| format!("gyro_{axis}.bias"));
    let mut table = table(["record".to_owned()].into_iter().chain(header));
    for (measurement, run) in found.measurements.iter().zip(&found.calibration.runs) {
        let gyros = run.turn_on_deg_per_h?.map(|[estimate, sigma]| {
            let [estimate, sigma] = format::estimate(estimate, sigma);
            right(format!("{estimate} ± {sigma}"))
        });
        let name = Cell::new(measurement.path.display());
        table.add_row([name].into_iter().chain(gyros));
    }
    (table.row_count() > 0).then(|| table.trim_fmt())
}

/// Sigmas of the first record alone beside those of all; `None` of one record. Where turn-ons
/// differ, one record's constant drifts are others than those of their mean, and left out.
pub(super) fn gains(found: &Found) -> Option<String> {
    let alone = found.first_alone.as_ref()?;
    let runs = &found.calibration.runs;
    let differ = runs.iter().any(|run| run.turn_on_deg_per_h.is_some());
    let header = [
        "coefficient",
        "first record alone",
        "all together",
        "ratio",
        "unit",
    ];
    let mut table = table(header);
    for (coefficient, alone) in found.calibration.coefficients().into_iter().zip(alone) {
        if differ && coefficient.id.ends_with(".bias") {
            continue;
        }
        table.add_row([
            Cell::new(coefficient.id),
            right(format::estimate(0.0, *alone)[1].clone()),
            right(format::estimate(0.0, coefficient.sigma)[1].clone()),
            right(format!("{:.2}", coefficient.sigma / alone)),
            Cell::new(coefficient.unit),
        ]);
    }
    Some(table.trim_fmt())
}

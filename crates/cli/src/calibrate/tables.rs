//! Tables of `gyrocal calibrate`.

use comfy_table::Cell;
use gyrocal_calibration::{BIASES, Calibration, ConsiderSensitivity, SiteQuantity};
use gyrocal_record::{AXES, FittedEffects, printable_path};
use gyrocal_statistics::format;

use super::CalibrationRun;
use crate::tables::{right, table};

/// The coefficients with their sigmas.
pub(super) fn coefficients(calibration: &Calibration) -> String {
    let mut table = table(["coefficient", "estimate", "determined", "meaning"]);
    for coefficient in calibration.coefficients() {
        let estimate = format::estimate(coefficient.estimate, coefficient.sigma).join(" ± ");
        table.add_row([
            Cell::new(coefficient.id),
            Cell::new(format!("{estimate} {}", coefficient.unit)),
            Cell::new(if coefficient.determined { "yes" } else { "no" }),
            Cell::new(coefficient.meaning),
        ]);
    }
    table.trim_fmt()
}

/// The coefficients without and with given effects in the model.
pub(super) fn with_effects(calibration: &Calibration, with: &FittedEffects) -> String {
    let mut table = table(["coefficient", "nominal model", "with these effects", "unit"]);
    let value = |estimate: f64, sigma: f64| format::estimate(estimate, sigma).join(" ± ");
    for (nominal, with) in calibration.coefficients().iter().zip(&with.coefficients) {
        table.add_row([
            Cell::new(nominal.id),
            right(value(nominal.estimate, nominal.sigma)),
            right(value(with.estimate, with.sigma)),
            Cell::new(nominal.unit),
        ]);
    }
    table.trim_fmt()
}

/// The parameters of given effects.
pub(super) fn given_effects(with: &FittedEffects) -> String {
    let mut table = table(["effect", "parameter", "estimate", "95 % interval", "unit"]);
    for effect in &with.effects {
        for parameter in &effect.parameters {
            let estimate = match parameter.sigma {
                Some(sigma) => format::estimate(parameter.estimate, sigma).join(" ± "),
                None => format::significant(parameter.estimate, 4),
            };
            let pieces = parameter.interval.iter().flatten().map(|[low, high]| {
                let ends = [low, high].map(|end| format::significant(*end, 4));
                ends.join(" to ")
            });
            let pieces: Vec<String> = pieces.collect();
            table.add_row([
                Cell::new(&effect.effect),
                Cell::new(&parameter.name),
                right(estimate),
                right(pieces.join(" or ")),
                Cell::new(&parameter.unit),
            ]);
        }
    }
    table.trim_fmt()
}

/// Biases of the coefficients by errors of the site; `None` for the streaming filter.
pub(super) fn site_sensitivities(calibration: &Calibration) -> Option<String> {
    let order = [
        SiteQuantity::Latitude,
        SiteQuantity::EarthRate,
        SiteQuantity::Gravity,
    ];
    let sensitivities: Vec<&ConsiderSensitivity> = order
        .iter()
        .filter_map(|quantity| calibration.site_sensitivity(*quantity))
        .collect();
    if sensitivities.is_empty() {
        return None;
    }
    let header = sensitivities
        .iter()
        .flat_map(|sensitivity| [site_error(sensitivity), "in sigmas".to_owned()]);
    let mut table = table(["coefficient".to_owned()].into_iter().chain(header));
    for (index, coefficient) in calibration.coefficients().into_iter().enumerate() {
        let biases = sensitivities.iter().flat_map(|sensitivity| {
            let bias = calibration.biases(sensitivity)[index];
            [
                right(format!("{:+.1e}", bias.bias)),
                right(format!("{:+.2}", bias.in_sigmas)),
            ]
        });
        table.add_row([Cell::new(coefficient.id)].into_iter().chain(biases));
    }
    Some(table.trim_fmt())
}

/// Name and size of the site error that a table of sensitivities is for.
fn site_error(sensitivity: &ConsiderSensitivity) -> String {
    let error = sensitivity.assumed_error();
    let size = match sensitivity.quantity {
        SiteQuantity::Latitude => format!("latitude +{:.3} arcsec", 3600.0 * error),
        SiteQuantity::EarthRate => format!("Earth rate +{error:.1e}"),
        SiteQuantity::Gravity => format!("gravity +{error:.1e}"),
        _ => format!("+{error:.1e}"),
    };
    if sensitivity.declared_sigma.is_some() {
        format!("{size} (1 sigma)")
    } else {
        size
    }
}

/// Offsets of the turn-ons from the mean constant drifts; `None` if turn-ons are declared alike.
pub(super) fn turn_ons(found: &CalibrationRun) -> Option<String> {
    let header = AXES.map(|axis| format!("gyro_{axis}.bias"));
    let mut table = table(["record".to_owned()].into_iter().chain(header));
    for (measurement, run) in found.measurements.iter().zip(&found.calibration.runs) {
        let gyros = run.turn_on_deg_per_h?.map(|[estimate, sigma]| {
            let [estimate, sigma] = format::estimate(estimate, sigma);
            right(format!("{estimate} ± {sigma}"))
        });
        let name = Cell::new(printable_path(&measurement.path));
        table.add_row([name].into_iter().chain(gyros));
    }
    (table.row_count() > 0).then(|| table.trim_fmt())
}

/// Sigmas from the first record alone and from all records; `None` of one record. Where turn-ons
/// differ, constant drifts are left out: those of one record are not their means over turn-ons.
pub(super) fn first_run_sigmas(found: &CalibrationRun) -> Option<String> {
    let alone = found.first_run_sigmas?;
    let header = [
        "coefficient",
        "first record alone",
        "all together",
        "ratio",
        "unit",
    ];
    let mut table = table(header);
    let coefficients = found.calibration.coefficients();
    for (index, (coefficient, alone)) in coefficients.into_iter().zip(alone).enumerate() {
        if found.calibration.has_turn_ons() && BIASES.contains(&index) {
            continue;
        }
        table.add_row([
            Cell::new(coefficient.id),
            right(format::estimate(0.0, alone)[1].clone()),
            right(format::estimate(0.0, coefficient.sigma)[1].clone()),
            right(format!("{:.2}", coefficient.sigma / alone)),
            Cell::new(coefficient.unit),
        ]);
    }
    Some(table.trim_fmt())
}

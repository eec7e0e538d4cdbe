//! Tables of a calibration.

use gyrocal::generated::platform::DRIFT;
use gyrocal::generated::surveyed::parameters_index as index;
use gyrocal_document::{Column, Table};
use gyrocal_record::{AXES, CalibrationReport, Coefficient, SiteReport, printable_line};
use gyrocal_statistics::format;

use super::by_number;
use crate::files::joined;
use crate::format::with_sigma;

/// Quantities of the site, in the order in which they are told.
const QUANTITIES: [&str; 3] = ["latitude", "earth_rate", "gravity"];

/// Effects that were given, turn-ons, sigmas from the first record alone, errors of the site.
pub(super) fn further(report: &CalibrationReport) -> Vec<Table> {
    let tables = [
        given_effects(report),
        attitudes(report),
        turn_ons(report),
        first_record(report),
        site(report),
    ];
    tables.into_iter().flatten().collect()
}

/// What a coefficient is.
pub(super) fn meaning(name: &str) -> &'static str {
    let mut all = DRIFT.iter();
    all.find(|one| one.id == name).map_or("", |one| one.doc)
}

/// Unit of constant drifts, and of no other coefficient.
const OF_CONSTANT: &str = "deg/h";

/// Places of D_I of gyros x, y, z among the coefficients.
pub(super) const MASS_UNBALANCES: [usize; 3] =
    [index::GYRO_X_G_X, index::GYRO_Y_G_Y, index::GYRO_Z_G_Z];

/// The parameters of the effects that were given.
fn given_effects(report: &CalibrationReport) -> Option<Table> {
    let with = report.with_effects.as_ref()?;
    let title = format!(
        "Effects in the model, which gain {:.1} nats of log-likelihood",
        with.gained_nats
    );
    let effects = with.effects.iter().flat_map(|effect| {
        effect.parameters.iter().map(|own| {
            let ends = |ends: &[f64; 2]| ends.map(|end| format::significant(end, 4)).join(" to ");
            let pieces = own.interval.iter().flatten().map(ends);
            [
                effect.effect.clone(),
                own.name.clone(),
                match own.sigma {
                    Some(sigma) => with_sigma(own.estimate, sigma),
                    None => format::significant(own.estimate, 4),
                },
                joined(pieces, " or "),
                own.unit.clone(),
            ]
        })
    });
    let heads = "effect | parameter | > estimate | > 95 % interval | unit";
    Some(Table::of(&title, heads, effects))
}

/// Attitude of each record at its first and last row; `None` for the streaming filter.
fn attitudes(report: &CalibrationReport) -> Option<Table> {
    let angles = |deg: [f64; 3]| deg.map(|angle| format!("{angle:.4}")).join(", ");
    let rows = report.runs.iter().map(|run| {
        [
            printable_line(&run.record).into_owned(),
            angles(run.initial_angles_deg),
            angles(run.final_angles_deg),
        ]
    });
    let heads = "record | > first row, deg | > last row, deg";
    let title = "Platform angles about x, y, z against east, north, up";
    Table::of(title, heads, rows).filled()
}

/// Offsets of the turn-ons from the mean constant drifts; `None` if turn-ons are declared alike.
fn turn_ons(report: &CalibrationReport) -> Option<Table> {
    let rows = report.runs.iter().filter_map(|run| {
        let gyros = run.turn_on.as_ref()?;
        let name = printable_line(&run.record).into_owned();
        let gyros = gyros.iter().map(|one| with_sigma(one.estimate, one.sigma));
        Some([name].into_iter().chain(gyros))
    });
    let gyros = AXES.map(|axis| Column::numbers(&format!("gyro_{axis}.bias")));
    let columns = core::iter::once(Column::words("record")).chain(gyros);
    let title = "Offsets of the turn-ons from the mean constant drifts, deg/h";
    Table::new(title, columns.collect(), rows).filled()
}

/// Sigmas from the first record alone and from all records; `None` of one record. Where turn-ons differ, constant
/// drifts are left out: those of one record are not their means over turn-ons.
fn first_record(report: &CalibrationReport) -> Option<Table> {
    let alone = report.first_record_sigmas.as_ref()?;
    let differ = report.runs.iter().any(|run| run.turn_on.is_some());
    let pairs = report.coefficients.iter().zip(alone);
    let rows = pairs.filter(|(one, _)| !(differ && one.unit == OF_CONSTANT));
    let rows = rows.map(|(one, alone)| {
        [
            one.name.clone(),
            format::estimate(0.0, *alone)[1].clone(),
            format::estimate(0.0, one.sigma)[1].clone(),
            format!("{:.2}", one.sigma / alone),
            one.unit.clone(),
        ]
    });
    let heads = "coefficient | > first record alone | > all together | > ratio | unit";
    let title = "Sigmas from the first record alone and from all records";
    Some(Table::of(title, heads, rows))
}

/// Biases of the coefficients by errors of the site; `None` for the streaming filter.
fn site(report: &CalibrationReport) -> Option<Table> {
    let mut sites: Vec<&SiteReport> = report.site.iter().collect();
    sites.sort_by_key(|one| QUANTITIES.iter().position(|name| one.quantity == *name));
    let heads = sites
        .iter()
        .flat_map(|one| [site_error(one), "in sigmas".to_owned()]);
    let heads = heads.map(|head| Column::numbers(&head));
    let columns = core::iter::once(Column::words("coefficient")).chain(heads);
    let biases: Vec<_> = sites.iter().map(|one| biases(report, one)).collect();
    let rows = report.coefficients.iter().enumerate().map(|(place, one)| {
        let cells = biases.iter().flat_map(move |all| {
            let [bias, in_sigmas] = all[place];
            [format!("{bias:+.1e}"), format!("{in_sigmas:+.2}")]
        });
        [one.name.clone()].into_iter().chain(cells)
    });
    let of = by_number(report, ["the site", "the first record's site"]);
    let title = format!(
        "Sensitivity to errors of {of}, which the residuals do not show: bias of each coefficient in its unit"
    );
    (!sites.is_empty()).then(|| Table::new(&title, columns.collect(), rows))
}

/// Name and size of the site error that biases are told for.
fn site_error(one: &SiteReport) -> String {
    let error = one.assumed_error;
    let size = match &*one.quantity {
        "latitude" => format!("latitude +{:.3} arcsec", 3600.0 * error),
        "earth_rate" => format!("Earth rate +{error:.1e}"),
        other => format!("{other} +{error:.1e}"),
    };
    match one.declared_sigma {
        Some(_) => format!("{size} (1 sigma)"),
        None => size,
    }
}

/// Bias of each coefficient by the assumed error of a quantity of the site, in its unit and in sigmas.
pub(super) fn biases(report: &CalibrationReport, site: &SiteReport) -> Vec<[f64; 2]> {
    let each = report.coefficients.iter().zip(&site.bias_per_unit);
    let each = each.map(|(one, per_unit)| {
        let bias = per_unit * site.assumed_error;
        [bias, bias / one.sigma]
    });
    each.collect()
}

/// The coefficient with the largest bias in sigmas, and its bias.
pub(super) fn largest_bias<'a>(
    report: &'a CalibrationReport,
    site: &SiteReport,
) -> Option<(&'a Coefficient, [f64; 2])> {
    let all = report.coefficients.iter().zip(biases(report, site));
    all.max_by(|(_, [_, one]), (_, [_, other])| one.abs().total_cmp(&other.abs()))
}

//! Unit of specific force.

use gyrocal_statistics::quantile;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::scale;
use crate::text::number;
use crate::vector::norm;

/// Median magnitudes over the declared one that are no other unit.
const SOUND: core::ops::RangeInclusive<f64> = 0.9..=1.1;

/// A magnitude is that of a unit within this share: local gravity differs by 0.3 % from the
/// standard, the errors of accelerometers by less than 1 %.
const NEAR: f64 = 0.03;

/// Units by what they call 1 g.
const UNITS: [(f64, &str); 7] = [
    (9.806_65, "m/s^2: divide by local gravity"),
    (980.665, "Gal (cm/s^2): divide by local gravity in Gal"),
    (1e3, "mg: divide by 1000"),
    (1e6, "micro-g: divide by 1e6"),
    (32.174, "ft/s^2: divide by local gravity"),
    (9.806_65e3, "mm/s^2: divide by local gravity"),
    (100.0, "percent of g: divide by 100"),
];

/// Without gravity a magnitude is noise; no unit in use is so large.
const REMOVED: f64 = 0.1;

/// Rows between this share and its complement have the same magnitude if only the unit is wrong.
const TAIL: f64 = 0.1;

/// Specific force in another unit than g.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let ratios: Vec<f64> = samples
        .complete()
        .iter()
        .map(|row| norm(row.force_g) / samples.rest_g)
        .collect();
    if ratios.is_empty() {
        return Vec::new();
    }
    let median = quantile(&ratios, 0.5);
    if SOUND.contains(&median) {
        return Vec::new();
    }
    let spread = quantile(&ratios, 1.0 - TAIL) - quantile(&ratios, TAIL);
    let known = UNITS
        .iter()
        .filter(|(size, _)| (median / size - 1.0).abs() < NEAR)
        .min_by(|a, b| {
            (median / a.0 - 1.0)
                .abs()
                .total_cmp(&(median / b.0 - 1.0).abs())
        });
    // What changes the magnitude with the attitude has tests of its own.
    if spread > NEAR * median
        && (known.is_none() || scale::one_axis(samples).is_some())
        && median > REMOVED
    {
        return Vec::new();
    }
    vec![finding(median, known.map(|(_, unit)| *unit))]
}

/// A magnitude that is no other unit and that no test explains.
pub(crate) fn finding(median: f64, known: Option<&str>) -> SetupFinding {
    let guess = match known {
        Some(unit) => format!("It seems to be in {unit}."),
        None if median < REMOVED => {
            "Gravity seems to have been removed: a platform at rest reads 1 g \
                                 along the vertical."
                .to_owned()
        }
        None => "Check the gains of the accelerometers and that the columns are theirs.".to_owned(),
    };
    let description = format!("Specific force is not in units of gravity. {guess}");
    let evidence = format!(
        "the median magnitude is {} times that at rest",
        number(median)
    );
    SetupFinding::new(SetupKind::Unit, description, evidence).stopping()
}

//! The turn of gravity against latitude and declared attitude.

use crate::attitude;
use crate::finding::{Correction, SetupFinding};
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::signed_axes::SignedAxes;
use crate::text::number;
use crate::turn::{EARTH_DEG_PER_H, Turn, in_degrees};

/// The size of the whole rate is that of the Earth within this factor, or the clock is wrong.
const SOUND_CLOCK: core::ops::RangeInclusive<f64> = 0.6..=1.6;

/// Latitudes at which fits of both signs tell more than the rate does; below them nothing tells them
/// apart, since the drift per g of both differs by less than 2 deg/h/g.
const LOW_LATITUDES_DEG: core::ops::RangeInclusive<f64> = 3.0..=15.0;

/// A shorter record leaves the mean drift about the vertical unknown, s.
const DECISIVE_S: f64 = 12.0 * 3600.0;

/// A turn of gravity that the declared latitude, axes and attitude do not explain.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let turn = Turn::of(samples, &complete);
    if let Some(clock) = turn.as_ref().and_then(clock) {
        return vec![clock];
    }
    let latitude_deg = samples.bench.latitude_deg;
    let found = match (samples.bench.initial_angles_deg, &turn) {
        (Some(angles_deg), turn) => attitude::find(samples, &complete, angles_deg, turn.as_ref()),
        (None, Some(turn)) if is_undecided(turn, latitude_deg) => {
            samples.unconfirmed = Some(handedness(turn, latitude_deg));
            None
        }
        (None, Some(turn)) => without_angles(latitude_deg, turn),
        (None, None) => None,
    };
    found.into_iter().collect()
}

/// The whole rate is another than the Earth's: the clock runs at another rate.
fn clock(turn: &Turn) -> Option<SetupFinding> {
    let size = turn.vertical_deg_per_h.hypot(turn.horizontal_deg_per_h);
    let ratio = size / EARTH_DEG_PER_H;
    let off = (size - EARTH_DEG_PER_H).abs();
    let tolerance = turn
        .vertical_tolerance_deg_per_h
        .max(turn.horizontal_tolerance_deg_per_h);
    if SOUND_CLOCK.contains(&ratio) || off < tolerance {
        return None;
    }
    let description = "Gravity turns at another rate than the Earth's: the times are not in \
                       seconds, or rows were lost without a trace in them. Check time_s."
        .to_owned();
    let evidence = format!(
        "gravity turns by {} deg/h, {} times the rate of the Earth",
        number(size),
        number(ratio)
    );
    Some(SetupFinding::new(SetupKind::Clock, description, evidence).stopping())
}

/// Whether the latitude explains the turn with one sign or the other, and fits of both decide better
/// than the rate: over so short a record, or so near the equator, the rate's tolerance is as large as
/// the difference of the signs.
fn is_undecided(turn: &Turn, declared_deg: f64) -> bool {
    let latitude = declared_deg.to_radians();
    let is_near = LOW_LATITUDES_DEG.contains(&declared_deg.abs());
    let is_short = turn.span_s < DECISIVE_S && declared_deg.abs() > *LOW_LATITUDES_DEG.start();
    (is_near || is_short)
        && turn.fits_horizontal(latitude)
        && (turn.fits_vertical(1.0, latitude) || is_reversed(turn, latitude))
}

/// Whether the opposite latitude explains the rate about the vertical, and much better.
fn is_reversed(turn: &Turn, latitude_rad: f64) -> bool {
    let opposite = turn.vertical_misfit(1.0, -latitude_rad);
    opposite <= turn.vertical_tolerance_deg_per_h
        && opposite < 0.5 * turn.vertical_misfit(1.0, latitude_rad)
}

/// Without declared angles only the sense of the turn and the latitude can be judged.
fn without_angles(declared: f64, turn: &Turn) -> Option<SetupFinding> {
    let latitude = declared.to_radians();
    let fits = turn.fits_vertical(1.0, latitude);
    if fits && turn.fits_horizontal(latitude) {
        return None;
    }
    if !fits && is_reversed(turn, latitude) && turn.fits_horizontal(latitude) {
        return Some(handedness(turn, declared));
    }
    Some(latitude_finding(turn, declared))
}

fn handedness(turn: &Turn, latitude_deg: f64) -> SetupFinding {
    let description =
        "Gravity turns the wrong way: the sign of the latitude is wrong, or the axes are mirrored."
            .to_owned();
    let evidence = turn.evidence(latitude_deg.to_radians());
    let mut finding = SetupFinding::new(SetupKind::Handedness, description, evidence)
        .stopping()
        .or(
            SetupKind::Latitude,
            format!("the latitude is {} deg", number(-latitude_deg)),
        )
        .or(
            SetupKind::Axes,
            "the axes are mirrored: one or three negated, or two exchanged",
        );
    finding.correction = Some(Correction {
        axes: SignedAxes::AS_GIVEN,
        latitude_deg: -latitude_deg,
    });
    finding
}

/// A latitude that does not explain the turn: in radians, or another one.
fn latitude_finding(turn: &Turn, declared_deg: f64) -> SetupFinding {
    let estimate_deg = turn
        .vertical_deg_per_h
        .atan2(turn.horizontal_deg_per_h)
        .to_degrees();
    let in_radians = in_degrees(declared_deg).filter(|latitude_rad| {
        turn.fits_vertical(1.0, *latitude_rad) && turn.fits_horizontal(*latitude_rad)
    });
    let (guess, latitude_deg) = match in_radians {
        Some(latitude_rad) => (
            format!(
                " It seems to be in radians: {} deg.",
                number(latitude_rad.to_degrees())
            ),
            latitude_rad.to_degrees(),
        ),
        None => (
            format!(" It turns as at about {} deg.", estimate_deg.round()),
            estimate_deg,
        ),
    };
    let description = format!(
        "Gravity does not turn as it does at the latitude of {} deg.{guess}",
        number(declared_deg)
    );
    let evidence = turn.evidence(declared_deg.to_radians());
    let mut finding = SetupFinding::new(SetupKind::Latitude, description, evidence)
        .stopping()
        .or(SetupKind::Axes, "mirrored axes at the opposite latitude");
    finding.correction = Some(Correction {
        axes: SignedAxes::AS_GIVEN,
        latitude_deg,
    });
    finding
}

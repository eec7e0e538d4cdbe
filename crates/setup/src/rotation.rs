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

/// A turn of gravity that the declared latitude, axes and attitude do not explain.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let turn = Turn::of(samples, &complete);
    if let Some(clock) = turn.as_ref().and_then(clock) {
        return vec![clock];
    }
    let found = match (samples.bench.initial_angles_deg, &turn) {
        (Some(angles_deg), turn) => attitude::find(samples, &complete, angles_deg, turn.as_ref()),
        (None, Some(turn)) => without_angles(samples, turn),
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

/// Without declared angles only the sense of the turn and the latitude can be judged.
fn without_angles(samples: &Samples<'_>, turn: &Turn) -> Option<SetupFinding> {
    let declared = samples.bench.latitude_deg;
    let latitude = declared.to_radians();
    let fits = turn.fits_vertical(1.0, latitude);
    if fits && turn.fits_horizontal(latitude) {
        return None;
    }
    let opposite = turn.vertical_misfit(1.0, -latitude);
    let reversed = opposite <= turn.vertical_tolerance_deg_per_h
        && opposite < 0.5 * turn.vertical_misfit(1.0, latitude);
    if !fits && reversed && turn.fits_horizontal(latitude) {
        return Some(handedness(turn, declared));
    }
    Some(latitude_finding(turn, declared))
}

fn handedness(turn: &Turn, latitude_deg: f64) -> SetupFinding {
    let description = "Gravity turns the wrong way for this latitude: its sign is wrong, or the \
                       axes are mirrored (one or three negated, or two exchanged). The record \
                       cannot tell which."
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

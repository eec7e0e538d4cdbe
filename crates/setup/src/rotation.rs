//! The turn of gravity against latitude and declared attitude.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_statistics::mean;

use crate::attitude;
use crate::finding::{Correction, SetupFinding};
use crate::kind::SetupKind;
use crate::prior::{horizontal_sigma_deg_per_h, vertical_sigma_deg_per_h};
use crate::rate::{Rate, WINDOW_S, rates};
use crate::samples::{Complete, Samples};
use crate::signed_axes::SignedAxes;
use crate::text::number;

/// Rate of the Earth, deg/h.
pub(crate) const EARTH_DEG_PER_H: f64 =
    3600.0 * EARTH_RATE_RAD_PER_S * 180.0 / core::f64::consts::PI;

/// A component of the rate is wrong beyond so many standard deviations of the prior's drift.
const VERTICAL_SIGMAS: f64 = 4.6;
const HORIZONTAL_SIGMAS: f64 = 4.0;

/// By how much a standard deviation of the drift, over the horizontal rate of the Earth, widens these.
const FAST_DRIFT: f64 = 1.5;

/// The size of the whole rate is that of the Earth within this factor, or the clock is wrong.
const SOUND_CLOCK: core::ops::RangeInclusive<f64> = 0.6..=1.6;

/// Over a shorter record the mean drift about the vertical is less known.
const DAY_S: f64 = 86_400.0;

/// What the rows say of the turn of gravity; rates in deg/h.
pub(crate) struct Turn {
    /// Along the vertical, trimmed mean over all windows.
    pub(crate) vertical_deg_per_h: f64,
    /// Across the vertical, trimmed mean over all windows.
    pub(crate) horizontal_deg_per_h: f64,
    /// By how much these may be off.
    pub(crate) vertical_tolerance_deg_per_h: f64,
    pub(crate) horizontal_tolerance_deg_per_h: f64,
    /// The rate in the first window.
    pub(crate) first: Rate,
}

impl Turn {
    /// `None` if the rows do not determine the rate.
    fn of(samples: &Samples<'_>, complete: &[Complete]) -> Option<Self> {
        let found = rates(complete, WINDOW_S);
        let first = *found.first()?;
        let deg_per_h = |of: fn(&Rate) -> f64| {
            let all: Vec<f64> = found.iter().map(of).collect();
            trimmed_mean(all).to_degrees() * 3600.0
        };
        let span_s = complete.last()?.time_s - complete.first()?.time_s;
        let shortness = (DAY_S / span_s).max(1.0).sqrt();
        let sigma = vertical_sigma_deg_per_h(samples.bench, complete);
        let horizontal_sigma = horizontal_sigma_deg_per_h(samples.bench);
        let cosine = samples.bench.latitude_deg.to_radians().cos();
        // A platform that drifts fast beside the turn of gravity changes the rate within a window.
        let inexact = 1.0_f64.hypot(FAST_DRIFT * horizontal_sigma / (EARTH_DEG_PER_H * cosine));
        Some(Self {
            vertical_deg_per_h: deg_per_h(|rate| rate.vertical_rad_per_s),
            horizontal_deg_per_h: deg_per_h(|rate| rate.horizontal_rad_per_s),
            vertical_tolerance_deg_per_h: VERTICAL_SIGMAS * sigma * shortness * inexact,
            horizontal_tolerance_deg_per_h: HORIZONTAL_SIGMAS
                * horizontal_sigma
                * shortness
                * inexact,
            first,
        })
    }

    /// Whether the vertical rate is that at a latitude.
    pub(crate) fn fits_vertical(&self, sign: f64, latitude_rad: f64) -> bool {
        self.vertical_misfit(sign, latitude_rad) <= self.vertical_tolerance_deg_per_h
    }

    fn vertical_misfit(&self, sign: f64, latitude_rad: f64) -> f64 {
        (sign * self.vertical_deg_per_h - EARTH_DEG_PER_H * latitude_rad.sin()).abs()
    }

    fn fits_horizontal(&self, latitude_rad: f64) -> bool {
        (self.horizontal_deg_per_h - EARTH_DEG_PER_H * latitude_rad.cos()).abs()
            <= self.horizontal_tolerance_deg_per_h
    }

    /// The rates in words.
    pub(crate) fn evidence(&self, latitude_rad: f64) -> String {
        format!(
            "gravity turns by {} deg/h about the vertical and {} deg/h across it, at {} deg the \
             Earth by {} and {}; the drift of the gyros may be {} and {}",
            number(self.vertical_deg_per_h),
            number(self.horizontal_deg_per_h),
            number(latitude_rad.to_degrees()),
            number(EARTH_DEG_PER_H * latitude_rad.sin()),
            number(EARTH_DEG_PER_H * latitude_rad.cos()),
            number(self.vertical_tolerance_deg_per_h),
            number(self.horizontal_tolerance_deg_per_h),
        )
    }
}

/// Mean without the smallest and the largest fifth: the drift about the vertical averages out over a
/// day, and a window in which gravity hardly moved is far off.
fn trimmed_mean(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let cut = values.len() / 5;
    mean(&values[cut..values.len() - cut])
}

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

/// A latitude that was given in radians as if these were degrees; rad.
pub(crate) fn in_degrees(latitude_deg: f64) -> Option<f64> {
    (latitude_deg.abs() <= core::f64::consts::FRAC_PI_2 && latitude_deg != 0.0)
        .then_some(latitude_deg)
}

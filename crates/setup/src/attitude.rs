//! The declared attitude against the first hours of the record.

use crate::convention::{Matrix, conventions, platform_c_enu, times};
use crate::finding::{Correction, SetupFinding};
use crate::kind::SetupKind;
use crate::samples::{Complete, Samples};
use crate::signed_axes::SignedAxes;
use crate::text::number;
use crate::turn::{EARTH_DEG_PER_H, Turn, in_degrees};
use crate::vector::{Vector, across, angle, dot, median, minus, norm, turned};

/// The first vertical is that of a set-up within this angle ...
const LEAST_TOLERANCE_DEG: f64 = 3.0;

/// ... or so many sigmas of the declared angles.
const SIGMAS: f64 = 5.0;

/// Two set-ups whose verticals differ by less are told together, the simpler first.
const SAME_DEG: f64 = 0.5;

/// Rows whose median is the first vertical, and the time in which they must come.
const ROWS: usize = 5;
const LATEST_S: f64 = 1200.0;

/// Most other set-ups that are told.
const MOST_TOLD: usize = 6;

/// A set-up that the record may have had.
struct SetUp {
    kind: SetupKind,
    words: String,
    axes: SignedAxes,
    latitude_rad: f64,
    platform_c_enu: Matrix,
    /// Number of mistakes that lead to it.
    mistakes: usize,
}

impl SetUp {
    /// Angle between the first vertical and that of the set-up, deg.
    fn tilt_deg(&self, up: Vector) -> f64 {
        let expected = times(self.platform_c_enu, [0.0, 0.0, 1.0]);
        angle(self.axes.apply(up), expected).to_degrees()
    }

    /// Distance of the horizontal rate of the first window from that of the set-up, deg/h.
    fn horizontal_misfit(&self, turn: &Turn) -> f64 {
        let up = times(self.platform_c_enu, [0.0, 0.0, 1.0]);
        let north = [0.0, EARTH_DEG_PER_H * self.latitude_rad.cos(), 0.0];
        let expected = times(self.platform_c_enu, north);
        let sign = self.axes.determinant();
        let to_deg_per_h = |rate: f64| sign * rate.to_degrees() * 3600.0;
        let found = self
            .axes
            .apply(turn.first.first_rad_per_s)
            .map(to_deg_per_h);
        norm(minus(across(found, up), expected))
    }

    fn fits(&self, up: Vector, tolerance_deg: f64, turn: Option<&Turn>) -> bool {
        self.tilt_deg(up) <= tolerance_deg
            && turn.is_none_or(|turn| {
                let slack = EARTH_DEG_PER_H
                    * self.latitude_rad.cos()
                    * (tolerance_deg - LEAST_TOLERANCE_DEG).to_radians();
                turn.fits_vertical(self.axes.determinant(), self.latitude_rad)
                    && self.horizontal_misfit(turn) <= turn.horizontal_tolerance_deg_per_h + slack
            })
    }
}

/// Whether the declared angles explain the first vertical and the turn of gravity; if not, what
/// would.
pub(crate) fn find(
    samples: &Samples<'_>,
    complete: &[Complete],
    angles_deg: Vector,
    turn: Option<&Turn>,
) -> Option<SetupFinding> {
    let up = first_up(samples, complete, turn)?;
    let sigmas_deg = samples.bench.initial_angles_sigma_deg;
    let largest_sigma_deg = sigmas_deg.into_iter().fold(0.0, f64::max);
    let tolerance_deg = LEAST_TOLERANCE_DEG.max(SIGMAS * largest_sigma_deg);
    let latitude_rad = samples.bench.latitude_deg.to_radians();
    let mut set_ups = all(angles_deg, latitude_rad);
    let declared = set_ups.swap_remove(0);
    if declared.fits(up, tolerance_deg, turn) {
        return None;
    }
    let mut fitting: Vec<&SetUp> = set_ups
        .iter()
        .filter(|set_up| set_up.fits(up, tolerance_deg, turn))
        .collect();
    let scale_deg = SAME_DEG.max(SIGMAS * largest_sigma_deg);
    let rank = |set_up: &SetUp| {
        let horizontal = turn.map_or(0.0, |turn| {
            set_up.horizontal_misfit(turn) / turn.horizontal_tolerance_deg_per_h
        });
        set_up.mistakes as f64 + set_up.tilt_deg(up) / scale_deg + horizontal
    };
    fitting.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    let tilt_deg = declared.tilt_deg(up);
    let rates = turn.map_or_else(
        || "the record is too short for the turn of gravity".to_owned(),
        |turn| {
            format!(
                "the rate across the vertical is {} deg/h off; {}",
                number(declared.horizontal_misfit(turn)),
                turn.evidence(latitude_rad)
            )
        },
    );
    let found = if tilt_deg > tolerance_deg {
        format!(
            "The first row is {} deg off the declared attitude",
            number(tilt_deg)
        )
    } else {
        "Gravity does not turn as it does at this latitude from the declared attitude".to_owned()
    };
    let evidence = format!(
        "the first vertical is {} deg off, {} are allowed; {rates}",
        number(tilt_deg),
        number(tolerance_deg)
    );
    Some(match fitting[..] {
        [] => unknown(found, evidence, tilt_deg <= tolerance_deg),
        [best, ..] => told(best, &fitting[1..], found, evidence),
    })
}

/// What nothing explains; `is_upright` if the first vertical is that of the declared attitude.
fn unknown(found: String, evidence: String, is_upright: bool) -> SetupFinding {
    let prior = if is_upright {
        " If they are right, the gyros drift by more than [prior] allows: widen its sigmas."
    } else {
        ""
    };
    let description = format!(
        "{found}, and no exchange of axes, no other sign of the latitude and no other convention \
         of angles explains it. Measure initial_angles_deg again, or leave them out.{prior}"
    );
    SetupFinding::new(SetupKind::Attitude, description, evidence).stopping()
}

fn told(best: &SetUp, others: &[&SetUp], found: String, evidence: String) -> SetupFinding {
    let description = format!("{found}; it fits with: {}.", best.words);
    let mut finding = SetupFinding::new(best.kind, description, evidence).stopping();
    finding.correction =
        matches!(best.kind, SetupKind::Axes | SetupKind::Latitude).then(|| Correction {
            axes: best.axes,
            latitude_deg: best.latitude_rad.to_degrees(),
        });
    // Two mistakes at once are told only if one does not explain it.
    let simple = others
        .iter()
        .filter(|other| other.mistakes <= best.mistakes);
    for other in simple.take(MOST_TOLD) {
        finding = finding.or(other.kind, other.words.clone());
    }
    finding
}

/// The vertical at the first row: the median of the first rows, turned back to it.
fn first_up(samples: &Samples<'_>, complete: &[Complete], turn: Option<&Turn>) -> Option<Vector> {
    let first_s = *samples.time_s.first()?;
    let rate = turn.map_or([0.0; 3], |turn| turn.first.rate_rad_per_s);
    let near: Vec<Vector> = complete
        .iter()
        .take(ROWS)
        .take_while(|sample| sample.time_s - first_s <= LATEST_S)
        .map(|sample| turned(sample.up, rate.map(|w| -w * (sample.time_s - first_s))))
        .collect();
    median(&near).filter(|up| dot(*up, *up) > 0.0)
}

/// The declared set-up first, then all other combinations of axes and latitude, then all
/// conventions of angles.
fn all(angles_deg: Vector, latitude_rad: f64) -> Vec<SetUp> {
    let usual = platform_c_enu(angles_deg);
    let mut latitudes = vec![(latitude_rad, String::new(), 0)];
    if latitude_rad != 0.0 {
        let words = format!("latitude {} deg", number(-latitude_rad.to_degrees()));
        latitudes.push((-latitude_rad, words, 1));
    }
    if let Some(radians) = in_degrees(latitude_rad.to_degrees()) {
        let words = format!(
            "the latitude in radians, {} deg",
            number(radians.to_degrees())
        );
        latitudes.push((radians, words, 1));
    }
    let mut set_ups = Vec::new();
    for axes in SignedAxes::all() {
        for (latitude, words, mistakes) in &latitudes {
            let is_declared_axes = axes == SignedAxes::AS_GIVEN;
            set_ups.push(SetUp {
                kind: if is_declared_axes {
                    SetupKind::Latitude
                } else {
                    SetupKind::Axes
                },
                words: match (is_declared_axes, words.is_empty()) {
                    (true, _) => words.clone(),
                    (false, true) => axes.describe(),
                    (false, false) => format!("{} and {words}", axes.describe()),
                },
                axes,
                latitude_rad: *latitude,
                platform_c_enu: usual,
                mistakes: mistakes + axes.mistakes(),
            });
        }
    }
    let by_convention = conventions(angles_deg);
    set_ups.extend(by_convention.into_iter().map(|(words, matrix)| SetUp {
        kind: SetupKind::Angles,
        words: words.to_owned(),
        axes: SignedAxes::AS_GIVEN,
        latitude_rad,
        platform_c_enu: matrix,
        mistakes: 1,
    }));
    set_ups
}

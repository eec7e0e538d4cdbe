//! Jumps of the attitude.

use gyrocal_statistics::upper_median;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::rate::{WINDOW_S, rate};
use crate::samples::{Complete, Samples};
use crate::text::{number, row, rows};
use crate::vector::{Vector, angle, median, minus, norm, plus, turned, unit};

/// A smaller jump is left to the fine diagnosis, which fits it.
const LEAST_RAD: f64 = 2.0 * core::f64::consts::PI / 180.0;

/// Rows on either side whose median counts: two of five may be wild.
const SIDE: usize = 5;

/// Rows that are farther apart have a gap between them, across which the platform drifts ...
const GAP_S: f64 = 600.0;

/// ... by at most this much more than before it, rad/s (3 deg/h, three sigmas of the usual prior).
const DRIFT_RAD_PER_S: f64 = 3.0 / 3600.0 * core::f64::consts::PI / 180.0;

/// Fastest turn of gravity, rad/s: the Earth's and the largest drift of a prior of 1 deg/h.
const FASTEST_RAD_PER_S: f64 = 20.0 / 3600.0 * core::f64::consts::PI / 180.0;

/// A jump along the way of gravity within this angle could be lost rows.
const ON_THE_WAY_RAD: f64 = 0.02;

/// Least time before a jump that is worth a calibration.
pub(crate) const LEAST_BEFORE_S: f64 = 6.0 * 3600.0;

/// A jump between two complete rows.
struct Jump {
    /// Place of the first row after it among the complete rows.
    at: usize,
    size_rad: f64,
    /// The vertical as it would be without the jump, and as it is.
    expected: Vector,
    found: Vector,
    /// The turn of gravity per second before it, rad/s, if it is known.
    rate_rad_per_s: Option<Vector>,
}

/// The first jump; the rows after it are taken out.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let mut jumps: Vec<Jump> = Vec::new();
    for at in SIDE.min(complete.len())..complete.len().saturating_sub(SIDE - 1) {
        let Some(jump) = jump_at(&complete, at) else {
            continue;
        };
        // Medians see one jump from several rows; the right one is the largest.
        match jumps.last_mut() {
            Some(last) if at - last.at < SIDE => {
                if jump.size_rad > last.size_rad {
                    *last = jump;
                }
            }
            _ => jumps.push(jump),
        }
    }
    let Some(first) = jumps.first() else {
        return Vec::new();
    };
    let (before, after) = (complete[first.at - 1], complete[first.at]);
    let more = match jumps.len() - 1 {
        0 => String::new(),
        more => format!("; {more} more follow"),
    };
    let description = format!(
        "The attitude jumps by {} deg before row {}. What follows is left out; look for a knock, \
         a restart, or rows that were lost.",
        number(first.size_rad.to_degrees()),
        row(after.row),
    );
    let evidence = format!(
        "between {} s and {} s; {} before it are used{more}",
        number(before.time_s),
        number(after.time_s),
        rows(before.row + 1),
    );
    let mut finding = SetupFinding::new(SetupKind::Jump, description, evidence)
        .at(after.row..samples.end);
    if let Some(lost_s) = lost_time_s(first) {
        let what = if lost_s > 0.0 { "lost" } else { "repeated" };
        let minutes = number(lost_s.abs() / 60.0);
        finding = finding.or(
            SetupKind::Clock,
            format!("{minutes} min of rows that were {what} without a trace in the times, or a clock that jumped by as much"),
        );
    }
    let is_short = complete[first.at - 1].time_s - complete[0].time_s < LEAST_BEFORE_S;
    samples.end = after.row;
    vec![if is_short { finding.stopping() } else { finding }]
}

/// How far the vertical on both sides of the way to a row is from a smooth way.
fn jump_at(complete: &[Complete], at: usize) -> Option<Jump> {
    let (before, after) = (&complete[at - SIDE..at], &complete[at..at + SIDE]);
    let (last, next) = (complete[at - 1], complete[at]);
    let gap_s = next.time_s - last.time_s;
    // What is no jump between two rows is none of the medians.
    let step = angle(last.up, next.up);
    if step < 0.5 * LEAST_RAD && gap_s < GAP_S {
        return None;
    }
    let slopes: Vec<Vector> = [before, after]
        .iter()
        .flat_map(|side| side.windows(2))
        .map(|pair| {
            let interval_s = pair[1].time_s - pair[0].time_s;
            minus(pair[1].up, pair[0].up).map(|change| change / interval_s)
        })
        .collect();
    let slope = median(&slopes)?;
    let middle_s = 0.5 * (last.time_s + next.time_s);
    let value = |side: &[Complete], at_s: f64| {
        let moved: Vec<Vector> = side
            .iter()
            .map(|sample| plus(sample.up, at_s - sample.time_s, slope))
            .collect();
        median(&moved)
    };
    if gap_s < GAP_S.max(2.0 * usual_interval_s(before, after)) {
        let (expected, found) = (value(before, middle_s)?, value(after, middle_s)?);
        let size_rad = norm(minus(found, expected));
        return (size_rad > LEAST_RAD).then(|| Jump {
            at,
            size_rad,
            expected: unit(expected),
            found: unit(found),
            rate_rad_per_s: (step > LEAST_RAD).then(|| rate_before(complete, at)).flatten(),
        });
    }
    let rate_rad_per_s = rate_before(complete, at);
    let from = value(before, last.time_s)?;
    let found = unit(value(after, next.time_s)?);
    let (expected, allowed) = match rate_rad_per_s {
        Some(rate) => (
            turned(unit(from), rate.map(|component| component * gap_s)),
            LEAST_RAD + DRIFT_RAD_PER_S * gap_s,
        ),
        None => (unit(from), LEAST_RAD + FASTEST_RAD_PER_S * gap_s),
    };
    let size_rad = angle(expected, found);
    (size_rad > allowed).then_some(Jump {
        at,
        size_rad,
        expected,
        found,
        rate_rad_per_s,
    })
}

fn usual_interval_s(before: &[Complete], after: &[Complete]) -> f64 {
    let pairs = [before, after];
    let pairs = pairs.iter().flat_map(|side| side.windows(2));
    let mut intervals: Vec<f64> = pairs.map(|pair| pair[1].time_s - pair[0].time_s).collect();
    upper_median(&mut intervals).unwrap_or(0.0)
}

/// The rate of gravity over the rows before a row.
fn rate_before(complete: &[Complete], at: usize) -> Option<Vector> {
    let last_s = complete[at - 1].time_s;
    let first = complete[..at].partition_point(|sample| sample.time_s < last_s - WINDOW_S);
    rate(&complete[first..at]).map(|found| found.rate_rad_per_s)
}

/// Time whose turn of gravity equals the jump, if there is one; negative if gravity went back.
fn lost_time_s(jump: &Jump) -> Option<f64> {
    /// Steps of a turn; the smallest rest lies within one of them.
    const STEPS: i32 = 720;
    let rate = jump.rate_rad_per_s?;
    let turn_s = core::f64::consts::TAU / norm(rate);
    let rest = |time_s: f64| angle(turned(jump.expected, rate.map(|w| w * time_s)), jump.found);
    let time_s = (-STEPS / 2..STEPS / 2)
        .map(|step| turn_s * f64::from(step) / f64::from(STEPS))
        .min_by(|a, b| rest(*a).total_cmp(&rest(*b)))?;
    (rest(time_s) < ON_THE_WAY_RAD).then_some(time_s)
}

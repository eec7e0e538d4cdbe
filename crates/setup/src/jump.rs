//! Jumps of the attitude.

use gyrocal_statistics::upper_median;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::prior::horizontal_sigma_deg_per_h;
use crate::rate::{WINDOW_S, rate, rates};
use crate::samples::{Complete, Samples};
use crate::text::{number, row, rows};
use crate::vector::{Vector, angle, median, minus, norm, plus, turned, unit};

/// A smaller jump is left to the fine diagnosis, which fits it.
const LEAST_RAD: f64 = 2.0 * core::f64::consts::PI / 180.0;

/// Rows on either side whose median counts: two of five may be wild.
const SIDE: usize = 5;

/// Rows that are farther apart have a gap between them, across which the platform drifts ...
const GAP_S: f64 = 600.0;

/// ... otherwise than before it by at most so many standard deviations of the prior's drift.
const DRIFT_SIGMAS: f64 = 3.0;

/// By how many usual changes between windows the rate may change across a gap, and by how much at
/// least.
const CHANGES: f64 = 2.0;
const LEAST_CHANGE_DEG_PER_H: f64 = 1.5;
const LEAST_CHANGES: usize = 3;

/// Share of the way of gravity on one side by which a straight line may miss it.
const CURVATURE: f64 = 0.1;

/// Duration of the rows on both sides beyond which straight lines say nothing of the way of gravity, which
/// turns by 60 degrees in it: rows are then 25 minutes apart or more.
const LONGEST_S: f64 = 4.0 * 3600.0;

/// Fewest rows on either side: one of three may be wild.
const LEAST_SIDE: usize = 3;

/// A rate is known from so many hours: gravity turns by 30 degrees in them.
const LEAST_KNOWN_S: f64 = 2.0 * 3600.0;

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
    for at in LEAST_SIDE..complete.len().saturating_sub(LEAST_SIDE - 1) {
        let Some(jump) = jump_at(samples, &complete, at) else {
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
    let mut finding =
        SetupFinding::new(SetupKind::Jump, description, evidence).at(after.row..samples.end);
    if let Some(lost_s) = lost_time_s(first) {
        let what = if lost_s > 0.0 { "lost" } else { "repeated" };
        let minutes = number(lost_s.abs() / 60.0);
        finding = finding.or(
            SetupKind::Clock,
            format!("{minutes} min of rows that were {what} without a trace in the times, or a clock that jumped by as much"),
        );
    }
    finding.stops = complete[first.at - 1].time_s - complete[0].time_s < LEAST_BEFORE_S;
    samples.end = after.row;
    vec![finding]
}

/// How far the vertical on both sides of the way to a row is from a smooth way.
fn jump_at(samples: &Samples<'_>, complete: &[Complete], at: usize) -> Option<Jump> {
    let (last, next) = (complete[at - 1], complete[at]);
    let gap_s = next.time_s - last.time_s;
    // What is no jump between two rows is none of the medians.
    let step = angle(last.up, next.up);
    if step < 0.5 * LEAST_RAD && gap_s < GAP_S {
        return None;
    }
    let sides = Sides::of(complete, at)?;
    if gap_s < sides.gap_s {
        let middle_s = 0.5 * (last.time_s + next.time_s);
        let expected = sides.before(middle_s)?;
        let found = sides.after(middle_s)?;
        let size_rad = norm(minus(found, expected));
        let way_rad = sides.speed_rad_per_s * (sides.after[0].time_s - sides.before[0].time_s);
        let is_straight = sides.duration_s() < LONGEST_S;
        let is_off = is_straight && size_rad > LEAST_RAD + CURVATURE * way_rad;
        // Straight lines through rows at unequal intervals miss a way that bends: its turn tells, where it is known.
        let is_turn = || {
            rate_before(complete, at).is_some()
                && across_gap(samples, complete, at, &sides).is_none()
        };
        return (is_off && !is_turn()).then(|| Jump {
            at,
            size_rad,
            expected: unit(expected),
            found: unit(found),
            rate_rad_per_s: rate_before(complete, at),
        });
    }
    across_gap(samples, complete, at, &sides)
}

/// A jump across a gap: gravity turns on at the rate before it, or at the rate after it, whichever
/// comes nearer.
fn across_gap(
    samples: &Samples<'_>,
    complete: &[Complete],
    at: usize,
    sides: &Sides<'_>,
) -> Option<Jump> {
    let (last_s, next_s) = (complete[at - 1].time_s, complete[at].time_s);
    let gap_s = next_s - last_s;
    let (from, found) = (unit(sides.before(last_s)?), unit(sides.after(next_s)?));
    let before = rate_before(complete, at)?;
    let moved = |rate: Vector| turned(from, rate.map(|component| component * gap_s));
    let expected = moved(before);
    let miss = |rate: Vector| angle(moved(rate), found);
    let size_rad =
        rate_after(complete, at).map_or(miss(before), |after| miss(before).min(miss(after)));
    let allowed = LEAST_RAD + change_rad_per_s(samples, complete) * gap_s;
    (size_rad > allowed).then_some(Jump {
        at,
        size_rad,
        expected,
        found,
        rate_rad_per_s: Some(before),
    })
}

/// By how much the rate of gravity may change across a gap, rad/s: as it changes between windows, or
/// as the prior lets it where there are too few.
fn change_rad_per_s(samples: &Samples<'_>, complete: &[Complete]) -> f64 {
    let found = rates(complete, WINDOW_S);
    let changes = found
        .windows(2)
        .map(|pair| norm(minus(pair[1].rate_rad_per_s, pair[0].rate_rad_per_s)));
    let mut changes: Vec<f64> = changes.collect();
    let least = LEAST_CHANGE_DEG_PER_H.to_radians() / 3600.0;
    if changes.len() < LEAST_CHANGES {
        let sigma = horizontal_sigma_deg_per_h(samples.bench).to_radians() / 3600.0;
        return DRIFT_SIGMAS * sigma;
    }
    let usual = upper_median(&mut changes).unwrap_or(0.0);
    (CHANGES * usual).max(least)
}

/// Rows on both sides of a place, without gaps in them.
struct Sides<'a> {
    before: &'a [Complete],
    after: &'a [Complete],
    /// Median rate of change of the vertical over both, per second.
    slope: Vector,
    /// Median of its size, which a way that bends does not shorten.
    speed_rad_per_s: f64,
    /// Rows that are farther apart have a gap between them.
    gap_s: f64,
}

impl<'a> Sides<'a> {
    fn of(complete: &'a [Complete], at: usize) -> Option<Self> {
        let before = &complete[at.saturating_sub(SIDE)..at];
        let after = &complete[at..complete.len().min(at + SIDE)];
        let gap_s = GAP_S.max(2.0 * usual_interval_s(before, after));
        let is_gap = |pair: &[Complete]| pair[1].time_s - pair[0].time_s > gap_s;
        let start = before.windows(2).rposition(is_gap).map_or(0, |gap| gap + 1);
        let end = after
            .windows(2)
            .position(is_gap)
            .map_or(after.len(), |gap| gap + 1);
        let (before, after) = (&before[start..], &after[..end]);
        let slopes: Vec<Vector> = [before, after]
            .iter()
            .flat_map(|side| side.windows(2))
            .map(|pair| {
                let interval_s = pair[1].time_s - pair[0].time_s;
                minus(pair[1].up, pair[0].up).map(|change| change / interval_s)
            })
            .collect();
        let enough = before.len() >= LEAST_SIDE && after.len() >= LEAST_SIDE;
        let slope = median(&slopes).filter(|_| enough)?;
        let mut speeds: Vec<f64> = slopes.iter().map(|slope| norm(*slope)).collect();
        Some(Self {
            before,
            after,
            slope,
            speed_rad_per_s: upper_median(&mut speeds)?,
            gap_s,
        })
    }

    /// From the first row before to the last row after.
    fn duration_s(&self) -> f64 {
        self.after[self.after.len() - 1].time_s - self.before[0].time_s
    }

    /// The vertical at a time, from the rows before.
    fn before(&self, at_s: f64) -> Option<Vector> {
        self.from(self.before, at_s)
    }

    /// The same from the rows after.
    fn after(&self, at_s: f64) -> Option<Vector> {
        self.from(self.after, at_s)
    }

    fn from(&self, side: &[Complete], at_s: f64) -> Option<Vector> {
        let moved: Vec<Vector> = side
            .iter()
            .map(|sample| plus(sample.up, at_s - sample.time_s, self.slope))
            .collect();
        median(&moved)
    }
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
    known_rate(&complete[first..at])
}

/// The rate of gravity over the rows from a row on.
fn rate_after(complete: &[Complete], at: usize) -> Option<Vector> {
    let first_s = complete[at].time_s;
    let end = complete.partition_point(|sample| sample.time_s <= first_s + WINDOW_S);
    known_rate(&complete[at..end])
}

fn known_rate(rows: &[Complete]) -> Option<Vector> {
    let span_s = rows.last()?.time_s - rows.first()?.time_s;
    let found = rate(rows).filter(|_| span_s >= LEAST_KNOWN_S)?;
    Some(found.rate_rad_per_s)
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

//! How fast gravity moves against the platform: clock unit, and platforms that do not move.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_statistics::upper_median;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::{Complete, Samples};
use crate::text::number;
use crate::vector::{angle, unit};

/// A speed outside this range over that of the Earth is of another clock.
const SOUND_SPEED: core::ops::RangeInclusive<f64> = 1.0 / 12.0..=12.0;

/// The gyros may move gravity as fast as a slow turn of the Earth near a pole: below this speed
/// nothing is said, rad/s (2.5 deg/h, latitudes beyond 80 degrees).
const LEAST_EARTH_SPEED_RAD_PER_S: f64 = 2.5 / 3600.0 * core::f64::consts::PI / 180.0;

/// Gravity of a platform that stands still against the Earth stays within this angle ...
const STILL_RAD: f64 = 0.05;

/// ... while it should have turned by this.
const EXPECTED_RAD: f64 = 0.35;

/// An angle that speed is measured over: far above noise and steps, far below a turn.
const MEASURED_RAD: f64 = 0.05;

/// Places at which it is measured.
const PLACES: usize = 500;

/// Units of time by the seconds that they hold.
const UNITS: [(f64, &str); 7] = [
    (1e-9, "nanoseconds: divide by 1e9"),
    (1e-6, "microseconds: divide by 1e6"),
    (1e-3, "milliseconds: divide by 1e3"),
    (60.0, "minutes: multiply by 60"),
    (3600.0, "hours: multiply by 3600"),
    (86_400.0, "days: multiply by 86400"),
    (1e-2, "hundredths of seconds: divide by 100"),
];

/// Median speed of the vertical against the platform, rad/s, over the smallest distance of rows,
/// doubled from one on, over which it moves visibly.
pub(crate) fn speed_rad_per_s(samples: &Samples<'_>, complete: &[Complete]) -> Option<f64> {
    let visible = MEASURED_RAD.max(20.0 * samples.sigma_g() / samples.rest_g);
    let mut lag = 1;
    loop {
        if lag >= complete.len() {
            return None;
        }
        let stride = (complete.len() / PLACES).max(1);
        let pairs = || complete.iter().zip(&complete[lag..]).step_by(stride);
        let mut angles: Vec<f64> = pairs().map(|(a, b)| angle(a.up, b.up)).collect();
        let moved = upper_median(&mut angles)?;
        if moved > visible || 4 * lag >= complete.len() {
            let mut speeds: Vec<f64> = pairs()
                .map(|(a, b)| angle(a.up, b.up) / (b.time_s - a.time_s))
                .collect();
            return upper_median(&mut speeds);
        }
        lag *= 2;
    }
}

/// A platform that stands still, or a clock in another unit.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let (Some(first), Some(last)) = (complete.first(), complete.last()) else {
        return Vec::new();
    };
    let cosine = samples.bench.latitude_deg.to_radians().cos();
    let earth = EARTH_RATE_RAD_PER_S * cosine;
    let Some(speed) = speed_rad_per_s(samples, &complete) else {
        return Vec::new();
    };
    if earth < LEAST_EARTH_SPEED_RAD_PER_S {
        return Vec::new();
    }
    let sum = complete.iter().fold([0.0; 3], |sum, sample| {
        core::array::from_fn(|axis| sum[axis] + sample.up[axis])
    });
    let middle = unit(sum);
    let mut off: Vec<f64> = complete.iter().map(|s| angle(s.up, middle)).collect();
    let extent = upper_median(&mut off).unwrap_or(0.0);
    let expected = earth * (last.time_s - first.time_s);
    if extent < STILL_RAD && expected > EXPECTED_RAD {
        return vec![still(extent, expected)];
    }
    let ratio = speed / earth;
    if SOUND_SPEED.contains(&ratio) || extent < STILL_RAD {
        return Vec::new();
    }
    vec![clock(ratio, last.time_s - first.time_s)]
}

fn still(extent: f64, expected: f64) -> SetupFinding {
    let description = "Gravity does not turn against the platform, as it does once a day against \
                       one that gyros hold in inertial space: the platform stands still on the \
                       Earth. Release it from its gimbals, or let the gyros control it."
        .to_owned();
    let evidence = format!(
        "gravity stays within {} deg, where the Earth turns by {} deg",
        number(extent.to_degrees()),
        number(expected.to_degrees())
    );
    SetupFinding::new(SetupKind::Still, description, evidence)
        .stopping()
        .or(
            SetupKind::Clock,
            "times that are far too long, in another unit",
        )
}

/// `ratio` is speed by the record's clock over that of the Earth.
fn clock(ratio: f64, span_s: f64) -> SetupFinding {
    let near = UNITS.iter().min_by(|a, b| {
        let distance = |unit: f64| (ratio / unit).ln().abs();
        distance(a.0).total_cmp(&distance(b.0))
    });
    // The speed is that of the Earth within a factor of two.
    let known = near.filter(|(unit, _)| (ratio / unit).ln().abs() < 1.0);
    let guess = known.map_or_else(
        || "Check the unit of time_s.".to_owned(),
        |(_, unit)| format!("It seems to be in {unit}."),
    );
    let description = format!("Time is not in seconds. {guess}");
    let evidence = format!(
        "gravity turns {} times as fast as the Earth turns it; the record spans {} s",
        number(ratio),
        number(span_s)
    );
    SetupFinding::new(SetupKind::Clock, description, evidence).stopping()
}

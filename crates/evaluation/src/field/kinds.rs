//! Kinds of records, with the right answer of each.

use gyrocal_truth::faults::noise::student;
use gyrocal_truth::faults::rows::{exchange_axes, jump_clock};

use super::injected::*;
use super::records::*;

/// A kind of records.
pub(super) struct FieldKind {
    /// What the records are, in words.
    pub(super) name: &'static str,
    /// Name of the right answer.
    pub(super) right: &'static str,
    pub(super) make: fn(u64) -> Result,
}

const fn kind(name: &'static str, right: &'static str, make: fn(u64) -> Result) -> FieldKind {
    FieldKind { name, right, make }
}

impl FieldKind {
    /// All kinds. New ones come last: places are the seeds of the records.
    #[rustfmt::skip]
    pub(super) const ALL: &[Self] = &[
        // sampling
        kind("rows 1 to 30 min apart, a gap of a tenth", "none", |seed| broken(seed, |b| irregular(b, 0.0))),
        kind("the same, up to 30 % of the values missing", "none", |seed| broken(seed, |b| irregular(b, 0.3))),
        kind("one bad value among 4 h of missing ones", "outliers", |seed| broken(seed, one_bad_value)),
        kind("a third of one axis missing", "none", |seed| broken(seed, third_missing)),
        kind("means of eleven minutes", "means", means),
        kind("6 hours", "none", |seed| plain(seed, |s| s.duration_s = 21_600.0)),
        kind("28 days at 10 min", "none", |seed| {
            plain(seed, |s| (s.interval_s, s.duration_s) = (600.0, 28.0 * 86_400.0))
        }),
        // place and attitude
        kind("at the equator", "none", |seed| plain(seed, |s| s.latitude_deg = 0.0)),
        kind("at 85 deg", "none", |seed| plain(seed, |s| s.latitude_deg = 85.0)),
        kind("southern, angles undeclared", "none", undeclared_south),
        kind("second angle 89.99 deg", "none", near_singular),
        // gyros
        kind("gyros of 10 to 20 deg/h", "none", |seed| coarse_gyros(seed, [10.0, 20.0])),
        kind("gyros of 20 to 60 deg/h", "none", |seed| coarse_gyros(seed, [20.0, 60.0])),
        kind("gyros of 1e-4 deg/h", "none", fine_gyros),
        kind("two steps of a gyro", "steps_2", |seed| steps(seed, &[[0.15, 0.45], [0.2, 0.4]], false)),
        kind("three steps of a gyro", "steps_3", |seed| {
            steps(seed, &[[0.1, 0.3], [0.15, 0.3], [0.15, 0.3]], false)
        }),
        kind("a step of a gyro that goes back", "steps_2", |seed| {
            steps(seed, &[[0.15, 0.5], [0.15, 0.4]], true)
        }),
        kind("a step in a gap of 8 h", "step", step_in_gap),
        kind("a pulse of a gyro of 1 to 3 h", "pulse", |seed| pulses(seed, 1)),
        kind("a drift that comes and goes", "pulses", |seed| pulses(seed, 7)),
        kind("waves of 24, 12 and 8 h in a gyro", "waves", harmonics),
        kind("a gyro with the temperature of 3 h ago", "lag", lagging_temperature),
        kind("a warm-up of 0.35 to 1.5 records", "warm_up", slow_warm_up),
        // accelerometers
        kind("scale, bias and axis of an accelerometer", "accelerometer", accelerometer),
        kind("an accelerometer clipped before noise of t4", "clipped", clipped),
        kind("noise of t3", "outliers", |seed| noisy(seed, |random, _| student(random, 3))),
        kind("noise that grows threefold", "loud", |seed| {
            noisy(seed, |random, share| (1.0 + 2.0 * share) * random.normal())
        }),
        kind("a least significant bit of 20 sigma", "coarse", coarse_bits),
        // handling
        kind("two channels exchanged midway", "axes", |seed| {
            broken(seed, |b| exchange_axes(b, b.record.len() / 2))
        }),
        kind("the clock jumps by 2 s", "clock", |seed| broken(seed, |b| jump_clock(b, [2.0; 2]))),
        kind("the clock jumps by 3600 s", "clock_jump", |seed| broken(seed, |b| jump_clock(b, [3600.0; 2]))),
        kind("the clock 50 ppm fast, jitter of 0.3 s", "clock_rate", clock_rate),
        kind("a knock of 5 to 20 deg", "knock", |seed| knock(seed, [5.0, 20.0], None)),
        kind("a knock of 0.4 deg and a ramp", "knock_and_ramp", |seed| knock(seed, [0.4, 0.4], Some(20.0))),
        kind("aligned anew by 40 deg and a ramp", "knock_and_ramp", |seed| {
            knock(seed, [40.0, 40.0], Some(80.0))
        }),
        // two records
        kind("two records of one platform", "none", |seed| two(seed, [0.0; 3])),
        kind("records of two platforms", "platforms", |seed| two(seed, [0.01; 3])),
        kind("records of two turn-ons", "turn_on", |seed| two(seed, [0.003, 0.0, 0.0])),
        kind("the second of two records in m/s^2", "unit", second_in_other_unit),
    ];
}

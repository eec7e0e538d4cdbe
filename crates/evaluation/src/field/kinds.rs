//! Kinds of records, with the right answer of each.

use gyrocal_truth::faults::noise::student;
use gyrocal_truth::faults::rows::{exchange_axes, jump_clock};

use super::injected::*;
use super::records::*;
use super::right::{Right, SEVERAL, Silent, UNLISTED};

/// A kind of records.
pub(super) struct FieldKind {
    /// What the records are, in words.
    pub(super) name: &'static str,
    pub(super) right: &'static Right,
    pub(super) make: fn(u64) -> Result,
}

const NONE: Right = Right::NOTHING;
const TAILS: &[&str] = &["accel.outliers", "accel_i.noise"];
const OUTLIERS: Right = Right::told(&[TAILS]).beside(TAILS).silent(Silent::Always);
const LOUD: Right = Right::told(&[&["accel_i.noise"]]).beside(TAILS);
const COARSE: Right =
    Right::told(&[&["accel_i.quantisation"]]).beside(&["accel_i.quantisation", "accel_i.noise"]);
const WALK: &[&str] = &["gyro_i.random_walk"];
const STEP: Right = Right::in_set(&[&["gyro_i.step"]]).near(WALK);
const STEPS_2: Right = Right::in_set(&[&["gyro_i.step"], &["gyro_i.step"]]).near(WALK);
const STEPS_3: Right =
    Right::in_set(&[&["gyro_i.step"], &["gyro_i.step"], &["gyro_i.step"]]).near(WALK);
const PULSE: Right = STEPS_2
    .or_whole(&[UNLISTED])
    .near(&["gyro_i.random_walk", "platform.knock"]);
const PULSES: Right = Right::in_set(&[&[UNLISTED, "gyro_i.step"]])
    .near(WALK)
    .beside(&[UNLISTED, "gyro_i.step"]);
const WAVES: Right = Right::in_set(&[&["gyro_i.diurnal"]])
    .or_whole(&[UNLISTED])
    .near(WALK);
const THERMAL: &[&str] = &[
    "gyro_i.temperature",
    "gyro_i.temperature_rate",
    "gyro_i.temperature_hysteresis",
    UNLISTED,
];
const LAG: Right = Right::in_set(&[THERMAL])
    .near(&["gyro_i.diurnal"])
    .beside(THERMAL);
const WARM_UP: Right = Right::in_set(&[&["gyro_i.warmup"]]);
const ACCELEROMETER: Right = Right::in_set(&[
    &["accel_i.scale"],
    &["accel_i.bias"],
    &["accel_ij.nonorthogonality"],
]);
const PLATFORMS: Right = Right::told(&[&[SEVERAL]]);
const TURN_ON: Right = Right::told(&[&["turn-on", SEVERAL]]).near(&["gyro_i.step"]);
const CLIPPED: Right = Right::told(&[&["clipped"]]).beside(TAILS);
const AXES: Right = Right::told(&[&["axes", "jump"]]);
const CLOCK: Right = Right::told(&[&["clock"]]).near(&["platform.knock"]);
const CLOCK_JUMP: Right = Right::told(&[&["clock", "jump"]]);
const CLOCK_RATE: Right = Right::told(&[&["clock", "site.latitude"]])
    .beside(&["accel_i.noise", "gyro_i.noise"])
    .silent(Silent::Always);
const KNOCK: Right = Right::told(&[&["jump", "platform.knock"]]);
const KNOCK_AND_RAMP: Right = Right::in_set(&[&["jump", "platform.knock"], &["gyro_i.ramp"]]);
const UNIT: Right = Right::told(&[&["unit"]]);
const MEANS: Right = Right::told(&[&["gravity", "scale"]])
    .near(&["accel_i.scale"])
    .silent(Silent::Always);

const fn kind(name: &'static str, right: &'static Right, make: fn(u64) -> Result) -> FieldKind {
    FieldKind { name, right, make }
}

impl FieldKind {
    /// All kinds. New ones come last: places are the seeds of the records.
    #[rustfmt::skip]
    pub(super) const ALL: &[Self] = &[
        // sampling
        kind("rows 1 to 30 min apart, a gap of a tenth", &NONE, |seed| broken(seed, |b| irregular(b, 0.0))),
        kind("the same, up to 30 % of the values missing", &NONE, |seed| broken(seed, |b| irregular(b, 0.3))),
        kind("one bad value among 4 h of missing ones", &OUTLIERS, |seed| broken(seed, one_bad_value)),
        kind("a third of one axis missing", &NONE, |seed| broken(seed, third_missing)),
        kind("means of eleven minutes", &MEANS, means),
        kind("6 hours", &NONE, |seed| plain(seed, |s| s.duration_s = 21_600.0)),
        kind("28 days at 10 min", &NONE, |seed| {
            plain(seed, |s| (s.interval_s, s.duration_s) = (600.0, 28.0 * 86_400.0))
        }),
        // place and attitude
        kind("at the equator", &NONE, |seed| plain(seed, |s| s.latitude_deg = 0.0)),
        kind("at 85 deg", &NONE, |seed| plain(seed, |s| s.latitude_deg = 85.0)),
        kind("southern, angles undeclared", &NONE, undeclared_south),
        kind("second angle 89.99 deg", &NONE, near_singular),
        // gyros
        kind("gyros of 10 to 20 deg/h", &NONE, |seed| coarse_gyros(seed, [10.0, 20.0])),
        kind("gyros of 20 to 60 deg/h", &NONE, |seed| coarse_gyros(seed, [20.0, 60.0])),
        kind("gyros of 1e-4 deg/h", &NONE, fine_gyros),
        kind("two steps of a gyro", &STEPS_2, |seed| steps(seed, &[[0.15, 0.45], [0.2, 0.4]], false)),
        kind("three steps of a gyro", &STEPS_3, |seed| {
            steps(seed, &[[0.1, 0.3], [0.15, 0.3], [0.15, 0.3]], false)
        }),
        kind("a step of a gyro that goes back", &STEPS_2, |seed| {
            steps(seed, &[[0.15, 0.5], [0.15, 0.4]], true)
        }),
        kind("a step in a gap of 8 h", &STEP, step_in_gap),
        kind("a pulse of a gyro of 1 to 3 h", &PULSE, |seed| pulses(seed, 1)),
        kind("a drift that comes and goes", &PULSES, |seed| pulses(seed, 7)),
        kind("waves of 24, 12 and 8 h in a gyro", &WAVES, harmonics),
        kind("a gyro with the temperature of 3 h ago", &LAG, lagging_temperature),
        kind("a warm-up of 0.35 to 1.5 records", &WARM_UP, slow_warm_up),
        // accelerometers
        kind("scale, bias and axis of an accelerometer", &ACCELEROMETER, accelerometer),
        kind("an accelerometer clipped before noise of t4", &CLIPPED, clipped),
        kind("noise of t3", &OUTLIERS, |seed| noisy(seed, |random, _| student(random, 3))),
        kind("noise that grows threefold", &LOUD, |seed| {
            noisy(seed, |random, share| (1.0 + 2.0 * share) * random.normal())
        }),
        kind("a least significant bit of 20 sigma", &COARSE, coarse_bits),
        // handling
        kind("two channels exchanged midway", &AXES, |seed| {
            broken(seed, |b| exchange_axes(b, b.record.len() / 2))
        }),
        kind("the clock jumps by 2 s", &CLOCK, |seed| broken(seed, |b| jump_clock(b, [2.0; 2]))),
        kind("the clock jumps by 3600 s", &CLOCK_JUMP, |seed| broken(seed, |b| jump_clock(b, [3600.0; 2]))),
        kind("the clock 50 ppm fast, jitter of 0.3 s", &CLOCK_RATE, clock_rate),
        kind("a knock of 5 to 20 deg", &KNOCK, |seed| knock(seed, [5.0, 20.0], None)),
        kind("a knock of 0.4 deg and a ramp", &KNOCK_AND_RAMP, |seed| knock(seed, [0.4, 0.4], Some(20.0))),
        kind("aligned anew by 40 deg and a ramp", &KNOCK_AND_RAMP, |seed| {
            knock(seed, [40.0, 40.0], Some(80.0))
        }),
        // two records
        kind("two records of one platform", &NONE, |seed| two(seed, [0.0; 3])),
        kind("records of two platforms", &PLATFORMS, |seed| two(seed, [0.01; 3])),
        kind("records of two turn-ons", &TURN_ON, |seed| two(seed, [0.003, 0.0, 0.0])),
        kind("the second of two records in m/s^2", &UNIT, second_in_other_unit),
    ];
}

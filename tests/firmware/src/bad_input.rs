//! Input that has no meaning: each must be answered as documented, and leave the filter as it was.

use gyrocal::{ControllerError, Integration};

use crate::filter::Filter;
use crate::record::{INTERVAL_S, Number, Record};
use crate::replay::{Digest, attitude, settings};

/// Names of the cases, in the order of [`answers`].
pub const CASES: [&str; 18] = [
    "sample_nan",
    "sample_infinite",
    "sample_out_of_range",
    "interval_zero",
    "interval_negative",
    "interval_nan",
    "interval_huge",
    "interval_infinite",
    "before_start",
    "settings_without_noise",
    "saved_length",
    "saved_version",
    "saved_checksum",
    "saved_not_positive_definite",
    "failure_stops",
    "restore_continues",
    "sample_surprising",
    "settings_without_gravity",
];

/// Whether each case was answered as documented.
#[must_use]
pub fn answers(filter: &mut Filter) -> [bool; CASES.len()] {
    let good = Record.sample(0);
    let before_start = filter.step(INTERVAL_S, &good) == Err(ControllerError::NotRunning);
    let mut bad = settings(Integration::RK4);
    bad.accel_noise_g = 0.0;
    let without_noise = matches!(
        filter.start(&bad, &attitude()),
        Err(ControllerError::Settings(_))
    ) && !filter.is_running();
    let started = filter
        .start(&settings(Integration::RK4), &attitude())
        .is_ok()
        && filter.update(&good).is_ok();
    let [nan, infinite] = [Number::NAN, Number::INFINITY];
    let refused = |filter: &mut Filter, interval, sample, expected| {
        let before = digest(filter);
        started && filter.step(interval, &sample) == Err(expected) && digest(filter) == before
    };
    let [x, y, z] = good;
    let mut of_sample = |sample, expected| refused(filter, INTERVAL_S, sample, expected);
    let samples = [
        of_sample([nan, y, z], ControllerError::SampleNotFinite { axis: 0 }),
        of_sample(
            [x, y, -infinite],
            ControllerError::SampleNotFinite { axis: 2 },
        ),
        of_sample([x, 2.1, z], ControllerError::SampleOutOfRange { axis: 1 }),
    ];
    let mut of_interval = |interval, expected| refused(filter, interval, good, expected);
    let intervals = [
        of_interval(0.0, ControllerError::IntervalNotPositive),
        of_interval(-60.0, ControllerError::IntervalNotPositive),
        of_interval(nan, ControllerError::IntervalNotPositive),
        of_interval(1e9, ControllerError::IntervalTooLong),
        of_interval(infinite, ControllerError::IntervalTooLong),
    ];
    let surprising = [surprising(filter), without_gravity(filter)];
    let saved = saved_states(filter);
    let failure = failures(filter);
    let mut all = [before_start; CASES.len()];
    let others = [before_start, without_noise];
    let in_order = samples.iter().chain(&intervals).chain(&others);
    let in_order = in_order.chain(&saved).chain(&failure).chain(&surprising);
    for (place, answer) in all.iter_mut().zip(in_order) {
        *place = *answer;
    }
    all
}

fn digest(filter: &Filter) -> u64 {
    let mut digest = Digest::default();
    filter.numbers(&mut |number| digest.add(number));
    digest.0
}

/// A sample in range that disagrees with the state: it is not taken, and time passes as by coasting.
fn surprising(filter: &mut Filter) -> bool {
    let mut saved = [0; Filter::SAVED_BYTES];
    if filter.save(&mut saved).is_err() {
        return false;
    }
    let [x, y, z] = Record.sample(0);
    let answer = filter.step(INTERVAL_S, &[x + 0.02, y, z]);
    let passed = digest(filter);
    answer == Err(ControllerError::SampleSurprising)
        && filter.restore(&saved).is_ok()
        && filter.coast(INTERVAL_S).is_ok()
        && digest(filter) == passed
        && filter.restore(&saved).is_ok()
}

/// A gravity of zero is refused at the start; the filter is then as it was.
fn without_gravity(filter: &mut Filter) -> bool {
    let mut saved = [0; Filter::SAVED_BYTES];
    let kept = filter.save(&mut saved).is_ok();
    let mut bad = settings(Integration::RK4);
    bad.site.gravity_g = 0.0;
    let refused = matches!(
        filter.start(&bad, &attitude()),
        Err(ControllerError::Settings(_))
    );
    let started = filter.start(&settings(Integration::RK4), &attitude());
    kept && refused && started.is_ok() && filter.restore(&saved).is_ok()
}

fn saved_states(filter: &mut Filter) -> [bool; 4] {
    let mut saved = [0; Filter::SAVED_BYTES];
    if filter.save(&mut saved).is_err() {
        return [false; 4];
    }
    let before = digest(filter);
    let mut refused =
        |saved: &[u8], expected| filter.restore(saved) == Err(expected) && digest(filter) == before;
    let expected = Filter::SAVED_BYTES;
    let short = saved
        .split_at_checked(100)
        .map_or(&[][..], |(head, _)| head);
    let length = refused(short, ControllerError::SavedLength { expected });
    let mut other = saved;
    other[4] ^= 2;
    let version = refused(&other, ControllerError::SavedVersion);
    let mut flipped = saved;
    flipped[200] ^= 16;
    let checksum = refused(&flipped, ControllerError::SavedChecksum);
    // The sign of the first variance, with a checksum that is right again.
    let number = size_of::<Number>();
    let mut negative = saved;
    negative[16 + (12 + 12 + 1) * number - 1] ^= 0x80;
    seal(&mut negative);
    let definite = refused(&negative, ControllerError::SavedNumbers);
    [length, version, checksum, definite]
}

/// The checksum of the format, computed here again (CRC-32 of IEEE 802.3).
fn seal(saved: &mut [u8]) {
    let Some((sealed, place)) = saved.split_last_chunk_mut::<4>() else {
        return;
    };
    let mut checksum = !0_u32;
    for bit in sealed
        .iter()
        .flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1))
    {
        let out = (checksum ^ u32::from(bit)) & 1;
        checksum = (checksum >> 1) ^ if out == 1 { 0xedb8_8320 } else { 0 };
    }
    *place = (!checksum).to_le_bytes();
}

/// A step that fails: a drift so large that the transition of the attitude overflows.
fn failures(filter: &mut Filter) -> [bool; 2] {
    let mut saved = [0; Filter::SAVED_BYTES];
    if filter.save(&mut saved).is_err() {
        return [false; 2];
    }
    let before = digest(filter);
    let mut wide = settings(Integration::RK4);
    wide.drift.gyro_x_bias = Number::MAX;
    let started = filter.start(&wide, &attitude()).is_ok();
    let failed = matches!(
        filter.step(INTERVAL_S, &Record.sample(0)),
        Err(ControllerError::Failed(_))
    );
    let stopped = filter.step(INTERVAL_S, &Record.sample(0)) == Err(ControllerError::NotRunning);
    let restored = filter
        .start(&settings(Integration::RK4), &attitude())
        .is_ok()
        && filter.restore(&saved).is_ok()
        && digest(filter) == before
        && filter.step(INTERVAL_S, &Record.sample(1)).is_ok();
    [started && failed && stopped, restored]
}

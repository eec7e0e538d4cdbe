//! The record again, by the filter with its watch: instructions of both, and of the watch alone.

#![cfg_attr(target_os = "none", no_std, no_main)]

use gyrocal::watch::{EFFECTS_BY_DEFAULT, PlatformWatch, WatchSettings};
use gyrocal::{Integration, Limits};
use gyrocal_firmware_test::{Digest, INTERVAL_S, Number, Record, attitude, settings};

/// What a replay says of itself.
trait Console {
    fn number(&mut self, name: &str, number: u32);
    fn digest(&mut self, row: usize, digest: u64);
}

/// Replays the record; `timed` runs a step and gives its instructions.
fn replay(
    watched: &mut PlatformWatch<Number>,
    console: &mut impl Console,
    mut timed: impl FnMut(&mut dyn FnMut()) -> u32,
) {
    let started = watched.start(
        &settings(Integration::RK4),
        &attitude(),
        Limits::default(),
        &WatchSettings::default(),
    );
    if started.is_err() || watched.update(&Record.sample(0)).is_err() {
        return console.number("error", 0);
    }
    let mut digest = Digest::default();
    let (mut most, mut sum, mut alarms) = (0, 0_u64, 0);
    for row in 1..Record.len() {
        let sample = Record.sample(row);
        let mut result = None;
        let count = timed(&mut || result = Some(watched.step(INTERVAL_S, &sample)));
        let Some(Ok(step)) = result else {
            return console.number("error", row as u32);
        };
        alarms += u32::from(step.alarm.is_some());
        most = most.max(count);
        sum += u64::from(count);
        for number in watched.evidence() {
            digest.add(number);
        }
        digest.add(step.innovation.nis);
        if row % 720 == 0 {
            console.digest(row, digest.0);
        }
    }
    watched.candidates(|_, candidate| {
        digest.add(candidate.estimate);
        digest.add(candidate.sigma);
    });
    console.digest(Record.len(), digest.0);
    console.number("alarms", alarms);
    let steps = Record.len() as u64 - 1;
    console.number("steps", steps as u32);
    console.number("instructions most", most);
    let mean = sum.checked_div(steps).unwrap_or(0);
    console.number("instructions mean", mean as u32);
    console.number("size watched", size_of::<PlatformWatch<Number>>() as u32);
    console.number("effects", EFFECTS_BY_DEFAULT.len() as u32 + 3);
}

#[cfg(not(target_os = "none"))]
fn main() {
    struct Lines;
    impl Console for Lines {
        fn number(&mut self, name: &str, number: u32) {
            println!("{name} {number}");
        }
        fn digest(&mut self, row: usize, digest: u64) {
            println!("digest {row} {digest:016x}");
        }
    }
    let mut watched = PlatformWatch::unset(&EFFECTS_BY_DEFAULT);
    replay(&mut watched, &mut Lines, |step| {
        step();
        0
    });
}

#[cfg(target_os = "none")]
mod target {
    use core::cell::UnsafeCell;

    use gyrocal_board::{Counter, firmware, print, print_decimal, print_hexadecimal, used_by};

    use super::*;

    struct Place(UnsafeCell<PlatformWatch<Number>>);

    // SAFETY: there is one thread and no interrupt.
    unsafe impl Sync for Place {}

    static WATCHED: Place = Place(UnsafeCell::new(PlatformWatch::unset(&EFFECTS_BY_DEFAULT)));

    firmware!(run);

    struct Lines;

    impl Console for Lines {
        fn number(&mut self, name: &str, number: u32) {
            print(name);
            print(" ");
            print_decimal(number);
            print("\n");
        }
        fn digest(&mut self, row: usize, digest: u64) {
            print("digest ");
            print_decimal(row as u32);
            print(" ");
            print_hexadecimal(digest, 16);
            print("\n");
        }
    }

    fn run() {
        // SAFETY: the only reference, in the only function that takes it.
        let watched = unsafe { &mut *WATCHED.0.get() };
        let nothing = used_by(|| ());
        let mut stack = 0;
        let mut row = 0;
        replay(watched, &mut Lines, |step| {
            row += 1;
            if row % 487 == 0 {
                stack = stack.max(used_by(&mut *step).saturating_sub(nothing));
                return 0;
            }
            let empty = Counter::start().ticks();
            let counter = Counter::start();
            step();
            // Ticks of 40 ns; QEMU is told to let an instruction take 64 ns.
            (counter.ticks() - empty) * 5 / 8
        });
        Lines.number("stack step", stack);
    }
}

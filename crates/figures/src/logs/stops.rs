//! Stops of hand-held tests.

use core::ops::Range;

use gyrocal_instruments::{InstrumentError, Log, StopSettings, find_stops};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::{UnitErrors, hand_held, vector};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::logs;
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const MOTION: u64 = 1805;

const STOPS: usize = 20;
const RATE_HZ: f64 = 100.0;

/// Result for one test: for each true stop whether it was found, and the number of false ones.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Found {
    stops: Vec<bool>,
    false_stops: usize,
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let rows = [
        Row::each(
            format!("hand-held tests of {STOPS} stops: stops found"),
            |test: &Found| test.stops.clone(),
        )
        .at_least(0.98, "one stop of two tests and a half may be set again"),
        Row::count("the same: false stops", |test: &Found| test.false_stops)
            .at_most(0.0, "a false stop is a wrong equation of the fit"),
    ];
    context.measure(&logs("stops", [840_000, 50, 6], test), &rows)
}

/// A test in the hand: tremor of 0.3 to 1 deg/s rms about each axis, biases of half a degree a second.
fn test(seed: u64) -> Result<Found, InstrumentError> {
    let mut draw = Draw::new(seed, MOTION);
    let unit = UnitErrors {
        gyro_bias: vector(&mut draw) * 0.5_f64.to_radians(),
        gyro_g: Matrix3::zeros(),
        gyro_gg: Vector3::zeros(),
        accel_bias: vector(&mut draw) * 0.02,
        accel_matrix: Matrix3::identity(),
        gyro_noise: 2e-3,
        accel_noise: 2e-3,
    };
    let tremor = draw.log_uniform([0.3, 1.0]).to_radians();
    let made = hand_held(&unit, STOPS, RATE_HZ, tremor, &mut draw);
    let log = Log::from_samples(1.0 / RATE_HZ, made.gyro, made.accel);
    let found = find_stops(&log, &StopSettings::default())?;
    let overlap = |one: &Range<usize>, other: &Range<usize>| {
        let end = one.end.min(other.end);
        end.saturating_sub(one.start.max(other.start))
    };
    // A found stop belongs to the true one that most of it lies in.
    let belongs =
        |found: &Range<usize>, truth: &Range<usize>| 5 * overlap(found, truth) >= 4 * found.len();
    let stops = made.stops.iter().map(|truth| {
        let of_it = found.iter().filter(|found| belongs(found, truth));
        // As one, and not in pieces.
        of_it.count() == 1
    });
    let is_false = |found: &&Range<usize>| !made.stops.iter().any(|truth| belongs(found, truth));
    Ok(Found {
        stops: stops.collect(),
        false_stops: found.iter().filter(is_false).count(),
    })
}

//! Stops of hand-held tests.

use core::ops::Range;

use gyrocal_instruments::{InstrumentError, Log, StopSettings, find_stops};
use gyrocal_statistics::deviates::Draw;
use gyrocal_testkit::position_test::{UnitErrors, hand_held};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::at_least;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// Purpose of the stream of draws.
const MOTION: u64 = 1805;

const FIRST_SEED: u64 = 840_000;
const RECORDS: u64 = 50;
const SMALL: u64 = 6;
const STOPS: usize = 20;
const RATE_HZ: f64 = 100.0;

/// Result for one test: for each true stop whether it was found, and the number of false ones.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Found {
    stops: Vec<bool>,
    false_stops: usize,
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(RECORDS, SMALL);
    let campaign = resumable::campaign("logs", "stops", seeds.clone(), small)?;
    let outcome = campaign.run(test, |_| ())?;
    let seeds = format!("{seeds:?}");
    let all = outcome
        .successes()
        .flat_map(|(_, found)| found.stops.iter().copied());
    let name = format!("hand-held tests of {STOPS} stops: stops found");
    let found = at_least(&name, 0.98, all, &seeds, small);
    let false_stops: usize = outcome
        .successes()
        .map(|(_, found)| found.false_stops)
        .sum();
    let tests = outcome.successes().count();
    let mut none = Figure::within("the same: false stops", [0.0, 0.0], false_stops as f64);
    none.target = "0".to_owned();
    none.measured = false_stops.to_string();
    Ok(vec![found, none.over(tests, seeds)])
}

/// A test in the hand: tremor of 0.3 to 1 deg/s rms about each axis, biases of half a degree a second.
fn test(seed: u64) -> Result<Found, InstrumentError> {
    let mut draw = Draw::new(seed, MOTION);
    let mut vector = |size: f64| Vector3::new(draw.normal(), draw.normal(), draw.normal()) * size;
    let unit = UnitErrors {
        gyro_bias: vector(0.5_f64.to_radians()),
        gyro_g: Matrix3::zeros(),
        gyro_gg: Vector3::zeros(),
        accel_bias: vector(0.02),
        accel_matrix: Matrix3::identity(),
        gyro_noise: 2e-3,
        accel_noise: 2e-3,
    };
    let tremor = draw.log_uniform([0.3, 1.0]).to_radians();
    let made = hand_held(&unit, STOPS, RATE_HZ, tremor, &mut draw);
    let log = Log::from_samples(1.0 / RATE_HZ, made.gyro, made.accel);
    let found = find_stops(&log, &StopSettings::default())?;
    let overlap = |one: &Range<usize>, other: &Range<usize>| {
        one.end
            .min(other.end)
            .saturating_sub(one.start.max(other.start))
    };
    // A found stop belongs to the true one that most of it lies in.
    let belongs =
        |found: &Range<usize>, truth: &Range<usize>| 5 * overlap(found, truth) >= 4 * found.len();
    let stops = made.stops.iter().map(|truth| {
        let of_it = found.iter().filter(|found| belongs(found, truth));
        // As one, and not in pieces.
        of_it.count() == 1
    });
    let false_stops = found
        .iter()
        .filter(|found| !made.stops.iter().any(|truth| belongs(found, truth)));
    Ok(Found {
        stops: stops.collect(),
        false_stops: false_stops.count(),
    })
}

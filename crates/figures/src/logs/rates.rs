//! Logs in the rate domain: static ones, two positions, and a turntable.

use gyrocal_instruments::rates::{RateReport, RateSettings, evaluate_rates};
use gyrocal_instruments::{InstrumentError, Log};
use gyrocal_record::AXES;
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::vector;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::unit::{ACCEL_NOISE_G, DEG_PER_H, EARTH_DEG_PER_H, LEVEL_RAD, Unit};
use super::{OVER_PROJECTION, OVER_PROJECTION_REASON, described, logs};
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const ERRORS: u64 = 1805;

/// A degree per second in deg/h.
const DEG_PER_S: f64 = 3600.0;

const LONGEST_S: f64 = 86_400.0;

/// Longest log of the small version.
const LONGEST_SMALL_S: f64 = 900.0;

/// Result of a static log.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Static {
    /// Whether the intervals of the biases contain the truth.
    biases: [bool; 3],
    /// Whether that of the vertical rate, Earth rate and bias, does.
    vertical: bool,
    /// Whether an effect was found, though none is there.
    effect: bool,
}

/// Result of two positions: error and standard deviation of the vertical bias \[deg/h\].
#[derive(Clone, Debug, Serialize, Deserialize)]
struct TwoPositions {
    evaluated: [f64; 2],
    projection: [f64; 2],
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    // Days of 100 Hz are no part of the small version, whose results are not kept.
    let longest_s = match context.is_small() {
        true => LONGEST_SMALL_S,
        false => LONGEST_S,
    };
    let job = move |seed| static_log(seed, longest_s);
    let statics = logs("rates-static", [860_000, 500, 12], job);
    let mut figures = context.measure(&statics, &of_static())?;
    let two = logs("rates-two", [870_000, 500, 20], two_positions);
    figures.extend(context.measure(&two, &of_two_positions())?);
    let table = logs("rates-table", [880_000, 300, 8], table_test);
    let name = "turntable, 6 attitudes: coverage of scales, misalignments, biases, g terms";
    let row = Row::each(name, |hits: &Vec<bool>| hits.clone()).of_coverage();
    figures.extend(context.measure(&table, &[row])?);
    Ok(figures)
}

fn of_static() -> [Row<'static, Static>; 3] {
    let biases = "static logs of 100 Hz, biases to 5 deg/s: coverage of the biases";
    let vertical = "the same: coverage of the vertical rate, Earth rate and bias";
    let without = "the same: logs without a false effect in time";
    [
        Row::each(biases, |log: &Static| log.biases).of_coverage(),
        Row::share(vertical, |log: &Static| Some(log.vertical)).of_coverage(),
        Row::share(without, |log: &Static| Some(!log.effect)),
    ]
}

/// A unit of any grade at rest, with a bias in proportion to its noise.
fn static_log(seed: u64, longest_s: f64) -> Result<Static, InstrumentError> {
    let mut draw = Draw::new(seed, ERRORS);
    let seconds = draw.log_uniform([600.0, longest_s]) as usize;
    let white = draw.log_uniform([1.0, 100.0]);
    let mut bias = || draw.sign() * draw.log_uniform([1e-3 * DEG_PER_S, 5.0 * DEG_PER_S]);
    let unit = Unit {
        bias: Vector3::from([(); 3].map(|()| bias())),
        ..Unit::of_any_grade(white, &mut draw)
    };
    let up = vector(&mut draw).normalize();
    let made = unit.log(up, [seconds, 100], |_| 0.0, &mut draw, seed);
    let report = evaluated(&[made.log], &unit, "")?;
    let log = &report.logs[0];
    let [rate, sigma] = log.vertical_deg_per_h.unwrap_or([f64::NAN; 2]);
    let vertical = unit.vertical_earth() + up.dot(&made.mean_bias);
    Ok(Static {
        biases: core::array::from_fn(|gyro| {
            let error = log.bias_deg_per_h[gyro] - made.mean_bias[gyro];
            error.abs() <= log.bias_half_width_deg_per_h[gyro]
        }),
        vertical: (rate - vertical).abs() <= NORMAL_97_5 * sigma,
        effect: report.gyros.iter().any(|gyro| !gyro.effects.is_empty()),
    })
}

fn of_two_positions() -> [Row<'static, TwoPositions>; 3] {
    let beside = |what: &str, part: usize| {
        let name =
            format!("two-position tests, vertical component: {what} over that of projection");
        let both = move |test: &TwoPositions| Some([test.evaluated[part], test.projection[part]]);
        Row::rms_ratio(name, both).at_most(OVER_PROJECTION, OVER_PROJECTION_REASON)
    };
    let covered = |test: &TwoPositions| {
        let [error, sigma] = test.evaluated;
        Some(error.abs() <= NORMAL_97_5 * sigma)
    };
    let name = "two-position tests: coverage of the bias along the turned axis";
    let coverage = Row::share(name, covered).of_coverage();
    [coverage, beside("rms error", 0), beside("sigma", 1)]
}

/// A navigation-grade unit for half an hour up and half an hour down.
fn two_positions(seed: u64) -> Result<TwoPositions, InstrumentError> {
    const SECONDS: usize = 1800;
    let mut draw = Draw::new(seed, ERRORS);
    let white = draw.log_uniform([0.3, 3.0]);
    let unit = Unit {
        bias: 0.3 * vector(&mut draw),
        white,
        quantisation: white * draw.log_uniform([0.1, 1.0]),
        flicker: white * draw.log_uniform([1e-3, 1e-2]),
        walk: white * draw.log_uniform([1e-5, 1e-4]),
        accel: [LEVEL_RAD, ACCEL_NOISE_G],
        latitude_deg: 45.0,
        ..Unit::default()
    };
    let up = (Vector3::z() + 0.1 * vector(&mut draw)).normalize();
    let (mut errors, mut sigmas, mut of_means) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for (position, up) in [up, -up].into_iter().enumerate() {
        let number = 2 * seed + position as u64;
        let made = unit.log(up, [SECONDS, 10], |_| 0.0, &mut draw, number);
        let rates = made.log.gyro.iter();
        let sum: f64 = rates.map(|rate| up.dot(&Vector3::from(*rate))).sum();
        let truth = unit.vertical_earth() + up.dot(&made.mean_bias);
        of_means[position] = sum / made.log.len() as f64 / DEG_PER_H - truth;
        let report = evaluated(&[made.log], &unit, "")?;
        let vertical = report.logs[0].vertical_deg_per_h;
        let [rate, sigma] = vertical.unwrap_or([f64::NAN; 2]);
        (errors[position], sigmas[position]) = (rate - truth, sigma);
    }
    let half = |of: [f64; 2]| 0.5 * (of[0] - of[1]);
    let duration_s = SECONDS as f64;
    let fast = unit.white.powi(2) / duration_s + 2.0 * (unit.quantisation / duration_s).powi(2);
    let level = LEVEL_RAD * EARTH_DEG_PER_H * unit.latitude_deg.to_radians().cos();
    Ok(TwoPositions {
        evaluated: [half(errors), 0.5 * sigmas[0].hypot(sigmas[1])],
        projection: [half(of_means), (0.5 * (fast + level * level)).sqrt()],
    })
}

/// A unit with each axis up and down on a table that rests, turns to either side, and rests.
fn table_test(seed: u64) -> Result<Vec<bool>, InstrumentError> {
    const PHASE_S: usize = 60;
    let mut draw = Draw::new(seed, ERRORS);
    let matrix = |size: f64, draw: &mut Draw| Matrix3::from_fn(|_, _| size * draw.normal());
    let white = draw.log_uniform([3.0, 30.0]);
    let unit = Unit {
        bias: 0.1 * DEG_PER_S * vector(&mut draw),
        matrix_error: matrix(5e-3, &mut draw),
        of_force: matrix(30.0, &mut draw),
        ..Unit::of_any_grade(white, &mut draw)
    };
    let rate = draw.log_uniform([5.0, 50.0]).to_radians();
    let table = |second: usize| rate * [0.0, 1.0, -1.0, 0.0][(second / PHASE_S).min(3)];
    let faces = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut logs = Vec::new();
    for (number, up) in faces.into_iter().flat_map(|axis| [axis, -axis]).enumerate() {
        let [seconds, rate_hz] = [4 * PHASE_S, 25];
        let number = 6 * seed + number as u64;
        let made = unit.log(up, [seconds, rate_hz], table, &mut draw, number);
        let mut log = made.log;
        let samples = 0..log.len();
        log.table_rate = Some(samples.map(|sample| table(sample / rate_hz)).collect());
        logs.push(log);
    }
    let report = evaluated(&logs, &unit, "[table]\ncolumn = \"t\"\nunit = \"rad/s\"\n")?;
    let mut hits = Vec::new();
    for (gyro, law) in report.gyros.iter().enumerate() {
        let truths = truths(&unit, gyro);
        for coefficient in &law.coefficients {
            if let Some((_, truth)) = truths.iter().find(|(name, _)| *name == coefficient.name) {
                let [low, high] = coefficient.interval();
                hits.push((low..=high).contains(truth));
            }
        }
    }
    Ok(hits)
}

/// Names of the coefficients of a gyro in a report, and what they are.
fn truths(unit: &Unit, gyro: usize) -> Vec<(String, f64)> {
    let own = AXES[gyro];
    let mut truths = vec![(format!("gyro_{own}.bias"), unit.bias[gyro])];
    for (axis, name) in AXES.into_iter().enumerate() {
        let error = unit.matrix_error[(gyro, axis)];
        truths.push((format!("gyro_{own}.g_{name}"), unit.of_force[(gyro, axis)]));
        truths.push(match axis == gyro {
            true => (format!("gyro_{own}.scale"), 1e6 * error),
            false => (format!("gyro_{own}.about_{name}"), 1e3 * error),
        });
    }
    truths
}

fn evaluated(logs: &[Log], unit: &Unit, more: &str) -> Result<RateReport, InstrumentError> {
    let description = described(100.0, unit.latitude_deg, more)?;
    evaluate_rates(logs, &description, &RateSettings::default())
}

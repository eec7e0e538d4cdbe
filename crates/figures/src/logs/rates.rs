//! Logs in the rate domain: static ones, two positions, and a turntable.

use gyrocal_instruments::rates::{RateReport, RateSettings, evaluate_rates};
use gyrocal_instruments::{Description, InstrumentError, Log};
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, Proportion, root_mean_square};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::covered;
use super::rates_simulation::{DEG_PER_H, EARTH_DEG_PER_H, LEVEL_RAD, Unit, vector};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

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

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = static_figures(extent)?;
    figures.extend(two_position_figures(extent)?);
    figures.extend(table_figures(extent)?);
    Ok(figures)
}

fn static_figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    const FIRST_SEED: u64 = 860_000;
    let small = extent.small;
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(500, 12);
    let campaign = resumable::campaign("logs", "rates-static", seeds.clone(), small)?;
    let longest_s = if small { LONGEST_SMALL_S } else { LONGEST_S };
    let outcome = campaign.run(|seed| static_log(seed, longest_s), |_| ())?;
    let logs: Vec<&Static> = outcome.successes().map(|(_, log)| log).collect();
    let seeds = format!("{seeds:?}");
    let biases = logs.iter().flat_map(|log| log.biases);
    let vertical = logs.iter().map(|log| log.vertical);
    let quiet = Proportion::of(logs.iter().map(|log| !log.effect));
    Ok(vec![
        covered(
            "static logs of 100 Hz, biases to 5 deg/s: coverage of the biases",
            biases,
            &seeds,
            small,
        ),
        covered(
            "the same: coverage of the vertical rate, Earth rate and bias",
            vertical,
            &seeds,
            small,
        ),
        Figure::note_share(
            "the same: logs without a false effect in time",
            quiet,
            seeds.as_str(),
        ),
    ])
}

/// A unit of any grade at rest, with a bias in proportion to its noise.
fn static_log(seed: u64, longest_s: f64) -> Result<Static, InstrumentError> {
    let mut draw = Draw::new(seed, ERRORS);
    let seconds = draw.log_uniform([600.0, longest_s]) as usize;
    let white = draw.log_uniform([1.0, 100.0]);
    let unit = Unit {
        bias: Vector3::from(
            [(); 3].map(|()| draw.sign() * draw.log_uniform([1e-3 * DEG_PER_S, 5.0 * DEG_PER_S])),
        ),
        matrix: Matrix3::identity(),
        of_force: Matrix3::zeros(),
        white,
        quantisation: white * draw.log_uniform([1e-3, 0.1]),
        flicker: white * draw.log_uniform([3e-3, 0.1]),
        walk: white * draw.log_uniform([1e-5, 1e-3]),
        step: draw.log_uniform([0.1, 1.0]),
        latitude_deg: 120.0 * draw.uniform() - 60.0,
    };
    let up = vector(&mut draw).normalize();
    let made = unit.log(up, [seconds, 100], |_| 0.0, &mut draw, seed);
    let report = evaluated(&[made.log], &unit, "")?;
    let log = &report.logs[0];
    let [rate, sigma] = log.vertical_deg_per_h;
    let earth = EARTH_DEG_PER_H * unit.latitude_deg.to_radians().sin();
    Ok(Static {
        biases: core::array::from_fn(|gyro| {
            let error = log.bias_deg_per_h[gyro] - made.mean_bias[gyro];
            error.abs() <= log.bias_half_width_deg_per_h[gyro]
        }),
        vertical: (rate - earth - up.dot(&made.mean_bias)).abs() <= NORMAL_97_5 * sigma,
        effect: report.gyros.iter().any(|gyro| !gyro.effects.is_empty()),
    })
}

fn two_position_figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    const FIRST_SEED: u64 = 870_000;
    let small = extent.small;
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(500, 20);
    let campaign = resumable::campaign("logs", "rates-two", seeds.clone(), small)?;
    let outcome = campaign.run(two_positions, |_| ())?;
    let tests: Vec<&TwoPositions> = outcome.successes().map(|(_, test)| test).collect();
    let seeds = format!("{seeds:?}");
    let hits = tests.iter().map(|test| {
        let [error, sigma] = test.evaluated;
        error.abs() <= NORMAL_97_5 * sigma
    });
    let name = "two-position tests: coverage of the bias along the turned axis";
    let mut figures = vec![covered(name, hits, &seeds, small)];
    for (part, what) in ["rms error", "sigma"].into_iter().enumerate() {
        let rms = |of: fn(&TwoPositions) -> [f64; 2]| {
            root_mean_square(tests.iter().map(|test| of(test)[part]))
        };
        let ratio = rms(|test| test.evaluated) / rms(|test| test.projection);
        let name =
            format!("two-position tests, vertical component: {what} over that of projection");
        let mut figure = Figure::within(&name, [f64::NEG_INFINITY, 1.05], ratio);
        if small {
            figure.holds = None;
            figure.too_few = true;
        }
        figures.push(figure.over(tests.len(), seeds.as_str()));
    }
    Ok(figures)
}

/// A navigation-grade unit for half an hour up and half an hour down.
fn two_positions(seed: u64) -> Result<TwoPositions, InstrumentError> {
    const SECONDS: usize = 1800;
    let mut draw = Draw::new(seed, ERRORS);
    let white = draw.log_uniform([0.3, 3.0]);
    let unit = Unit {
        bias: 0.3 * vector(&mut draw),
        matrix: Matrix3::identity(),
        of_force: Matrix3::zeros(),
        white,
        quantisation: white * draw.log_uniform([0.1, 1.0]),
        flicker: white * draw.log_uniform([1e-3, 1e-2]),
        walk: white * draw.log_uniform([1e-5, 1e-4]),
        step: 0.0,
        latitude_deg: 45.0,
    };
    let up = (Vector3::z() + 0.1 * vector(&mut draw)).normalize();
    let mut vertical = [0.0; 2];
    let mut sigmas = [0.0; 2];
    let (mut means, mut truths) = ([0.0; 2], [0.0; 2]);
    let earth = EARTH_DEG_PER_H * unit.latitude_deg.to_radians().sin();
    for (position, side) in [1.0, -1.0].into_iter().enumerate() {
        let made = unit.log(
            side * up,
            [SECONDS, 10],
            |_| 0.0,
            &mut draw,
            2 * seed + position as u64,
        );
        let rates = made.log.gyro.iter();
        let sum: f64 = rates.map(|rate| side * up.dot(&Vector3::from(*rate))).sum();
        means[position] = sum / made.log.len() as f64 / DEG_PER_H;
        truths[position] = earth + side * up.dot(&made.mean_bias);
        let report = evaluated(&[made.log], &unit, "")?;
        [vertical[position], sigmas[position]] = report.logs[0].vertical_deg_per_h;
    }
    let half = |of: [f64; 2]| 0.5 * (of[0] - of[1]);
    let duration_s = SECONDS as f64;
    let fast = unit.white.powi(2) / duration_s + 2.0 * (unit.quantisation / duration_s).powi(2);
    let level = LEVEL_RAD * EARTH_DEG_PER_H * unit.latitude_deg.to_radians().cos();
    Ok(TwoPositions {
        evaluated: [
            half(vertical) - half(truths),
            0.5 * sigmas[0].hypot(sigmas[1]),
        ],
        projection: [
            half(means) - half(truths),
            (0.5 * (fast + level * level)).sqrt(),
        ],
    })
}

fn table_figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    const FIRST_SEED: u64 = 880_000;
    let small = extent.small;
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(300, 8);
    let campaign = resumable::campaign("logs", "rates-table", seeds.clone(), small)?;
    let outcome = campaign.run(table_test, |_| ())?;
    let hits = outcome.successes().flat_map(|(_, hits)| hits.clone());
    let name = "turntable, 6 attitudes: coverage of scales, misalignments, biases, g terms";
    Ok(vec![covered(name, hits, &format!("{seeds:?}"), small)])
}

/// A unit with each axis up and down on a table that rests, turns to either side, and rests.
fn table_test(seed: u64) -> Result<Vec<bool>, InstrumentError> {
    const PHASE_S: usize = 60;
    let mut draw = Draw::new(seed, ERRORS);
    let matrix = |size: f64, draw: &mut Draw| Matrix3::from_fn(|_, _| size * draw.normal());
    let white = draw.log_uniform([3.0, 30.0]);
    let unit = Unit {
        bias: 0.1 * DEG_PER_S * vector(&mut draw),
        matrix: Matrix3::identity() + matrix(5e-3, &mut draw),
        of_force: matrix(30.0, &mut draw),
        white,
        quantisation: white * draw.log_uniform([1e-3, 0.1]),
        flicker: white * draw.log_uniform([3e-3, 0.1]),
        walk: white * draw.log_uniform([1e-5, 1e-3]),
        step: draw.log_uniform([0.1, 1.0]),
        latitude_deg: 120.0 * draw.uniform() - 60.0,
    };
    let rate = draw.log_uniform([5.0, 50.0]).to_radians();
    let table = |second: usize| rate * [0.0, 1.0, -1.0, 0.0][(second / PHASE_S).min(3)];
    let faces = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut logs = Vec::new();
    for (number, up) in faces.into_iter().flat_map(|axis| [axis, -axis]).enumerate() {
        let size = [4 * PHASE_S, 25];
        let mut log = unit
            .log(up, size, table, &mut draw, 6 * seed + number as u64)
            .log;
        log.table_rate = Some(
            (0..log.len())
                .map(|sample| table(sample / size[1]))
                .collect(),
        );
        logs.push(log);
    }
    let report = evaluated(&logs, &unit, "[table]\ncolumn = \"t\"\nunit = \"rad/s\"\n")?;
    let axes = AXES;
    let mut hits = Vec::new();
    for (gyro, law) in report.gyros.iter().enumerate() {
        let mut truths = vec![(format!("gyro_{}.bias", axes[gyro]), unit.bias[gyro])];
        for (axis, name) in axes.into_iter().enumerate() {
            let own = axes[gyro];
            truths.push((format!("gyro_{own}.g_{name}"), unit.of_force[(gyro, axis)]));
            truths.push(match axis == gyro {
                true => (
                    format!("gyro_{own}.scale"),
                    1e6 * (unit.matrix[(gyro, gyro)] - 1.0),
                ),
                false => (
                    format!("gyro_{own}.about_{name}"),
                    1e3 * unit.matrix[(gyro, axis)],
                ),
            });
        }
        for coefficient in &law.coefficients {
            if let Some((_, truth)) = truths.iter().find(|(name, _)| *name == coefficient.name) {
                let [low, high] = coefficient.interval();
                hits.push((low..=high).contains(truth));
            }
        }
    }
    Ok(hits)
}

fn evaluated(logs: &[Log], unit: &Unit, more: &str) -> Result<RateReport, InstrumentError> {
    let text = format!(
        "[time]\nrate_hz = 100\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n[accel]\n\
         columns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n{more}[site]\nlatitude_deg = {:?}\n",
        unit.latitude_deg
    );
    evaluate_rates(
        logs,
        &Description::parse(&text, "log.toml")?,
        &RateSettings::default(),
    )
}

//! Vertical rate of a static unit: projection of the gyros, motion of gravity, and both.

use gyrocal_instruments::InstrumentError;
use gyrocal_instruments::strapdown::{ImportSettings, import};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, root_mean_square};
use gyrocal_truth::units::position_test::vector;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::unit::Unit;
use super::{OVER_PROJECTION, OVER_PROJECTION_REASON, described, logs};
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const ERRORS: u64 = 1803;

/// Result for one log: errors and standard deviations \[deg/h\].
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Vertical {
    path: [f64; 2],
    projection: Option<[f64; 2]>,
    both: [f64; 2],
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let beside = |what: &str, part: usize| {
        let name = format!("static logs, vertical rate: {what} over that of projection alone");
        Row::rms_ratio(name, move |log: &Vertical| {
            Some([log.both[part], log.projection?[part]])
        })
        .at_most(OVER_PROJECTION, OVER_PROJECTION_REASON)
    };
    let of_paths = |logs: &[Vertical]| {
        let paths = root_mean_square(logs.iter().map(|log| log.path[1]));
        let projections = logs.iter().filter_map(|log| Some(log.projection?[1]));
        format!("{:.1}", paths / root_mean_square(projections))
    };
    let covered = |log: &Vertical| {
        let [error, sigma] = log.both;
        log.projection.map(|_| error.abs() <= NORMAL_97_5 * sigma)
    };
    let coverage = "static logs, vertical rate by both ways: coverage of 95 % intervals";
    let paths = "static logs: rms sigma of the motion of gravity over that of projection";
    let rows = [
        Row::share(coverage, covered).of_coverage(),
        beside("rms error", 0),
        beside("sigma", 1),
        Row::words(paths, of_paths),
    ];
    context.measure(&logs("vertical", [850_000, 500, 20], log), &rows)
}

/// A navigation-grade unit at rest for half an hour to three hours, at 1 Hz.
fn log(seed: u64) -> Result<Vertical, InstrumentError> {
    let mut draw = Draw::new(seed, ERRORS);
    let samples = draw.log_uniform([1.8e3, 1.08e4]) as usize;
    let up = (Vector3::z() + 0.3 * vector(&mut draw)).normalize();
    let white = draw.log_uniform([0.3, 3.0]);
    let unit = Unit {
        bias: 0.3 * vector(&mut draw),
        white,
        quantisation: white * draw.log_uniform([0.3, 3.0]),
        flicker: draw.log_uniform([0.001, 0.01]),
        walk: white * draw.log_uniform([1e-5, 1e-4]),
        accel: [0.0, draw.log_uniform([1e-5, 1e-4])],
        latitude_deg: 45.0,
        ..Unit::default()
    };
    let made = unit.log(up, [samples, 1], |_| 0.0, &mut draw, seed);
    let description = described(1.0, unit.latitude_deg, "")?;
    let report = import(&made.log, &description, &ImportSettings::default())?.report;
    let vertical = unit.vertical_earth() + up.dot(&made.mean_bias);
    let error = |[rate, sigma]: [f64; 2]| [rate - vertical, sigma];
    Ok(Vertical {
        path: error(report.vertical_rate_deg_per_h),
        projection: report.vertical_projection_deg_per_h.map(error),
        both: error(report.vertical_combined_deg_per_h),
    })
}

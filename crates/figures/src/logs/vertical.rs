//! Vertical rate of a static unit: projection of the gyros, motion of gravity, and both.

use gyrocal_instruments::strapdown::{ImportSettings, import};
use gyrocal_instruments::{Description, InstrumentError, Log};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, root_mean_square};
use gyrocal_testkit::sensor_noise::{Filter, SensorNoise};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::covered;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// Purpose of the stream of draws.
const ERRORS: u64 = 1803;

const FIRST_SEED: u64 = 850_000;
const RECORDS: u64 = 500;
const SMALL: u64 = 20;

const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
const EARTH_DEG_PER_H: f64 = 15.041_07;
const LATITUDE_DEG: f64 = 45.0;

/// Result for one log: errors and standard deviations \[deg/h\].
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Vertical {
    path: [f64; 2],
    projection: Option<[f64; 2]>,
    both: [f64; 2],
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(RECORDS, SMALL);
    let campaign = resumable::campaign("logs", "vertical", seeds.clone(), small)?;
    let outcome = campaign.run(log, |_| ())?;
    let logs: Vec<&Vertical> = outcome.successes().map(|(_, log)| log).collect();
    let seeds = format!("{seeds:?}");
    let with = || logs.iter().filter_map(|log| Some((*log, log.projection?)));
    let holds = |[error, sigma]: [f64; 2]| error.abs() <= NORMAL_97_5 * sigma;
    let name = "static logs, vertical rate by both ways: coverage of 95 % intervals";
    let mut figures = vec![covered(
        name,
        with().map(|(log, _)| holds(log.both)),
        &seeds,
        small,
    )];
    let rms = |values: Vec<f64>| root_mean_square(values.iter().copied());
    let of = |of: fn([f64; 2]) -> f64| {
        let both = rms(with().map(|(log, _)| of(log.both)).collect());
        both / rms(with().map(|(_, projection)| of(projection)).collect())
    };
    let count = with().count();
    for (what, ratio) in [
        ("rms error", of(|[error, _]| error)),
        ("sigma", of(|[_, sigma]| sigma)),
    ] {
        let name = format!("static logs, vertical rate: {what} over that of projection alone");
        let mut figure = Figure::within(&name, [f64::NEG_INFINITY, 1.05], ratio);
        if small {
            figure.holds = None;
            figure.too_few = true;
        }
        figures.push(figure.over(count, seeds.as_str()));
    }
    let paths = rms(logs.iter().map(|log| log.path[1]).collect());
    let projections = rms(with().map(|(_, [_, sigma])| sigma).collect());
    let name = "static logs: rms sigma of the motion of gravity over that of projection";
    figures.push(Figure::note(name, format!("{:.1}", paths / projections)).over(count, seeds));
    Ok(figures)
}

/// A navigation-grade unit at rest for half an hour to three hours, at 1 Hz.
fn log(seed: u64) -> Result<Vertical, InstrumentError> {
    let mut draw = Draw::new(seed, ERRORS);
    let samples = draw.log_uniform([1.8e3, 1.08e4]) as usize;
    let vector = |draw: &mut Draw| Vector3::new(draw.normal(), draw.normal(), draw.normal());
    let up = (Vector3::z() + 0.3 * vector(&mut draw)).normalize();
    let north = vector(&mut draw).cross(&up).normalize();
    let (sine, cosine) = f64::to_radians(LATITUDE_DEG).sin_cos();
    let earth = EARTH_DEG_PER_H * (sine * up + cosine * north);
    let bias = 0.3 * vector(&mut draw);
    let white = draw.log_uniform([0.3, 3.0]);
    let fast = SensorNoise {
        quantisation: white * draw.log_uniform([0.3, 3.0]),
        random_walk: white,
        bias_instability: 0.0,
        rate_random_walk: 0.0,
        filter: Filter::None,
    };
    let slow = SensorNoise {
        quantisation: 0.0,
        random_walk: 0.0,
        bias_instability: draw.log_uniform([0.001, 0.01]),
        rate_random_walk: white * draw.log_uniform([1e-5, 1e-4]),
        filter: Filter::None,
    };
    let series = |noise: SensorNoise, purpose: u64| -> [Vec<f64>; 3] {
        core::array::from_fn(|axis| noise.rates(samples, 10 * seed + 3 * purpose + axis as u64))
    };
    let [fast, slow] = [series(fast, 0), series(slow, 1)];
    let accel_noise = draw.log_uniform([1e-5, 1e-4]);
    let mut gyro = Vec::with_capacity(samples);
    let mut accel = Vec::with_capacity(samples);
    for sample in 0..samples {
        let noise = |parts: &[Vec<f64>; 3]| {
            Vector3::new(parts[0][sample], parts[1][sample], parts[2][sample])
        };
        let rate = earth + bias + noise(&fast) + noise(&slow);
        gyro.push((DEG_PER_H * rate).into());
        accel.push((up + accel_noise * vector(&mut draw)).into());
    }
    // The bias of the record is its mean, slow parts included.
    let mean = |axis: usize| slow[axis].iter().sum::<f64>() / samples as f64;
    let vertical = up.dot(&(earth + bias + Vector3::new(mean(0), mean(1), mean(2))));
    let text = format!(
        "[time]\nrate_hz = 1\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n[accel]\n\
         columns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n[site]\nlatitude_deg = {LATITUDE_DEG:?}\n"
    );
    let description = Description::parse(&text, "log.toml")?;
    let made = Log::from_samples(1.0, gyro, accel);
    let report = import(&made, &description, &ImportSettings::default())?.report;
    let error = |[rate, sigma]: [f64; 2]| [rate - vertical, sigma];
    Ok(Vertical {
        path: error(report.vertical_rate_deg_per_h),
        projection: report.vertical_projection_deg_per_h.map(error),
        both: error(report.vertical_combined_deg_per_h),
    })
}

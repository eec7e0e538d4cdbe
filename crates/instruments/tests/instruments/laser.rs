//! Multi-position tests of gyros whose angles are counted in steps.

use gyrocal_instruments::multi_position::{
    MultiPositionSettings, TumbleResult, multi_position_test, prepare_logs,
};
use gyrocal_instruments::rates::{RateSettings, evaluate_rates};
use gyrocal_instruments::{Description, Log};
use nalgebra::Vector3;

use crate::common::{EARTH_RATE_RAD_PER_S, Noise};

const LATITUDE_DEG: f64 = 48.0;
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
const BIAS_DEG_PER_H: f64 = -0.25;

fn description() -> Description {
    let text = format!(
        "[time]\nrate_hz = 20\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n[accel]\ncolumns = \
         [\"d\", \"e\", \"f\"]\nunit = \"g\"\n[site]\nlatitude_deg = {LATITUDE_DEG:?}\n"
    );
    Description::parse(&text, "log.toml").unwrap()
}

/// Ring-laser gyros with body x along `sign` times up: 300 s at 20 Hz, 0.5 deg/h sqrt(s), steps of 1 arcsec.
fn log(sign: f64, noise: &mut Noise) -> Log {
    const INTERVAL_S: f64 = 0.05;
    const STEP_RAD: f64 = DEG_PER_H;
    let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
    let earth = EARTH_RATE_RAD_PER_S * Vector3::new(sign * sine, cosine, 0.0);
    let bias = BIAS_DEG_PER_H * DEG_PER_H * Vector3::x();
    let mut angle = Vector3::from([(); 3].map(|()| noise.uniform() * STEP_RAD));
    let counted = |angle: &Vector3<f64>| angle.map(|angle| (angle / STEP_RAD).floor() * STEP_RAD);
    let mut last = counted(&angle);
    let samples: Vec<_> = (0..6000)
        .map(|_| {
            let white = 0.5 * DEG_PER_H * INTERVAL_S.sqrt() * noise.vector();
            angle += (earth + bias) * INTERVAL_S + white;
            let now = counted(&angle);
            let rate = (now - last) / INTERVAL_S;
            last = now;
            (rate, sign * Vector3::x() + 1e-4 * noise.vector())
        })
        .collect();
    crate::common::log(INTERVAL_S, &samples)
}

#[test]
fn one_number_has_one_sigma() {
    const UNITS: u64 = 8;
    let settings = RateSettings::default();
    let (mut ratios, mut squares) = (0.0, 0.0);
    for unit in 0..UNITS {
        let mut noise = Noise::of_seed(unit);
        let logs = [1.0, -1.0].map(|sign| log(sign, &mut noise));
        let rates = evaluate_rates(&logs, &description(), &settings).unwrap();
        let of_rates = &rates.gyros[0].coefficients[0];
        let stops = logs.map(|log| {
            let whole = 0..log.len();
            (log, vec![whole])
        });
        let prepared = prepare_logs(&stops, &description()).unwrap();
        let report =
            multi_position_test(&prepared.positions, &MultiPositionSettings::default()).unwrap();
        let of_stops = &report.gyros[0].extended.coefficients[0];
        ratios += of_stops.sigma / of_rates.sigma / UNITS as f64;
        squares += ((of_stops.estimate - BIAS_DEG_PER_H) / of_stops.sigma).powi(2);
    }
    // The noise between stops is integrated over, where the rates have its likeliest level.
    assert!((1.0..2.5).contains(&ratios), "{ratios}");
    // Chi-square of eight: 99.9 % below 26.
    assert!(squares < 26.0, "{squares}");
}

#[test]
fn signs_against_the_earth_are_told() {
    let mut noise = Noise::of_seed(20);
    let mut logs = [1.0, -1.0].map(|sign| log(sign, &mut noise));
    let is_reversed = |logs: &[Log; 2]| {
        let stops = logs.clone().map(|log| {
            let whole = 0..log.len();
            (log, vec![whole])
        });
        let prepared = prepare_logs(&stops, &description()).unwrap();
        let report =
            multi_position_test(&prepared.positions, &MultiPositionSettings::default()).unwrap();
        TumbleResult::of(&prepared, report).earth_is_reversed
    };
    assert!(!is_reversed(&logs));
    for log in &mut logs {
        for force in log.accel.as_mut().unwrap() {
            *force = force.map(|component| -component);
        }
    }
    assert!(is_reversed(&logs));
}

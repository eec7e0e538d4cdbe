//! Hidden effects against closed forms and against their definitions.

// A test that cannot go on fails with the reason.
#![cfg(test)]

mod files;
mod motion;
mod names;
mod noise;
mod rates;
mod sensors;
mod site;

use gyrocal_truth::{Attitude, Coefficients, Hidden, InitialAttitude, Scenario, Temperature};

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;
const LATITUDE_DEG: f64 = 39.1;
/// Field along east, north, up at middle latitudes.
const FIELD_GAUSS: [f64; 3] = [-0.03, 0.28, -0.45];

fn rad(deg_per_h: f64, hours: f64) -> f64 {
    (deg_per_h * hours).to_radians()
}

/// A day each minute without noise, with all that an effect may need.
fn quiet(coefficients: Coefficients) -> Scenario {
    Scenario {
        seed: 11,
        latitude_deg: LATITUDE_DEG,
        coefficients,
        initial: InitialAttitude::AnglesDeg([70.0, -25.0, 130.0]),
        initial_angles_sigma_deg: [0.0; 3],
        accel_noise_g: 0.0,
        gyro_noise_deg_per_h: 0.0,
        duration_s: DAY_S,
        temperature: Some(Temperature::default()),
        magnetic_field_gauss: Some(FIELD_GAUSS),
        ..Scenario::default()
    }
}

fn with(scenario: &Scenario, id: &str, parameters: &[(&str, f64)]) -> Scenario {
    Scenario {
        hidden: vec![Hidden::new(id, parameters).unwrap()],
        ..scenario.clone()
    }
}

/// Any effect with parameters of a size that shows within a day.
fn example(id: &str) -> Hidden {
    let candidates: [&[(&str, f64)]; 12] = [
        &[("size", 1e-3)],
        &[("size", 0.05), ("onset_s", 20_000.5)],
        &[("size", 0.05), ("time_constant_h", 12.0)],
        &[("sine", 0.02), ("cosine", -0.03)],
        &[("size", 1e-3), ("period_h", 24.0)],
        &[("ratio", 2.0)],
        &[("lsb", 3e-5)],
        &[("fraction", 0.01), ("size", 8.0)],
        &[("correlation", 0.3)],
        &[("x_deg", 0.1)],
        &[("z_deg", 0.1), ("onset_s", 20_000.5)],
        &[("size", 0.05)],
    ];
    // A dead zone has to be entered.
    let first = if id.ends_with("dead_zone") { 11 } else { 0 };
    candidates[first..]
        .iter()
        .find_map(|parameters| Hidden::new(id, parameters).ok())
        .unwrap_or_else(|| panic!("no example fits {id}"))
}

/// Turns of the platform in inertial space from row to row, in its own axes.
fn inertial_turns_rad(scenario: &Scenario, attitudes: &[Attitude]) -> Vec<[f64; 3]> {
    let earth_rate = scenario.platform().earth_rate_enu_rad_per_s();
    let platform_c_inertial: Vec<Attitude> = attitudes
        .iter()
        .zip(0_u32..)
        .map(|(platform_c_enu, row)| {
            let time_s = f64::from(row) * scenario.interval_s;
            platform_c_enu.after(Attitude::turned_by(earth_rate.map(|rate| rate * time_s)))
        })
        .collect();
    platform_c_inertial
        .windows(2)
        .map(|pair| pair[1].rotation_from_rad(pair[0]))
        .collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| {
        (sum + value * value, count + 1)
    });
    (sum / f64::from(count)).sqrt()
}

//! The simulator against formulas: motions that can be written down.

#![cfg(test)]

use gyrocal_truth::{Attitude, Coefficients, EARTH_RATE_RAD_PER_S, Platform};

const DAY_S: f64 = 86_400.0;
const LATITUDE_DEG: f64 = 39.1;
const ANGLES_RAD: [f64; 3] = [0.4, -0.7, 2.0];
/// Rounding of 43 200 steps and of an Earth angle of 31 rad, a few 1e-15 each.
const OVER_FIVE_DAYS_G: f64 = 1e-13;

fn platform(latitude_deg: f64, coefficients: Coefficients) -> Platform {
    Platform {
        latitude_deg,
        specific_force_at_rest_g: 1.0,
        coefficients,
        initial_platform_c_enu: Attitude::from_angles_rad(ANGLES_RAD),
    }
}

/// Rodrigues: a vector turned about a unit axis.
fn turned(vector: [f64; 3], axis: [f64; 3], angle_rad: f64) -> [f64; 3] {
    let (sine, cosine) = angle_rad.sin_cos();
    let along: f64 = (0..3).map(|i| axis[i] * vector[i]).sum();
    let cross = [
        axis[1] * vector[2] - axis[2] * vector[1],
        axis[2] * vector[0] - axis[0] * vector[2],
        axis[0] * vector[1] - axis[1] * vector[0],
    ];
    core::array::from_fn(|i| {
        vector[i] * cosine + cross[i] * sine + axis[i] * along * (1.0 - cosine)
    })
}

fn rad_per_s(deg_per_h: f64) -> f64 {
    deg_per_h.to_radians() / 3600.0
}

/// The vertical, carried east by the Earth's turn, in the frame of the first moment.
fn up_inertial(latitude_deg: f64, time_s: f64) -> [f64; 3] {
    let latitude_rad = latitude_deg.to_radians();
    let axis = [0.0, latitude_rad.cos(), latitude_rad.sin()];
    turned([0.0, 0.0, 1.0], axis, EARTH_RATE_RAD_PER_S * time_s)
}

fn assert_follows(platform: &Platform, formula: impl Fn(f64) -> [f64; 3]) {
    let times_s: Vec<f64> = (0..=60)
        .map(|row| f64::from(row) * 5.0 * DAY_S / 60.0)
        .collect();
    for (time_s, seen) in times_s.iter().zip(platform.specific_force_g(&times_s)) {
        let expected = formula(*time_s);
        for axis in 0..3 {
            let error = (seen[axis] - expected[axis]).abs();
            assert!(
                error < OVER_FIVE_DAYS_G,
                "{time_s} s, axis {axis}: {error:e}"
            );
        }
    }
}

#[test]
fn without_drift_gravity_sweeps_a_cone_about_the_earths_axis() {
    let platform = platform(LATITUDE_DEG, Coefficients::NONE);
    assert_follows(&platform, |time_s| {
        Attitude::from_angles_rad(ANGLES_RAD).resolve(up_inertial(LATITUDE_DEG, time_s))
    });
}

#[test]
fn a_constant_drift_turns_the_platform_about_an_axis_of_its_own() {
    let bias_deg_per_h = [0.6, -0.2, 0.9];
    let coefficients = Coefficients {
        bias_deg_per_h,
        ..Coefficients::NONE
    };
    let size: f64 = bias_deg_per_h
        .iter()
        .map(|bias| bias * bias)
        .sum::<f64>()
        .sqrt();
    let axis = bias_deg_per_h.map(|bias| bias / size);
    assert_follows(&platform(LATITUDE_DEG, coefficients), |time_s| {
        let at_rest =
            Attitude::from_angles_rad(ANGLES_RAD).resolve(up_inertial(LATITUDE_DEG, time_s));
        // The platform turns forward, so what it sees turns back.
        turned(at_rest, axis, -rad_per_s(size) * time_s)
    });
}

#[test]
fn at_the_pole_one_gyro_turns_the_platform_at_the_rate_of_its_drift_law() {
    // The vertical is the Earth's axis there, and a turn about x leaves the specific force
    // along x as it is: the drift is constant though it depends on specific force.
    for gyro in 0..3 {
        let mut coefficients = Coefficients::NONE;
        coefficients.bias_deg_per_h[gyro] = 0.7;
        coefficients.g_deg_per_h_per_g[gyro] = -0.3;
        coefficients.gg_deg_per_h_per_g2[gyro] = 0.15;
        let first = Attitude::from_angles_rad(ANGLES_RAD).resolve([0.0, 0.0, 1.0]);
        let along = first[gyro];
        let rate = rad_per_s(0.7 - 0.3 * along + 0.15 * along * along);
        let mut axis = [0.0; 3];
        axis[gyro] = 1.0;
        assert_follows(&platform(90.0, coefficients), |time_s| {
            turned(first, axis, -rate * time_s)
        });
    }
}

#[test]
fn a_sidereal_day_brings_a_driftless_platform_back() {
    let platform = platform(-52.0, Coefficients::NONE);
    let sidereal_day_s = core::f64::consts::TAU / EARTH_RATE_RAD_PER_S;
    // The book value, 86 164.1 s, to the accuracy of the rate's seven digits.
    assert!((sidereal_day_s - 86_164.1).abs() < 0.01);
    let seen = platform.specific_force_g(&[0.0, sidereal_day_s]);
    for (first, again) in seen[0].iter().zip(seen[1]) {
        assert!((first - again).abs() < OVER_FIVE_DAYS_G);
    }
}

#[test]
fn the_norm_is_that_of_gravity_in_the_accelerometers_unit() {
    let mut platform = platform(LATITUDE_DEG, Coefficients::PAPER_LIKE);
    platform.specific_force_at_rest_g = 0.9993;
    let seen = platform.specific_force_g(&[3.0 * DAY_S]);
    let norm: f64 = seen[0].iter().map(|a| a * a).sum::<f64>().sqrt();
    // A few roundings.
    assert!((norm - 0.9993).abs() < 1e-15);
}

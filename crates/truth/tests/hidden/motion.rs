//! Motions that can be written down: one gyro drifts, and the platform turns about its axis.

use core::f64::consts::TAU;

use gyrocal_truth::{
    Attitude, Coefficients, Hidden, InitialAttitude, Platform, Scenario, simulate,
};

use crate::{DAY_S, HOUR_S, inertial_turns_rad, quiet, rad, with};

/// Rounding over a day.
const ROUNDING_RAD: f64 = 1e-12;

/// The angle about z that the platform has turned at each row; about x and y it must be none.
fn angle_about_z(scenario: &Scenario) -> Vec<f64> {
    let truth = simulate(scenario).unwrap().truth;
    let mut angle_rad = 0.0;
    let mut angles = vec![0.0];
    for turn_rad in inertial_turns_rad(scenario, &truth.platform_c_enu) {
        assert!(turn_rad[0].abs() < ROUNDING_RAD && turn_rad[1].abs() < ROUNDING_RAD);
        angle_rad += turn_rad[2];
        angles.push(angle_rad);
    }
    angles
}

fn assert_turns(scenario: &Scenario, tolerance_rad: f64, formula: impl Fn(f64) -> f64) {
    let angles = angle_about_z(scenario);
    let largest = angles
        .iter()
        .fold(0.0, |most: f64, angle| most.max(angle.abs()));
    // Far above the tolerance.
    assert!(largest > 1e-4, "{largest}");
    for (row, angle_rad) in (0_u32..).zip(angles) {
        let time_s = f64::from(row) * scenario.interval_s;
        let error_rad = (angle_rad - formula(time_s)).abs();
        assert!(error_rad < tolerance_rad, "{time_s} s: {error_rad:e}");
    }
}

#[test]
fn functions_of_time_are_integrated_exactly() {
    let still = quiet(Coefficients::NONE);
    let case = |id, parameters: &[(&str, f64)], formula: &dyn Fn(f64) -> f64| {
        assert_turns(&with(&still, id, parameters), ROUNDING_RAD, formula);
    };
    case("gyro_z.ramp", &[("size", 0.4)], &|t| {
        rad(0.4, t / DAY_S * t / HOUR_S / 2.0)
    });
    // The onset is in the midst of an interval, and no round number.
    let step = [("size", 0.3), ("onset_s", 12_345.678)];
    case("gyro_z.step", &step, &|t| {
        rad(0.3, (t - 12_345.678).max(0.0) / HOUR_S)
    });
    let warmup = [("size", 0.5), ("time_constant_h", 0.7)];
    case("gyro_z.warmup", &warmup, &|t| {
        rad(0.5, 0.7 * (1.0 - (-t / (0.7 * HOUR_S)).exp()))
    });
    let wave = |sine: f64, cosine: f64, hours: f64, t: f64| {
        let angle = TAU * t / HOUR_S / hours;
        rad(
            sine * (1.0 - angle.cos()) + cosine * angle.sin(),
            hours / TAU,
        )
    };
    case("gyro_z.diurnal", &[("sine", 0.2), ("cosine", -0.1)], &|t| {
        wave(0.2, -0.1, 24.0, t)
    });
    let tone = [("size", 0.2), ("period_h", 1.7), ("phase_deg", 90.0)];
    case("gyro_z.tone", &tone, &|t| wave(0.0, 0.2, 1.7, t));
}

#[test]
fn several_steps_add_up() {
    let step = |size, onset_s| {
        Hidden::new("gyro_z.step", &[("size", size), ("onset_s", onset_s)]).unwrap()
    };
    let scenario = Scenario {
        // The third is at a row, the last at the end.
        hidden: vec![
            step(0.3, 50_000.1),
            step(-0.2, 7.0),
            step(0.1, 600.0),
            step(1.0, DAY_S),
        ],
        ..quiet(Coefficients::NONE)
    };
    assert_turns(&scenario, ROUNDING_RAD, |t| {
        let since = |onset_s: f64| (t - onset_s).max(0.0) / HOUR_S;
        rad(0.3, since(50_000.1)) - rad(0.2, since(7.0)) + rad(0.1, since(600.0))
    });
    let truth = simulate(&scenario).unwrap().truth;
    // From the onset on, that moment included.
    assert_eq!(truth.drift_deg_per_h[9][2], -0.2);
    assert!((truth.drift_deg_per_h[10][2] + 0.1).abs() < 1e-15);
    assert!((truth.drift_deg_per_h[1440][2] - 1.2).abs() < 1e-15);
}

/// Specific force along z, which a turn about z does not change: as without any drift.
fn accel_z_g(times_s: &[f64]) -> Vec<f64> {
    let platform: Platform = quiet(Coefficients::NONE).platform();
    let ideal = platform.specific_force_g(times_s);
    ideal.into_iter().map(|accel_g| accel_g[2]).collect()
}

/// Times at which it crosses zero, by bisection.
fn crossings_s() -> Vec<f64> {
    let minutes: Vec<f64> = (0..=1440).map(|minute| f64::from(minute) * 60.0).collect();
    let values = accel_z_g(&minutes);
    let mut crossings = Vec::new();
    for row in 1..values.len() {
        if values[row - 1] * values[row] < 0.0 {
            let (mut low, mut high) = (minutes[row - 1], minutes[row]);
            while high - low > 1e-10 {
                let middle = 0.5 * (low + high);
                if accel_z_g(&[middle])[0] * values[row - 1] > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            crossings.push(low);
        }
    }
    assert_eq!(crossings.len(), 2, "{crossings:?}");
    crossings
}

#[test]
fn a_sign_changes_at_the_moment_and_not_at_the_row() {
    let crossings = crossings_s();
    let first = accel_z_g(&[0.0])[0].signum();
    let scenario = with(
        &quiet(Coefficients::NONE),
        "gyro_z.sign_z",
        &[("size", 0.3)],
    );
    assert_turns(&scenario, ROUNDING_RAD, |t| {
        let [a, b] = [crossings[0], crossings[1]].map(|crossing| t.min(crossing));
        rad(0.3, first * (a - (b - a) + (t - b)) / HOUR_S)
    });
}

#[test]
fn a_dead_zone_leaves_what_is_beyond_it() {
    let mut coefficients = Coefficients::NONE;
    coefficients.g_deg_per_h_per_g[2] = 0.8;
    let scenario = with(&quiet(coefficients), "gyro_z.dead_zone", &[("size", 0.25)]);
    // Once a second: the midpoint rule is wrong by the square of a second times the slope of
    // the rate where it has a kink (3e-10 rad/s²), and by Δt² / 24 of that over a day.
    let midpoints_s: Vec<f64> = (0..86_400).map(|second| f64::from(second) + 0.5).collect();
    let mut sums = vec![0.0];
    for accel_g in accel_z_g(&midpoints_s) {
        let free: f64 = 0.8 * accel_g;
        let left = free.signum() * (free.abs() - 0.25).max(0.0);
        sums.push(sums[sums.len() - 1] + rad(left, 1.0 / HOUR_S));
    }
    assert_turns(&scenario, 1e-9, |t| sums[t as usize]);
    let truth = simulate(&scenario).unwrap().truth;
    let none = truth.drift_deg_per_h.iter().filter(|drift| drift[2] == 0.0);
    // It is in there for hours.
    assert!(none.count() > 100);
}

#[test]
fn a_knock_is_a_rotation_at_its_onset() {
    let knock = [
        ("x_deg", 0.3),
        ("y_deg", -0.2),
        ("z_deg", 0.1),
        ("onset_s", 30_000.0),
    ];
    let still = quiet(Coefficients::NONE);
    let before = simulate(&still).unwrap().truth.platform_c_enu;
    let after = simulate(&with(&still, "platform.knock", &knock)).unwrap();
    let turn = Attitude::turned_by([0.3_f64, -0.2, 0.1].map(f64::to_radians));
    for (row, (knocked, before)) in after.truth.platform_c_enu.iter().zip(before).enumerate() {
        // Row 500 is at the onset.
        let expected = if row < 500 {
            before
        } else {
            turn.after(before)
        };
        let error = knocked.rotation_from_rad(expected);
        assert!(error.iter().all(|angle| angle.abs() < 1e-14), "row {row}");
    }
}

#[test]
fn a_platform_that_its_friction_holds_where_it_is_can_be_simulated() {
    // At the pole gravity does not sweep: the sign drives the platform about y back whenever
    // the specific force along x has changed its sign, and the simulation must come to an end.
    let scenario = Scenario {
        latitude_deg: 90.0,
        initial: InitialAttitude::AnglesDeg([0.0, 0.001, 0.0]),
        duration_s: HOUR_S,
        ..quiet(Coefficients::NONE)
    };
    let last_accel_x_g = |size| {
        let scenario = with(&scenario, "gyro_y.sign_x", &[("size", size)]);
        simulate(&scenario).unwrap().record.accel_g[60][0].abs()
    };
    // 0.2 deg/h for an hour go through zero from 0.001 deg, or away from it.
    let (one, other) = (last_accel_x_g(0.2), last_accel_x_g(-0.2));
    assert!((one.max(other) - 0.201_f64.to_radians()).abs() < 1e-6);
    // 0.2 deg/h for as long as a mode lasts at least, 0.05 s, is 5e-8 rad.
    assert!(one.min(other) < 1e-7);
}

//! Effects of the site, the clock and the initial attitude.

use gyrocal_truth::{Attitude, Coefficients, Scenario, Simulation, simulate};

use crate::{DAY_S, LATITUDE_DEG, quiet, with};

fn still() -> Scenario {
    quiet(Coefficients::NONE)
}

fn assert_same_samples(a: &Simulation, b: &Simulation, tolerance_g: f64) {
    assert_eq!(a.record.len(), b.record.len());
    for (a, b) in a.record.accel_g.iter().zip(&b.record.accel_g) {
        for axis in 0..3 {
            assert!((a[axis] - b[axis]).abs() < tolerance_g, "{a:?} {b:?}");
        }
    }
}

#[test]
fn the_bench_states_the_wrong_latitude() {
    let scenario = quiet(Coefficients::PAPER_LIKE);
    let wrong = simulate(&with(&scenario, "site.latitude", &[("size", 0.5)])).unwrap();
    let there = simulate(&Scenario {
        latitude_deg: LATITUDE_DEG + 0.5,
        ..scenario
    })
    .unwrap();
    assert_eq!(wrong.record, there.record);
    assert_eq!(wrong.bench.latitude_deg, LATITUDE_DEG);
}

#[test]
fn gravity_is_felt_by_accelerometers_and_gyros() {
    let size = [("size", 2e-3)];
    let coefficients = Coefficients::PAPER_LIKE;
    let heavier = simulate(&with(&quiet(coefficients), "site.gravity", &size)).unwrap();
    for (sample, drift) in heavier
        .record
        .accel_g
        .iter()
        .zip(&heavier.truth.drift_deg_per_h)
    {
        let norm: f64 = sample.iter().map(|a| a * a).sum::<f64>().sqrt();
        // A few roundings.
        assert!((norm - 1.002).abs() < 1e-15);
        assert_eq!(*drift, coefficients.drift_deg_per_h(*sample));
    }
}

#[test]
fn a_faster_earth_is_a_slower_clock_when_nothing_drifts() {
    // Both see the Earth turned further at the same reading of the clock.
    let earth = simulate(&with(&still(), "site.earth_rate", &[("size", 0.01)])).unwrap();
    let rate = 1.0_f64 / 1.01 - 1.0;
    let clock = simulate(&with(&still(), "clock.rate", &[("size", rate)])).unwrap();
    // Rounding over a day.
    assert_same_samples(&earth, &clock, 1e-13);
    // And by the formula: each row is what another platform sees a hundredth later.
    let times_s: Vec<f64> = earth
        .record
        .time_s
        .iter()
        .map(|time_s| 1.01 * time_s)
        .collect();
    for (seen, expected) in earth
        .record
        .accel_g
        .iter()
        .zip(still().platform().specific_force_g(&times_s))
    {
        for axis in 0..3 {
            assert!((seen[axis] - expected[axis]).abs() < 1e-13);
        }
    }
}

#[test]
fn a_fast_clock_reads_more_than_has_passed() {
    let scenario = quiet(Coefficients::PAPER_LIKE);
    let fast = simulate(&with(&scenario, "clock.rate", &[("size", 0.25)])).unwrap();
    // At its 86 400 s only 69 120 have passed.
    let shorter = simulate(&Scenario {
        duration_s: DAY_S / 1.25,
        ..scenario
    })
    .unwrap();
    let turn = fast
        .truth
        .platform_c_enu_last()
        .rotation_from_rad(shorter.truth.platform_c_enu_last());
    // The same motion in other steps.
    assert!(turn.iter().all(|angle| angle.abs() < 1e-13), "{turn:?}");
    assert_eq!(fast.record.time_s[1440], DAY_S);
}

#[test]
fn the_platform_starts_elsewhere_than_declared() {
    let parameters = [("x_deg", 0.1), ("y_deg", 0.2), ("z_deg", -0.3)];
    let scenario = Scenario {
        initial_angles_sigma_deg: [0.02; 3],
        ..still()
    };
    let off = with(&scenario, "platform.initial_attitude", &parameters);
    let before = scenario.platform().initial_platform_c_enu;
    let turn = Attitude::turned_by([0.1_f64, 0.2, -0.3].map(f64::to_radians));
    let seen = simulate(&off).unwrap();
    let error = seen
        .truth
        .platform_c_enu_first()
        .rotation_from_rad(turn.after(before));
    assert!(error.iter().all(|angle| angle.abs() < 1e-15), "{error:?}");
    assert_eq!(seen.bench, simulate(&scenario).unwrap().bench);
}

#[test]
fn the_field_is_that_of_the_bench() {
    assert_eq!(
        still().bench().magnetic_field_gauss,
        still().magnetic_field_gauss
    );
    assert!(still().magnetic_field_gauss.is_some());
}

#[test]
fn the_temperature_wanders_as_it_is_told() {
    let course = |seed, interval_s: f64, days: f64| {
        let scenario = Scenario {
            seed,
            interval_s,
            duration_s: days * DAY_S,
            ..still()
        };
        simulate(&scenario).unwrap().record.temperature_c.unwrap()
    };
    let (fine, coarse) = (course(1, 60.0, 2.0), course(1, 120.0, 2.0));
    assert!(
        coarse
            .iter()
            .zip(fine.iter().step_by(2))
            .all(|(a, b)| a == b)
    );
    assert_ne!(fine, course(2, 60.0, 2.0));
    // Over 300 days: power of the wave and of the wander.
    let long = course(3, 3600.0, 300.0);
    let mean = long.iter().sum::<f64>() / long.len() as f64;
    let power = long.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / long.len() as f64;
    // Slow parts are not seen for a whole number of times.
    assert!((mean - 20.0).abs() < 0.1, "{mean}");
    let expected = 0.5 * 1.5_f64.powi(2) + 0.7_f64.powi(2);
    assert!((power / expected - 1.0).abs() < 0.1, "{power} {expected}");
    // In a minute it changes by no more than the steepest sum of all waves.
    let jump = fine.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    assert!(jump.fold(0.0, f64::max) < 0.05);
}

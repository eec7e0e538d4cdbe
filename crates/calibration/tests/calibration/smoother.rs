//! The batch estimator on short records, against least squares on dense matrices.
// Failing here is what tests are for.
#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

use gyrocal::Discretisation;
use gyrocal_calibration::{CalibrationError, Options, Run, calibrate, cramer_rao_bound};
use gyrocal_record::Prior;
use gyrocal_testkit::dense_least_squares::DenseProblem;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};

/// Largest difference allowed, in sigmas; 2e-8 was seen, and at times 1e-6 where steps converge slowly.
const SIGMAS: f64 = 1e-6;

/// Forty rows, some in a gap that is divided into parts, and a tenth of the values missing.
fn short(seed: u64, change: impl Fn(&mut Scenario)) -> Simulation {
    let mut scenario = Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        latitude_deg: [-70.0, -20.0, 0.0, 39.1, 60.0][seed as usize % 5],
        interval_s: 30.0,
        duration_s: 39.0 * 30.0,
        gaps_s: vec![[305.0, 500.0]],
        missing_fraction: 0.1,
        start_s: 1_000.0,
        ..Scenario::default()
    };
    change(&mut scenario);
    simulate(&scenario).unwrap()
}

#[track_caller]
fn assert_dense(simulation: &Simulation) {
    let options = Options {
        // Short parts: the two integrate by different rules.
        discretisation: Discretisation {
            longest_step_s: 30.0,
            ..Discretisation::default()
        },
        ..Options::default()
    };
    let (record, bench) = (&simulation.record, &simulation.bench);
    let found = calibrate(record, bench, &options, |_| ()).unwrap();
    let dense =
        DenseProblem::new(Run { record, bench }, options.discretisation.longest_step_s).solve();
    let drift = found.drift.to_array();
    for i in 0..9 {
        let sigma = dense.covariance[(i, i)].sqrt();
        let off = (drift[i] - dense.drift[i]) / sigma;
        assert!(off.abs() < SIGMAS, "{i}: {off} sigmas");
        for j in 0..9 {
            let scale = sigma * dense.covariance[(j, j)].sqrt();
            let off = (found.covariance[i][j] - dense.covariance[(i, j)]) / scale;
            assert!(off.abs() < SIGMAS, "{i}, {j}: {off}");
            assert_eq!(found.covariance[i][j], found.covariance[j][i]);
        }
    }
    // Least sums of squares near a minimum differ by the square of what estimates do.
    let cost = found.fit.nis_sum();
    assert!(
        (cost / dense.cost - 1.0).abs() < 1e-9,
        "{cost} {}",
        dense.cost
    );
    let run = &found.runs[0];
    let ends = [run.first_platform_c_enu, run.last_platform_c_enu];
    // Azimuth at first is known to the hundredth of a degree that the bench declares, at last to
    // what a drift of 1 deg/h adds in twenty minutes.
    let sigma_rad = [1.7e-4, 5.7e-3];
    for ((found, expected), sigma_rad) in ends.iter().zip(dense.ends).zip(sigma_rad) {
        for i in 0..3 {
            for j in 0..3 {
                let off = (found[i][j] - expected[(i, j)]) / sigma_rad;
                assert!(off.abs() < SIGMAS, "{off} sigmas");
            }
        }
    }
}

#[test]
fn equals_dense_least_squares() {
    for seed in 0..5 {
        assert_dense(&short(seed, |_| ()));
    }
}

#[test]
fn equals_dense_least_squares_for_any_declaration() {
    // Sigmas of the angles that differ, far from level.
    assert_dense(&short(11, |scenario| {
        scenario.initial = InitialAttitude::AnglesDeg([50.0, -60.0, 120.0]);
        scenario.initial_angles_sigma_deg = [0.003, 0.05, 0.2];
    }));
    // Louder gyros, narrow priors of some coefficients, another unit.
    assert_dense(&short(12, |scenario| {
        scenario.gyro_noise_deg_per_h = 0.02;
        scenario.gravity = Some(gyrocal_record::Gravity {
            local_m_per_s2: 9.78,
            unit_m_per_s2: 9.806_65,
        });
        scenario.prior = Prior {
            bias_sigma_deg_per_h: [0.01, 1.0, 2.0],
            g_sigma_deg_per_h_per_g: [0.5, 0.02, 1.0],
            ..Prior::default()
        };
    }));
    // One accelerometer is dead, and a row says nothing.
    let mut dead = short(13, |_| ());
    dead.record
        .accel_g
        .iter_mut()
        .for_each(|row| row[1] = f64::NAN);
    dead.record.accel_g[7] = [f64::NAN; 3];
    assert_dense(&dead);
}

fn true_attitudes(simulation: &Simulation) -> Vec<[[f64; 3]; 3]> {
    let attitudes = simulation.truth.platform_c_enu.iter();
    attitudes.map(|attitude| attitude.matrix()).collect()
}

#[test]
fn the_bound_is_the_covariance_at_the_truth() {
    for seed in 0..3 {
        let simulation = short(seed, |scenario| {
            scenario.duration_s = 2.0 * 86_400.0;
            scenario.interval_s = 300.0;
            scenario.gaps_s.clear();
        });
        let (record, bench) = (&simulation.record, &simulation.bench);
        let drift = simulation
            .truth
            .coefficients
            .named()
            .map(|(_, value, _)| value);
        let attitudes = true_attitudes(&simulation);
        let bound = cramer_rao_bound(&Run { record, bench }, &attitudes, &drift).unwrap();
        let found = calibrate(record, bench, &Options::default(), |_| ()).unwrap();
        for i in 0..9 {
            let ratio = (found.covariance[i][i] / bound[i][i]).sqrt();
            // The estimate is some 1e-4 rad and deg/h beside the truth, and so are derivatives.
            assert!((ratio - 1.0).abs() < 0.01, "seed {seed}, {i}: {ratio}");
            for j in 0..9 {
                assert_eq!(bound[i][j], bound[j][i]);
            }
        }
    }
}

#[test]
fn the_bound_grows_with_unknown_latitude_and_azimuth() {
    let simulation = short(3, |scenario| scenario.duration_s = 86_400.0);
    let drift = simulation
        .truth
        .coefficients
        .named()
        .map(|(_, value, _)| value);
    let attitudes = true_attitudes(&simulation);
    let record = &simulation.record;
    let of = |bench: &gyrocal_record::Bench| {
        let covariance = cramer_rao_bound(&Run { record, bench }, &attitudes, &drift).unwrap();
        core::array::from_fn::<f64, 9, _>(|i| covariance[i][i])
    };
    let known = of(&simulation.bench);
    let mut bench = simulation.bench.clone();
    bench.uncertainty.latitude_sigma_deg = Some(10.0 / 3600.0);
    let latitude = of(&bench);
    let mut bench = simulation.bench.clone();
    bench.initial_angles_deg = None;
    let azimuth = of(&bench);
    for i in 0..9 {
        assert!(latitude[i] > known[i] && azimuth[i] > known[i], "{i}");
    }
}

#[test]
fn the_bound_needs_an_attitude_for_each_row() {
    let mut simulation = short(0, |_| ());
    let attitudes = true_attitudes(&simulation);
    let of = |simulation: &Simulation, attitudes: &[_]| {
        let run = Run {
            record: &simulation.record,
            bench: &simulation.bench,
        };
        cramer_rao_bound(&run, attitudes, &[0.0; 9])
    };
    of(&simulation, &attitudes).unwrap();
    for wrong in [&attitudes[1..], &[]] {
        let error = of(&simulation, wrong).unwrap_err();
        assert!(
            matches!(error, CalibrationError::Pass { run: 1, .. }),
            "{error}"
        );
    }
    simulation.record.time_s.pop();
    let error = of(&simulation, &attitudes).unwrap_err();
    assert!(
        matches!(error, CalibrationError::UnequalLengths { .. }),
        "{error}"
    );
}

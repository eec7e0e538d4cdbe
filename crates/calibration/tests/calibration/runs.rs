//! Runs as in practice: unknown azimuth, several turn-ons, wrong latitude, outliers, wide priors,
//! fast sampling.
// Failing here is what tests are for.
#![expect(
    clippy::needless_range_loop,
    reason = "loops over several arrays by one index read like what they say"
)]

use gyrocal_calibration::{
    Calibration, CalibrationError, Consistency, Options, Run, SiteQuantity, calibrate,
    calibrate_runs,
};
use gyrocal_record::Bench;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};
use nalgebra::{SMatrix, SVector};

/// Chi-square with 9 degrees of freedom exceeds this once in ten thousand records.
const NEES: f64 = 33.7;

fn scenario(seed: u64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: 2.0 * 86_400.0,
        ..Scenario::default()
    }
}

fn found(simulation: &Simulation, options: &Options) -> Calibration {
    calibrate(&simulation.record, &simulation.bench, options, |_| ()).unwrap()
}

fn together(simulations: &[&Simulation]) -> Calibration {
    let runs: Vec<Run<'_>> = simulations
        .iter()
        .map(|simulation| Run {
            record: &simulation.record,
            bench: &simulation.bench,
        })
        .collect();
    calibrate_runs(&runs, &Options::default(), |_| ()).unwrap()
}

fn nees(calibration: &Calibration, truth: &Coefficients) -> f64 {
    let truth = truth.named();
    let estimate = calibration.drift.to_array();
    let error = SVector::<f64, 9>::from_fn(|i, _| estimate[i] - truth[i].1);
    let covariance = SMatrix::<f64, 9, 9>::from_fn(|i, j| calibration.covariance[i][j]);
    error.dot(&covariance.cholesky().unwrap().solve(&error))
}

fn sigmas(calibration: &Calibration) -> [f64; 9] {
    core::array::from_fn(|i| calibration.covariance[i][i].sqrt())
}

#[test]
fn an_unknown_azimuth_is_found() {
    for seed in 0..4 {
        let mut simulation = simulate(&Scenario {
            latitude_deg: [39.1, -60.0, 10.0, 70.0][seed as usize],
            ..scenario(seed)
        })
        .unwrap();
        simulation.bench.initial_angles_deg = None;
        let found = found(&simulation, &Options::default());
        let search = found.runs[0].azimuth.unwrap();
        assert!(
            search.starts > 1 && !search.is_ambiguous(),
            "seed {seed}: {search:?}"
        );
        assert!(
            nees(&found, &Coefficients::PAPER_LIKE) < NEES,
            "seed {seed}"
        );
        let expected = simulation.truth.platform_c_enu_first().matrix();
        let first = found.runs[0].first_platform_c_enu;
        for (found, expected) in first.as_flattened().iter().zip(expected.as_flattened()) {
            // Azimuth from two days of drifting is known to some 1e-4 rad.
            assert!(
                (found - expected).abs() < 1e-3,
                "seed {seed}: {found} {expected}"
            );
        }
    }
}

#[test]
fn an_unknown_azimuth_needs_an_early_row_with_all_axes() {
    let mut simulation = simulate(&scenario(1)).unwrap();
    simulation.bench.initial_angles_deg = None;
    for (row, time_s) in simulation
        .record
        .accel_g
        .iter_mut()
        .zip(&simulation.record.time_s)
    {
        if *time_s < 1_200.0 {
            row[2] = f64::NAN;
        }
    }
    let options = Options::default();
    let of = |simulation: &Simulation, options: &Options| {
        calibrate(&simulation.record, &simulation.bench, options, |_| ())
    };
    let error = of(&simulation, &options).unwrap_err();
    assert!(matches!(error, CalibrationError::NotLevelled), "{error}");
    let error = of(&simulation, &Options::streaming()).unwrap_err();
    assert!(matches!(error, CalibrationError::NoAttitude), "{error}");
}

#[test]
fn a_second_record_from_another_attitude_shrinks_every_sigma() {
    let aligned = simulate(&Scenario {
        initial: InitialAttitude::AnglesDeg([0.0; 3]),
        ..scenario(1)
    })
    .unwrap();
    let other = simulate(&Scenario {
        initial: InitialAttitude::AnglesDeg([90.0, 45.0, 0.0]),
        ..scenario(2)
    })
    .unwrap();
    let one = found(&aligned, &Options::default());
    let both = together(&[&aligned, &other]);
    assert!(nees(&both, &Coefficients::PAPER_LIKE) < NEES);
    assert_eq!(both.fit.values(), 2 * one.fit.values());
    let logarithms = sigmas(&one)
        .into_iter()
        .zip(sigmas(&both))
        .map(|(one, both)| {
            assert!(both < one, "{both} {one}");
            (both / one).ln()
        });
    // As much again of the same would give 0.71.
    let mean = (logarithms.sum::<f64>() / 9.0).exp();
    assert!(mean < 0.71, "{mean}");
    // The order of the records does not matter but for rounding and where steps began.
    let turned = together(&[&other, &aligned]);
    for (i, sigma) in sigmas(&both).into_iter().enumerate() {
        let off = turned.drift.to_array()[i] - both.drift.to_array()[i];
        assert!(off.abs() < 1e-4 * sigma, "{i}: {off}");
    }
}

#[test]
fn constant_drifts_may_differ_between_turn_ons() {
    let turn_on = 0.05;
    let mean = Coefficients::PAPER_LIKE;
    let offsets = [[0.06, -0.03, 0.01], [-0.04, 0.02, 0.05]];
    let simulations = [0, 1].map(|run| {
        let mut coefficients = mean;
        for axis in 0..3 {
            coefficients.bias_deg_per_h[axis] += offsets[run][axis];
        }
        let mut simulation = simulate(&Scenario {
            coefficients,
            ..scenario(20 + run as u64)
        })
        .unwrap();
        simulation.bench.prior.turn_on_sigma_deg_per_h = [turn_on; 3];
        simulation
    });
    let found = together(&[&simulations[0], &simulations[1]]);
    assert_eq!(found.fit.consistency(), Consistency::Consistent);
    assert!(nees(&found, &mean) < NEES);
    let estimate = found.drift.to_array();
    for axis in 0..3 {
        // Two turn-ons tell their mean to 0.05 / √2 at best.
        let sigma = sigmas(&found)[3 * axis];
        assert!(
            (sigma / (turn_on / 2.0_f64.sqrt()) - 1.0).abs() < 0.02,
            "{sigma}"
        );
        for run in 0..2 {
            let [offset, sigma] = found.runs[run].turn_on_deg_per_h.unwrap()[axis];
            assert!(sigma < turn_on);
            // The drift of each turn-on is known far better than mean and offset are.
            let own = mean.bias_deg_per_h[axis] + offsets[run][axis];
            let off = estimate[3 * axis] + offset - own;
            assert!(off.abs() < 0.02 * turn_on, "run {run}, axis {axis}: {off}");
        }
    }
    // Counted as equal they contradict each other.
    let same = simulations.map(|mut simulation| {
        simulation.bench.prior.turn_on_sigma_deg_per_h = [0.0; 3];
        simulation
    });
    let same = together(&[&same[0], &same[1]]);
    assert_eq!(same.fit.consistency(), Consistency::Overconfident);
    assert!(same.runs.iter().all(|run| run.turn_on_deg_per_h.is_none()));
}

#[test]
fn the_streaming_filter_reads_one_record() {
    let simulation = simulate(&scenario(1)).unwrap();
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let error = calibrate_runs(&[run, run], &Options::streaming(), |_| ()).unwrap_err();
    assert!(
        matches!(error, CalibrationError::OneRecord { found: 2 }),
        "{error}"
    );
}

#[test]
fn a_wrong_latitude_biases_as_predicted() {
    let error_deg = 10.0 / 3600.0;
    for seed in 0..3 {
        let clean = scenario(seed);
        let shifted = Scenario {
            hidden: vec![Hidden::new("site.latitude", &[("size", error_deg)]).unwrap()],
            ..clean.clone()
        };
        let options = Options::default();
        let [before, after] =
            [clean, shifted].map(|scenario| found(&simulate(&scenario).unwrap(), &options));
        let influence = before
            .site_sensitivities
            .iter()
            .find(|influence| influence.quantity == SiteQuantity::Latitude)
            .unwrap();
        let (mut moved, mut missed) = (0.0, 0.0);
        for i in 0..9 {
            let sigma = before.covariance[i][i].sqrt();
            let shift = after.drift.to_array()[i] - before.drift.to_array()[i];
            let predicted = influence.bias_per_unit[i] * error_deg;
            moved += (shift / sigma).powi(2);
            missed += ((shift - predicted) / sigma).powi(2);
        }
        // What is asked for is 2 %; 0.02 % was seen, the curvature over ten seconds of arc.
        assert!(missed.sqrt() < 0.002 * moved.sqrt(), "{missed} {moved}");
        assert!(moved > 1.0, "seconds of arc matter");
        // Declared, the uncertainty covers the error that it is of.
        let mut simulation = simulate(&scenario(seed)).unwrap();
        simulation.bench.uncertainty.latitude_sigma_deg = Some(error_deg);
        let covered = found(&simulation, &options);
        for i in 0..9 {
            let bias = influence.bias_per_unit[i] * error_deg;
            let expected = before.covariance[i][i] + bias * bias;
            assert!((covered.covariance[i][i] / expected - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn outliers_are_bounded() {
    for seed in 0..4 {
        let mut simulation = simulate(&scenario(seed)).unwrap();
        let noise_g = simulation.bench.accel_noise_g;
        let mut spoilt = 0;
        for (row, sample) in simulation.record.accel_g.iter_mut().enumerate() {
            // One value of two hundred, of either sign.
            for (axis, value) in sample.iter_mut().enumerate() {
                if (3 * row + axis) % 199 == 57 {
                    *value += if spoilt % 2 == 0 { 50.0 } else { -50.0 } * noise_g;
                    spoilt += 1;
                }
            }
        }
        let trusting = found(&simulation, &Options::default());
        assert_eq!(trusting.fit.consistency(), Consistency::Overconfident);
        let bounding = Options {
            outlier_bound: Some(4.0),
            ..Options::default()
        };
        let robust = found(&simulation, &bounding);
        let bounded = robust.runs[0].bounded_values;
        // Beyond four sigmas are the outliers and some 0.3 of the other 4300 values.
        assert!(
            (spoilt..spoilt + 6).contains(&bounded),
            "{bounded} of {spoilt}"
        );
        // Twice what an untouched record gives: a bounded outlier still pulls with four sigmas.
        let sane = nees(&robust, &Coefficients::PAPER_LIKE);
        assert!(sane < 2.0 * NEES, "seed {seed}: {sane}");
        assert!(sane < nees(&trusting, &Coefficients::PAPER_LIKE));
    }
}

fn wide(bench: &Bench, sigma: f64) -> Bench {
    let mut bench = bench.clone();
    bench.prior.bias_sigma_deg_per_h = [sigma; 3];
    bench.prior.g_sigma_deg_per_h_per_g = [sigma; 3];
    bench.prior.gg_sigma_deg_per_h_per_g2 = [sigma; 3];
    bench
}

#[test]
fn the_iteration_converges_from_wide_priors() {
    for seed in 0..4 {
        let mut simulation = simulate(&scenario(seed)).unwrap();
        let usual = found(&simulation, &Options::default());
        for sigma in [3.0, 10.0] {
            simulation.bench = wide(&simulation.bench, sigma);
            let found = found(&simulation, &Options::default());
            assert_eq!(
                found.fit.consistency(),
                Consistency::Consistent,
                "seed {seed}, {sigma}"
            );
            assert!(
                nees(&found, &Coefficients::PAPER_LIKE) < NEES,
                "seed {seed}, {sigma}"
            );
            for (wide, usual) in sigmas(&found).into_iter().zip(sigmas(&usual)) {
                // Two days determine all nine: the prior adds little to either.
                assert!((0.999..1.2).contains(&(wide / usual)), "{wide} {usual}");
            }
        }
    }
}

#[test]
fn a_record_at_one_hertz_is_used_as_it_is() {
    let simulation = simulate(&Scenario {
        interval_s: 1.0,
        duration_s: 12.0 * 3600.0,
        ..scenario(5)
    })
    .unwrap();
    let found = found(&simulation, &Options::default());
    assert_eq!(found.fit.rows(), 43_201);
    assert_eq!(found.fit.consistency(), Consistency::Consistent);
    assert!(nees(&found, &Coefficients::PAPER_LIKE) < NEES);
}

#[test]
fn noise_is_estimated_relative_to_the_declared_one() {
    let mut simulation = simulate(&scenario(6)).unwrap();
    // Declared too small by half and too large by two.
    simulation.bench.accel_noise_g /= 1.5;
    simulation.bench.gyro_noise_deg_per_h *= 2.0;
    let options = Options {
        noise: true,
        ..Options::default()
    };
    let noise = found(&simulation, &options).runs[0].noise.unwrap();
    for (ratios, expected) in [(noise.accel, 1.5), (noise.gyro, 0.5)] {
        for found in ratios {
            let [low, high] = found.interval.map(f64::ln);
            // Five sigmas; the interval is of two.
            let allowed = 2.5 * (high - low) / 2.0;
            assert!((found.ratio / expected).ln().abs() < allowed, "{found:?}");
            assert!(low < high && found.ratio > 0.0);
        }
    }
}

/// At the pole of the angles two of them rotate about one axis. The attitude error is one declared sigma
/// about another axis, about which the covariance of the angles alone would be zero.
#[test]
fn the_pole_of_the_angles_is_an_attitude_like_any_other() {
    for (seed, angles_deg) in [
        [0.0, 85.0, 0.0],
        [0.0, 90.0, 30.0],
        [10.0, 90.0, 20.0],
        [45.0, -90.0, 45.0],
        [1.0, 89.999, 1.0],
    ]
    .into_iter()
    .enumerate()
    {
        let off = [("x_deg", 0.02), ("y_deg", 0.0), ("z_deg", 0.0)];
        let simulation = simulate(&Scenario {
            initial: InitialAttitude::AnglesDeg(angles_deg),
            initial_angles_sigma_deg: [0.02; 3],
            hidden: vec![Hidden::new("platform.initial_attitude", &off).unwrap()],
            ..scenario(seed as u64)
        })
        .unwrap();
        let found = found(&simulation, &Options::default());
        let nees = nees(&found, &Coefficients::PAPER_LIKE);
        assert!(nees < NEES, "{angles_deg:?}: {nees}");
        assert_eq!(
            found.fit.consistency(),
            Consistency::Consistent,
            "{angles_deg:?}"
        );
    }
}

/// A tenth of g in one row, early or late: the initial guess leaves it out, and its weight vanishes.
#[test]
fn a_gross_error_of_one_row_does_not_affect_a_robust_estimate() {
    for row in [0, 8, 40, 700, 1440] {
        let mut simulation = simulate(&scenario(5)).unwrap();
        let robust = Options {
            outlier_bound: Some(3.0),
            ..Options::default()
        };
        let sound = found(&simulation, &robust);
        simulation.record.accel_g[row][2] += 0.1;
        let spoilt = found(&simulation, &robust);
        let sigmas = sigmas(&sound);
        for i in 0..9 {
            let moved = (spoilt.drift.to_array()[i] - sound.drift.to_array()[i]) / sigmas[i];
            // One row of 1441 is gone; the first alone tells the attitude of its moment.
            assert!(moved.abs() < 0.5, "row {row}, {i}: {moved} sigmas");
        }
    }
}

//! The expected size of open-loop residuals against simulated records.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run, SiteQuantity, calibrate};
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};

fn two_days(seed: u64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::AnglesDeg([12.0, -25.0, 40.0]),
        interval_s: 240.0,
        duration_s: 2.0 * 86_400.0,
        ..Scenario::default()
    }
}

/// Mean over rows and records of the squared residual over its expected variance is one. Residuals of a
/// record are correlated over hours: a record has some six independent ones an axis, so that the mean
/// over 40 records of three axes has a standard deviation of √(2 / 720) = 0.05. A band
/// without the noise of the gyros gives 1.6, and one of all their noise, of which the fit absorbs most, much
/// less than one.
#[test]
fn open_loop_residuals_are_as_large_as_expected() {
    let (mut sum, mut count, mut without_gyros) = (0.0, 0.0, 0.0);
    for seed in 0..40 {
        let simulation = simulate(&two_days(seed)).unwrap();
        let run = Run {
            record: &simulation.record,
            bench: &simulation.bench,
        };
        let fit =
            FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
        let simulated_g = fit.free_run_g().unwrap();
        let sigmas_g = fit.free_run_sigma_g(&simulated_g).unwrap();
        for ((measured, simulated), sigma) in
            run.record.accel_g.iter().zip(&simulated_g).zip(&sigmas_g)
        {
            for axis in 0..3 {
                let residual = measured[axis] - simulated[axis];
                sum += (residual / sigma[axis]).powi(2);
                without_gyros += (residual / run.bench.accel_noise_g).powi(2);
                count += 1.0;
            }
        }
    }
    let mean = sum / count;
    assert!((mean - 1.0).abs() < 0.2, "{mean}");
    assert!(without_gyros / count > 1.3, "{}", without_gyros / count);
}

/// The same biases by errors of the site as the joint calibration, which has its own model and columns
/// for them: to a thousandth, as the two fits linearise about slightly different points.
#[test]
fn biases_by_the_site_are_those_of_the_calibration() {
    let simulation = simulate(&two_days(7)).unwrap();
    let (record, bench) = (&simulation.record, &simulation.bench);
    let run = Run { record, bench };
    let fit = FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
    let joint = calibrate(record, bench, &Options::default(), |_| ()).unwrap();
    let mut compared = 0;
    for found in fit.site_biases().unwrap() {
        let expected = joint.site_sensitivity(found.quantity).unwrap();
        assert_eq!(found.is_declared, expected.declared_sigma.is_some());
        for (index, per_unit) in expected.bias_per_unit.into_iter().enumerate() {
            let sigma = joint.covariance[index][index].sqrt();
            let in_sigmas = per_unit * expected.assumed_error() / sigma;
            let off = found.in_sigmas[index] - in_sigmas;
            assert!(
                off.abs() < 1e-3 * (1.0 + in_sigmas.abs()),
                "{:?} {index}: {off}",
                found.quantity
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 9 * SiteQuantity::ALL.len());
}

//! Predictive densities and convergence of a fitted model, each against another computation.

use gyrocal::Catalogue;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal::trajectory::rotation_between;
use gyrocal_calibration::{
    Expectation, FittedPlatform, GYRO_NOISE_PRIOR_SIGMA, NoiseModel, Options, Run,
};
use gyrocal_hypothesis::{ModelExtension, RateNoise};
use gyrocal_truth::{InitialAttitude, Scenario, Simulation, simulate};
use nalgebra::DMatrix;

fn simulation() -> Simulation {
    simulate(&Scenario {
        seed: 3,
        initial: InitialAttitude::Random,
        duration_s: 86_400.0,
        interval_s: 300.0,
        ..Scenario::default()
    })
    .unwrap()
}

fn fitted(simulation: &Simulation) -> FittedPlatform<'_> {
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap()
}

#[test]
fn the_predictive_density_of_the_prior_is_the_evidence() {
    let simulation = simulation();
    let fit = fitted(&simulation);
    let mut factor = DMatrix::zeros(Catalogue::PARAMETERS, 9);
    for (i, sigma) in fit.prior_sigma().into_iter().enumerate() {
        factor[(i, i)] = sigma;
    }
    let expected = Expectation {
        mean: vec![0.0; Catalogue::PARAMETERS],
        factor,
    };
    let density = fit.log_density_given(&expected).unwrap();
    let evidence = fit.log_evidence_without(0..0).unwrap();
    // Ten thousand nats; priors of 1 deg/h over sigmas of 1e-4 cost some digits of 1e-16.
    assert!((density - evidence).abs() < 1e-4, "{density} {evidence}");
    // A wrong mean that counts as known makes the record far less likely.
    let mut wrong = Expectation {
        factor: DMatrix::zeros(Catalogue::PARAMETERS, 1),
        mean: fit.parameters(),
    };
    let right = fit.log_density_given(&wrong).unwrap();
    assert!(right > evidence);
    wrong.mean[0] += 10.0 * fit.covariance()[(0, 0)].sqrt();
    // Ten marginal sigmas of one coefficient are at least ten with the others held: 50 nats.
    let off = fit.log_density_given(&wrong).unwrap();
    assert!(off < right - 49.0, "{off} {right}");
}

#[test]
fn the_order_of_an_extension_does_not_matter() {
    let simulation = simulation();
    let fit = fitted(&simulation);
    let place = |id: &str| PARAMETERS.iter().position(|p| p.id == id).unwrap();
    // One free, one known to a thousandth of what the record says.
    let (free, known) = (
        (place("gyro_x.g_y"), f64::INFINITY),
        (place("gyro_z.g_x"), 1e-7),
    );
    let evidence = |parameters: Vec<(usize, f64)>| {
        let extension = ModelExtension {
            parameters,
            ..ModelExtension::default()
        };
        let fit = fit.refitted(&extension).unwrap();
        fit.log_evidence_without(0..40).unwrap()
    };
    let (one, other) = (evidence(vec![free, known]), evidence(vec![known, free]));
    // Both are converged to 1e-4 of a sigma, and rounding differs.
    assert!((one - other).abs() < 1e-3, "{one} {other}");
}

#[test]
fn the_first_rows_are_a_record_without_the_others() {
    let simulation = simulation();
    let white = fitted(&simulation);
    let walking = RateNoise {
        white: vec![1.3, 0.8, 1.0],
        walk: vec![0.0, 3e-4, 1e-3],
    };
    let walking = white.with_rate_noise(&walking).unwrap();
    let rows = simulation.record.len();
    for fit in [&white, &walking] {
        for first in [rows / 3, rows] {
            let own = fit.log_evidence_of_first(first, &fit.rate_noise()).unwrap();
            let without = fit.log_evidence_without(first..rows).unwrap();
            // Some thousand nats, added up in another order.
            assert!((own - without).abs() < 1e-6, "{own} {without}");
        }
    }
    // The estimate is where density and prior are largest together.
    let penalised = |noise: &RateNoise| {
        let off = noise.white[0].ln() / GYRO_NOISE_PRIOR_SIGMA;
        walking.log_evidence_of_first(rows / 2, noise).unwrap() - 0.5 * off * off
    };
    let own = walking.fit_rate_noise_to_first(rows / 2).unwrap().noise;
    let best = penalised(&own);
    for factor in [0.3, 3.0] {
        let mut other = own.clone();
        other.white[0] *= factor;
        let worse = penalised(&other);
        assert!(worse < best, "{worse} {best}");
    }
}

#[test]
fn noise_of_the_first_rows_knows_nothing_of_later_ones() {
    let simulation = simulation();
    let rows = simulation.record.len();
    let mut changed = simulation.clone();
    for (row, accel_g) in changed.record.accel_g.iter_mut().enumerate().skip(rows / 2) {
        // Ten times the declared noise, alternating.
        let sign = if row % 2 == 0 { 1.0 } else { -1.0 };
        for value in accel_g {
            *value += 1e-4 * sign;
        }
    }
    let [one, other] = [&simulation, &changed].map(|simulation| {
        let fit = fitted(simulation);
        fit.fit_rate_noise_to_first(rows / 2).unwrap().noise
    });
    for (one, other) in one.white.iter().zip(&other.white) {
        // The scoring ends at 0.02 nats, a fifth of a sigma, which is some per cent; about another line.
        assert!((one / other - 1.0).abs() < 0.01, "{one} {other}");
    }
}

#[test]
fn the_last_estimate_is_that_of_the_fit() {
    let simulation = simulation();
    let fit = fitted(&simulation);
    let last = simulation.record.len() - 1;
    let found = fit.convergence(&[last / 2, last]).unwrap();
    let [Some(half), Some(whole)] = found.as_slice() else {
        panic!("{found:?}");
    };
    for i in 0..9 {
        let sigma = fit.covariance()[(i, i)].sqrt();
        // The fit is converged to 1e-4 of a sigma.
        assert!((whole.coefficients[i] - fit.values()[i]).abs() < 1e-3 * sigma);
        assert!((whole.sigmas[i] / sigma - 1.0).abs() < 1e-6);
        assert!(half.sigmas[i] > sigma);
    }
}

#[test]
fn drift_from_the_first_row_is_the_free_run() {
    let simulation = simulation();
    let fit = fitted(&simulation);
    let rows = simulation.record.len();
    let free = fit.free_run_g().unwrap();
    let drift = fit.drift_from(&fit.parameters(), 0..rows).unwrap();
    for (row, ([_, up], free)) in drift.iter().zip(&free).enumerate() {
        // Without accelerometer errors in the model an ideal reading is the direction of up.
        for axis in 0..3 {
            assert!((up[axis] - free[axis]).abs() < 1e-12, "row {row}");
        }
    }
    // From a later row on the smoothed attitude is the start.
    let later = fit.drift_from(&fit.parameters(), 100..110).unwrap();
    let turn = rotation_between(&later[0], &fit.points()[100]);
    assert_eq!((later.len(), turn), (10, [0.0; 3]));
    assert!(fit.drift_from(&fit.parameters(), 100..rows + 1).is_err());
}

/// The same products by two ways, one of them from the kept steps of the fit.
#[test]
fn columns_of_a_fit_are_in_the_order_of_its_values() {
    let simulation = simulation();
    let nominal = fitted(&simulation);
    let place = |id: &str| PARAMETERS.iter().position(|p| p.id == id).unwrap();
    // Not in the order of the model.
    let later = ["gyro_z.g_xy", "accel_y.scale", "gyro_x.g_y"].map(place);
    assert!(!later.is_sorted());
    let extension = ModelExtension {
        parameters: later.map(|place| (place, f64::INFINITY)).to_vec(),
        ..nominal.extension().clone()
    };
    let fit = nominal.refitted(&extension).unwrap();
    let onset = [gyrocal_hypothesis::Column::Step {
        parameter: 0,
        row: 100,
    }];
    let all = fit.signatures(&onset, |_| ()).unwrap().gram;
    let conditional = fit.conditional(&onset).unwrap().gram;
    let columns: Vec<usize> = (0..10)
        .chain(later.map(|place| place + 1))
        .chain([all.ncols() - 1])
        .collect();
    let expected = all.select_rows(&columns).select_columns(&columns);
    assert_eq!(conditional.shape(), expected.shape());
    for i in 0..columns.len() {
        for j in 0..columns.len() {
            let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
            // Sums of a thousand products in another order.
            let error = (conditional[(i, j)] - expected[(i, j)]).abs();
            assert!(error < 1e-12 * scale, "{i} {j}: {error} of {scale}");
        }
    }
}

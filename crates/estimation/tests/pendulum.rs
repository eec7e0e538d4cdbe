//! The structured filter against the dense textbook filter on a model of another kind:
//! parameters in the output, noise of its own, flat state space.
#![cfg(test)]

mod common;

use chacha20::ChaCha12Rng;
use common::{BIAS, Pendulum, STIFFNESS};
use gyrocal_estimation::dense::DenseFilter;
use gyrocal_estimation::form::Form;
use gyrocal_estimation::{
    ArrayStorage, Covariance, EstimationError, Factors, Filter, Integration, Recentring, Storage,
    VecStorage,
};
use gyrocal_scalar::Model;
use nalgebra::{SMatrix, SVector};
use rand::{RngExt, SeedableRng};

const STATE: [f64; 6] = [0.5, 0.0, 0.0, 0.0, 4.0, 0.1];
const SIGMA: [f64; 6] = [0.1, 0.2, 0.05, 0.02, 0.5, 0.05];
const NOISE_DENSITY: [f64; 2] = [1e-4, 0.0];
const VARIANCE: [f64; 2] = [1e-4, 4e-4];
const STEP_S: f64 = 0.05;

type Pendulums<S, F = Covariance> = Filter<f64, Pendulum, (), S, 2, 2, F>;

fn filter<S: Storage<f64>>(integration: Integration, storage: S) -> Pendulums<S> {
    with_form(integration, storage)
}

fn with_form<S: Storage<f64>, F: Form<f64>>(
    integration: Integration,
    storage: S,
) -> Pendulums<S, F> {
    let recentring = Recentring::EveryStep;
    Filter::with_form(
        Pendulum,
        (),
        integration,
        recentring,
        storage,
        &STATE,
        &SIGMA,
    )
    .unwrap()
}

/// Measurements of a pendulum with other parameters, roughly integrated: any data will do.
fn measurements(seed: u64, count: usize) -> Vec<[f64; 2]> {
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let parameters = [0.03, 0.01, 4.4, 0.07];
    let mut moving = [0.55, 0.1];
    (0..count)
        .map(|_| {
            for _ in 0..50 {
                let rates = Pendulum.rates(&moving, &parameters, &());
                moving = [moving[0] + rates[0] * 1e-3, moving[1] + rates[1] * 1e-3];
            }
            Pendulum
                .output(&moving, &parameters, &())
                .map(|output| output + 0.01 * rng.random_range(-1.7..1.7))
        })
        .collect()
}

/// Largest difference of states and covariances, in sigmas of the dense filter.
fn distance<S: Storage<f64>, F: Form<f64>>(
    filter: &Pendulums<S, F>,
    dense: &DenseFilter<Pendulum, (), 2, 2, 6>,
) -> f64 {
    let mut worst = 0.0_f64;
    for i in 0..6 {
        let sigma = dense.covariance[(i, i)].sqrt();
        worst = worst.max((filter.state()[i] - dense.state[i]).abs() / sigma);
        for j in 0..6 {
            let scale = sigma * dense.covariance[(j, j)].sqrt();
            worst = worst.max((filter.covariance(i, j) - dense.covariance[(i, j)]).abs() / scale);
        }
    }
    worst
}

#[test]
fn equals_the_dense_filter_on_a_model_with_output_parameters_and_noise_of_its_own() {
    for integration in [
        Integration::EULER,
        Integration::RK4,
        Integration::Euler { substeps: 3 },
        Integration::Rk4 { substeps: 2 },
    ] {
        let mut array = filter(integration, ArrayStorage::<f64, 2, 2, 6>::new());
        let mut factors: Pendulums<_, Factors> =
            with_form(integration, ArrayStorage::<f64, 2, 2, 6>::new());
        let mut vector = filter(integration, VecStorage::new(6, 2, 2));
        let mut dense = DenseFilter::new(
            Pendulum,
            (),
            integration,
            Recentring::EveryStep,
            SVector::from(STATE),
            SMatrix::from_diagonal(&SVector::from(SIGMA.map(|sigma| sigma * sigma))),
        );
        for (step, mut measured) in measurements(1, 400).into_iter().enumerate() {
            // Missing and complete samples take turns: what is blanked must come back.
            if step % 5 == 3 {
                measured[step % 2] = f64::NAN;
            }
            array.predict(STEP_S, &NOISE_DENSITY).unwrap();
            vector.predict(STEP_S, &NOISE_DENSITY).unwrap();
            factors.predict(STEP_S, &NOISE_DENSITY).unwrap();
            dense.predict(STEP_S, &NOISE_DENSITY);
            let innovation = array.update(&measured, &VARIANCE).unwrap();
            vector.update(&measured, &VARIANCE).unwrap();
            factors.update(&measured, &VARIANCE).unwrap();
            let reference = match measured.iter().position(|value| value.is_nan()) {
                None => dense.update(&measured, &VARIANCE).unwrap(),
                Some(missing) => {
                    // The limit of large noise: 1e-16 of what the filters are compared to.
                    let mut variance = VARIANCE;
                    variance[missing] = 1e16;
                    measured[missing] = 0.0;
                    dense.update(&measured, &variance).unwrap()
                }
            };
            assert!(
                distance(&factors, &dense) < 1e-10,
                "{}",
                distance(&factors, &dense)
            );
            // Two algorithms, 400 steps of rounding at a condition number of about 1e4.
            assert!(
                distance(&array, &dense) < 1e-10,
                "{}",
                distance(&array, &dense)
            );
            assert!((innovation.nis - reference.nis).abs() < 1e-9 * (1.0 + reference.nis));
            let covariance = innovation.covariance();
            if innovation.degrees_of_freedom() < 2 {
                continue;
            }
            for (i, row) in covariance.iter().enumerate() {
                for (j, found) in row.iter().enumerate() {
                    let expected = reference.covariance[(i, j)];
                    let scale =
                        (reference.covariance[(i, i)] * reference.covariance[(j, j)]).sqrt();
                    assert!((found - expected).abs() < 1e-11 * scale);
                }
            }
        }
        assert_eq!(
            array.state(),
            vector.state(),
            "storage must not change a bit"
        );
        assert!(
            array.sigma(STIFFNESS) < 0.1 && array.sigma(BIAS) < 0.02,
            "nothing was learnt"
        );
    }
}

#[test]
fn a_missing_component_is_the_limit_of_large_noise_and_says_so() {
    let [measured] = measurements(2, 1)[..] else {
        unreachable!()
    };
    let mut missing = filter(Integration::RK4, ArrayStorage::<f64, 2, 2, 6>::new());
    let mut noisy = missing.clone();
    let innovation = missing.update(&[measured[0], f64::NAN], &VARIANCE).unwrap();
    noisy.update(&measured, &[VARIANCE[0], 1e16]).unwrap();
    assert_eq!(innovation.observed, [true, false]);
    assert_eq!(innovation.degrees_of_freedom(), 1);
    assert!(innovation.covariance()[1][1].is_nan());
    for i in 0..6 {
        assert!((missing.state()[i] - noisy.state()[i]).abs() < 1e-12);
        assert!((missing.sigma(i) / noisy.sigma(i) - 1.0).abs() < 1e-12);
    }
    let before = missing.state().to_vec();
    let nothing = missing.update(&[f64::NAN; 2], &VARIANCE).unwrap();
    assert_eq!((nothing.nis, nothing.degrees_of_freedom()), (0.0, 0));
    assert_eq!(missing.state(), before);
}

#[test]
fn gating_keeps_the_filter_as_it_was_and_agrees_with_the_update() {
    let [measured] = measurements(3, 1)[..] else {
        unreachable!()
    };
    let mut filter = filter(Integration::RK4, ArrayStorage::<f64, 2, 2, 6>::new());
    let wild = [measured[0] + 5.0, measured[1]];
    let before = filter.clone();
    let (rejected, used) = filter.update_gated(&wild, &VARIANCE, 20.0).unwrap();
    assert!(!used && rejected.nis > 20.0);
    assert_eq!(filter.state(), before.state());
    assert_eq!(filter.sigma(0), before.sigma(0));
    let (accepted, used) = filter.update_gated(&measured, &VARIANCE, 20.0).unwrap();
    let plain = before.clone().update(&measured, &VARIANCE).unwrap();
    assert!(used && accepted == plain);
    assert!(filter.sigma(0) < before.sigma(0));
}

#[test]
fn predicting_twice_over_half_a_step_adds_the_same_noise() {
    // White noise: two held halves integrate to the same variance up to the curvature of the
    // motion inside a step, which is of order (STEP_S * frequency)² = 1 %.
    let mut whole = filter(Integration::RK4, ArrayStorage::<f64, 2, 2, 6>::new());
    let mut halves = whole.clone();
    let density = [1.0, 0.0];
    whole.predict(STEP_S, &density).unwrap();
    halves.predict(STEP_S / 2.0, &density).unwrap();
    halves.predict(STEP_S / 2.0, &density).unwrap();
    assert!((whole.covariance(1, 1) / halves.covariance(1, 1) - 1.0).abs() < 0.01);
}

#[test]
fn arguments_without_meaning_are_errors() {
    let storage = ArrayStorage::<f64, 2, 2, 6>::new;
    let every = Recentring::EveryStep;
    let short = Filter::new(
        Pendulum,
        (),
        Integration::RK4,
        every,
        storage(),
        &STATE[..5],
        &SIGMA,
    );
    assert!(matches!(
        short,
        Err(EstimationError::InvalidArgument { .. })
    ));
    let mut sigma = SIGMA;
    sigma[3] = 0.0;
    let flat = Filter::new(
        Pendulum,
        (),
        Integration::RK4,
        every,
        storage(),
        &STATE,
        &sigma,
    );
    assert_eq!(
        flat.err(),
        Some(EstimationError::NotPositiveDefinite { state: 3 })
    );
    let none = Integration::Euler { substeps: 0 };
    let none = Filter::new(Pendulum, (), none, every, storage(), &STATE, &SIGMA);
    assert!(matches!(none, Err(EstimationError::InvalidArgument { .. })));
    let mut good = filter(Integration::RK4, storage());
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = good.predict(step, &NOISE_DENSITY);
        assert!(
            matches!(error, Err(EstimationError::InvalidArgument { .. })),
            "{step}"
        );
    }
    let negative = good.update(&[0.0; 2], &[1e-4, -1.0]);
    assert_eq!(
        negative.err(),
        Some(EstimationError::InvalidNoise { output: 1 })
    );
    let infinite = good.update(&[f64::INFINITY, 0.0], &VARIANCE);
    assert!(matches!(infinite, Err(EstimationError::NotFinite { .. })));
}

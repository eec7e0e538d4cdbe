//! The batch estimator on a model that has nothing to do with gyros, against dense least squares
//! and direct Gaussian densities.
// Failing here is what tests are for.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]
#![allow(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

#[path = "batch/chain.rs"]
mod chain;
#[allow(dead_code, reason = "some constants are those of other tests")]
mod common;
#[path = "batch/density.rs"]
mod density;
#[path = "batch/least_squares.rs"]
mod least_squares;

use chain::{Chain, Disturbances, VARIANCE, solve};
use common::Pendulum;
use density::Density;
use gyrocal_estimation::batch::{Columns, Linearisation, NoColumns};
use gyrocal_estimation::{EstimationError, Integration};
use least_squares::LeastSquares;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// Rounding, and a derivative by differences of fourth order, over some dozen rows; 1e-9 was seen.
const SAME_SIGMAS: f64 = 1e-7;

#[test]
fn gauss_newton_is_dense_least_squares() {
    for seed in 0..4 {
        let chain = Chain::measured(seed);
        let found = solve(&chain, &NoColumns, &[]);
        let dense = LeastSquares::new(&chain, &[]).solve();
        assert_same(&found.parameters, &found.covariance, &dense);
        for (point, expected) in found.points.iter().zip(&dense.points) {
            for i in 0..2 {
                // An angle is measured to a hundredth of a radian.
                assert!((point[i] - expected[i]).abs() < 1e-2 * SAME_SIGMAS);
            }
        }
        assert!((found.cost / dense.cost - 1.0).abs() < 1e-9);
    }
}

#[test]
fn further_columns_are_explicit_parameters() {
    let chain = Chain::measured(7);
    let disturbances = Disturbances::default();
    let sigma = [0.3, 0.5, 0.2];
    let found = solve(&chain, &disturbances, &sigma);
    let dense = LeastSquares::new(&chain, &sigma).solve();
    assert_eq!(found.parameters.len(), 4 + 3);
    assert_same(&found.parameters, &found.covariance, &dense);
    // They are there: the data were made without them, yet chance gives each some size.
    assert!(found.parameters[4..].iter().all(|size| size.abs() > 1e-4));
}

#[track_caller]
fn assert_same(parameters: &[f64], covariance: &DMatrix<f64>, dense: &least_squares::Solution) {
    for (i, parameter) in parameters.iter().enumerate() {
        let sigma = dense.covariance[(i, i)].sqrt();
        let off = (parameter - dense.parameters[i]) / sigma;
        assert!(off.abs() < SAME_SIGMAS, "{i}: {off} sigmas");
        for j in 0..parameters.len() {
            let scale = sigma * dense.covariance[(j, j)].sqrt();
            let off = (covariance[(i, j)] - dense.covariance[(i, j)]) / scale;
            assert!(off.abs() < SAME_SIGMAS, "{i}, {j}: {off}");
        }
    }
}

#[test]
fn the_likelihood_is_that_of_the_joint_gaussian() {
    let chain = Chain::measured(3);
    let trajectory = chain.trajectory();
    let reduced = chain
        .linearised(&trajectory, &chain.parameters(), &[], &NoColumns)
        .reduce(|_| ())
        .unwrap();
    let (residuals, covariance) = Density { chain: &chain }.outputs_given_parameters();
    assert_eq!(reduced.values, residuals.len());
    let cholesky = covariance.cholesky().unwrap();
    let square = residuals.dot(&cholesky.solve(&residuals));
    let log_determinant = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
    // Rounding, and covariances by differences.
    assert!((reduced.gram[(0, 0)] / square - 1.0).abs() < 1e-8);
    assert!((reduced.log_variance - log_determinant).abs() < 1e-7);
    let score = chain
        .linearised(&trajectory, &chain.parameters(), &[], &NoColumns)
        .noise_score(&[1.0; 4])
        .unwrap();
    let count = residuals.len() as f64;
    let expected = -0.5 * (square + log_determinant + count * core::f64::consts::TAU.ln());
    assert!((score.log_likelihood - expected).abs() < 1e-6);
}

#[test]
fn the_cost_of_a_trajectory_counts_prior_noise_and_outputs() {
    let chain = Chain::measured(5);
    // On the prior mean and without noise only outputs cost.
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let cost = |points: &[[f64; 2]]| {
        chain
            .linearised(points, &parameters, &[], &NoColumns)
            .reduce(|_| ())
            .unwrap()
            .trajectory_cost
    };
    let outputs: f64 = chain.output_squares(&trajectory).iter().sum();
    assert!((cost(&trajectory) / outputs - 1.0).abs() < 1e-12);
    // The last point of all, moved alone, costs what its own residuals and the last step's noise say.
    let mut moved = trajectory.clone();
    let last = moved.len() - 1;
    moved[last][1] += 1e-3;
    let more = cost(&moved) - cost(&trajectory);
    let noise = chain.step_noise(last - 1, &trajectory, &parameters);
    let jump = nalgebra::Vector2::new(0.0, 1e-3);
    let squares = chain.output_squares(&moved);
    let outputs_now: f64 = squares.iter().sum();
    let expected = jump.dot(&(noise.try_inverse().unwrap() * jump)) + outputs_now - outputs;
    // The noise of a step comes from central differences here.
    assert!((more / expected - 1.0).abs() < 1e-6, "{more} {expected}");
}

#[test]
fn the_score_of_the_noise_is_the_gradient_of_its_likelihood() {
    let chain = Chain::measured(9);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let score = |factors: &[f64; 4]| {
        chain
            .linearised(&trajectory, &parameters, &[], &NoColumns)
            .noise_score(factors)
            .unwrap()
    };
    let at = [1.3, 0.6, 2.0, 1.0];
    let found = score(&at);
    // The second noise input drives nothing: nothing can be said of it.
    assert_eq!(found.gradient[3], 0.0);
    for k in 0..3 {
        let likelihood = |logarithm: f64| {
            let mut factors = at;
            factors[k] *= logarithm.exp();
            score(&factors).log_likelihood
        };
        let step = 1e-3;
        let by_difference = (8.0 * (likelihood(step) - likelihood(-step)) - likelihood(2.0 * step)
            + likelihood(-2.0 * step))
            / (12.0 * step);
        // Rounding of a likelihood of some hundreds over the step: 1e-10.
        assert!(
            (found.gradient[k] - by_difference).abs() < 1e-7 * (1.0 + by_difference.abs()),
            "{k}: {} {by_difference}",
            found.gradient[k]
        );
    }
}

#[test]
fn the_information_on_the_noise_is_that_of_the_joint_gaussian() {
    let mut chain = Chain::measured(2);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let problem = Density { chain: &chain };
    let (_, covariance) = problem.outputs_given_parameters();
    let shares = problem.shares_of_the_noise();
    let cholesky = covariance.clone().cholesky().unwrap();
    // I = tr(S⁻¹ S_k S⁻¹ S_l) / 2 of normal data with covariance S.
    let whitened: Vec<DMatrix<f64>> = shares.iter().map(|share| cholesky.solve(share)).collect();
    let expected = |k: usize, l: usize| 0.5 * (&whitened[k] * &whitened[l]).trace();
    let draws = 400;
    let mut rng = ChaCha12Rng::seed_from_u64(1);
    let mut sums = [[[0.0; 2]; 3]; 3];
    let mut gradients = [[0.0; 2]; 3];
    for _ in 0..draws {
        let normals = DVector::from_fn(covariance.nrows(), |_, _| normal(&mut rng));
        chain.set_residuals(&trajectory, &(cholesky.l() * normals));
        let score = chain
            .linearised(&trajectory, &parameters, &[], &NoColumns)
            .noise_score(&[1.0; 4])
            .unwrap();
        for k in 0..3 {
            add(&mut gradients[k], score.gradient[k]);
            for l in 0..3 {
                let found = score.information[k * 4 + l];
                assert_eq!(found, score.information[l * 4 + k]);
                add(&mut sums[k][l], found);
            }
        }
    }
    for k in 0..3 {
        // The mean score vanishes, its variance is the information; 5 standard errors.
        let allowed = 5.0 * (expected(k, k) / f64::from(draws)).sqrt();
        let mean = gradients[k][0] / f64::from(draws);
        assert!(mean.abs() < allowed, "{k}: {mean} beyond {allowed}");
        for l in 0..3 {
            let mean = sums[k][l][0] / f64::from(draws);
            let variance = sums[k][l][1] / f64::from(draws) - mean * mean;
            // 5 standard errors, and rounding where the information does not depend on the data.
            let allowed = 5.0 * (variance.max(0.0) / f64::from(draws)).sqrt() + 1e-7;
            let off = mean - expected(k, l);
            assert!(off.abs() < allowed, "{k}, {l}: {off} beyond {allowed}");
            // The test tells a missing term: the expectation is known to a tenth.
            assert!(k != l || allowed < 0.1 * expected(k, k));
        }
    }
}

fn add(sums: &mut [f64; 2], value: f64) {
    sums[0] += value;
    sums[1] += value * value;
}

/// Box and Muller.
fn normal(rng: &mut ChaCha12Rng) -> f64 {
    let [a, b]: [f64; 2] = [rng.random(), rng.random()];
    (-2.0 * (1.0 - a).ln()).sqrt() * (core::f64::consts::TAU * b).cos()
}

#[test]
fn results_are_symmetric_to_the_last_bit() {
    let chain = Chain::measured(1);
    let trajectory = chain.trajectory();
    let reduced = chain
        .linearised(
            &trajectory,
            &chain.parameters(),
            &[0, 1, 2, 3],
            &Disturbances::default(),
        )
        .reduce(|_| ())
        .unwrap();
    let size = 1 + 4 + 3;
    assert_eq!(reduced.gram.shape(), (size, size));
    for i in 0..size {
        for j in 0..size {
            assert_eq!(reduced.gram[(i, j)], reduced.gram[(j, i)]);
        }
    }
    let [[_, upper], [lower, _]] = reduced.last_covariance;
    assert_eq!(upper, lower);
}

#[test]
fn the_gram_matrix_is_the_sum_over_what_is_watched() {
    let chain = Chain::measured(4);
    let trajectory = chain.trajectory();
    let mut seen = Vec::new();
    let reduced = chain
        .linearised(&trajectory, &chain.parameters(), &[0, 2], &NoColumns)
        .reduce(|whitened| {
            assert!(whitened.deviation >= VARIANCE[whitened.output].sqrt());
            seen.push((whitened.row, whitened.output, whitened.columns.to_vec()));
        })
        .unwrap();
    let order: Vec<_> = seen
        .iter()
        .map(|(row, output, _)| (*row, *output))
        .collect();
    assert_eq!(order, chain.present());
    assert_eq!(reduced.values, seen.len());
    for i in 0..3 {
        for j in 0..3 {
            let sum: f64 = seen.iter().map(|(_, _, row)| row[i] * row[j]).sum();
            let found = reduced.gram[(i, j)];
            // The order of summation is the same but for blocks.
            assert!((found - sum).abs() <= 1e-12 * found.abs().max(1.0));
        }
    }
}

#[test]
fn passes_on_a_tape_are_the_same() {
    let chain = Chain::measured(8);
    let trajectory = chain.trajectory();
    let (parameters, all) = (chain.parameters(), [0, 1, 2, 3]);
    let columns = Disturbances {
        sizes: [0.1, -0.2, 0.05],
    };
    let pass = chain.linearised(&trajectory, &parameters, &all, &columns);
    let (reduced, tape) = pass.reduce_and_keep(|_| ()).unwrap();
    let on_tape = Linearisation {
        tape: Some(&tape),
        ..pass
    };
    assert_eq!(pass.reduce(|_| ()).unwrap(), reduced);
    assert_eq!(on_tape.reduce(|_| ()).unwrap(), reduced);
    let change = [0.01, -0.02, 0.3, 0.02, 0.1, -0.1, 0.03];
    assert_eq!(
        on_tape.smooth(&change).unwrap(),
        pass.smooth(&change).unwrap()
    );
    let factors = [1.5, 0.5, 2.0, 1.0];
    assert_eq!(
        on_tape.noise_score(&factors).unwrap(),
        pass.noise_score(&factors).unwrap()
    );
    // One of another trajectory or of other parameters is refused.
    for other in [
        Linearisation {
            active: &all[1..],
            ..on_tape
        },
        Linearisation {
            points: &trajectory[1..],
            ..on_tape
        },
    ] {
        assert!(matches!(
            other.reduce(|_| ()),
            Err(EstimationError::InvalidArgument { .. })
        ));
    }
}

type Pass<'a, C = NoColumns> = Linearisation<'a, Pendulum, Chain, C, 2, 2>;

#[track_caller]
fn assert_refused<C: Columns<2, 2>>(pass: &Pass<'_, C>, expected: &str) {
    for error in [
        pass.reduce(|_| ()).err(),
        pass.smooth(&vec![0.0; pass.active.len()]).err(),
        pass.noise_score(&[1.0; 4]).err(),
    ] {
        assert!(
            error.is_some_and(|error| error.to_string().contains(expected)),
            "{error:?}"
        );
    }
}

#[test]
fn arguments_without_meaning_are_errors() {
    let mut chain = Chain::measured(0);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let all = [0, 1, 2, 3];
    let good = chain.linearised(&trajectory, &parameters, &all, &NoColumns);
    good.reduce(|_| ()).unwrap();
    let shape = "one point a row";
    assert_refused(
        &Pass {
            points: &trajectory[1..],
            ..good
        },
        shape,
    );
    assert_refused(
        &Pass {
            points: &[],
            ..good
        },
        shape,
    );
    assert_refused(
        &Pass {
            parameters: &parameters[1..],
            ..good
        },
        shape,
    );
    assert_refused(
        &Pass {
            active: &[4],
            ..good
        },
        shape,
    );
    assert!(good.smooth(&[0.0; 3]).is_err(), "a change for each column");
    assert!(
        good.noise_score(&[1.0; 3]).is_err(),
        "a factor for each noise"
    );

    let driven = "noise that drives every moving state";
    assert_refused(
        &Pass {
            noise_density: [0.0; 2],
            ..good
        },
        driven,
    );
    // In one part, noise of the torque moves angle and rate along one line only.
    assert_refused(
        &Pass {
            longest_step_s: f64::INFINITY,
            ..good
        },
        driven,
    );
    let flat = [[1.0, 1.0], [1.0, 1.0]];
    assert_refused(
        &Pass {
            prior_covariance: flat,
            ..good
        },
        driven,
    );
    assert_refused(
        &Pass {
            longest_step_s: 1e-9,
            ..good
        },
        "at most a million",
    );

    let mut lost = trajectory.clone();
    lost[6] = [f64::NAN; 2];
    let pass = Pass {
        points: &lost,
        ..good
    };
    assert!(matches!(
        pass.reduce(|_| ()),
        Err(EstimationError::NotFinite { .. } | EstimationError::InvalidArgument { .. })
    ));
    for time_s in [f64::NAN, chain.times_s[4], chain.times_s[3]] {
        let kept = chain.times_s[5];
        chain.times_s[5] = time_s;
        let pass = chain.linearised(&trajectory, &parameters, &all, &NoColumns);
        assert_refused(&pass, "times that rise");
        chain.times_s[5] = kept;
    }
    chain.variance = [1e-4, 0.0];
    let pass = chain.linearised(&trajectory, &parameters, &all, &NoColumns);
    assert_eq!(
        pass.reduce(|_| ()).err(),
        Some(EstimationError::InvalidNoise { output: 1 })
    );
}

#[test]
fn rules_of_integration_are_followed() {
    let chain = Chain::measured(6);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let rk4 = chain.linearised(&trajectory, &parameters, &[], &NoColumns);
    let cost = |pass: Pass<'_>| pass.reduce(|_| ()).unwrap().trajectory_cost;
    let outputs: f64 = chain.output_squares(&trajectory).iter().sum();
    // The trajectory is that of RK4: by Euler's rule noise must have done what is between them.
    assert!((cost(rk4) / outputs - 1.0).abs() < 1e-12);
    let euler = Pass {
        integration: Integration::EULER,
        ..rk4
    };
    assert!(cost(euler) > 1.01 * outputs);
}

//! Passes over a linearised record of a model that has nothing to do with gyros, against dense least squares
//! and direct Gaussian densities.
// Failing here is what tests are for.
#![cfg(test)]
#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

#[path = "record/chain.rs"]
mod chain;
#[path = "record/coloured.rs"]
mod coloured;
#[expect(dead_code, reason = "some constants are those of other tests")]
#[path = "../../estimation/tests/common/mod.rs"]
mod common;
#[path = "record/density.rs"]
mod density;
#[path = "record/invalid_arguments.rs"]
mod invalid_arguments;
#[path = "record/least_squares.rs"]
mod least_squares;
#[path = "record/noise.rs"]
mod noise;
#[path = "record/walks.rs"]
mod walks;

use chain::{Chain, VARIANCE, disturbances, none, solve};
use density::Density;
use gyrocal_estimation::{EstimationError, Integration};
use gyrocal_inference::{KeptRecord, Pass, PassError, Stop, Stopped};
use least_squares::LeastSquares;
use nalgebra::DMatrix;

/// Rounding, and a derivative by differences of fourth order, over some dozen rows; 1e-9 was seen.
const SAME_SIGMAS: f64 = 1e-7;

#[test]
fn gauss_newton_is_dense_least_squares() {
    for seed in 0..4 {
        let chain = Chain::measured(seed);
        let found = solve(&chain, |_| none(), &[]);
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
    let sigma = [0.3, 0.5, 0.2];
    let found = solve(&chain, disturbances, &sigma);
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
        .linearised(&trajectory, &chain.parameters(), &[], &none())
        .reduce()
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
        .linearised(&trajectory, &chain.parameters(), &[], &none())
        .noise_score(&[1.0; 4])
        .unwrap();
    let count = residuals.len() as f64;
    let expected = -0.5 * (square + log_determinant + count * core::f64::consts::TAU.ln());
    assert!((score.log_likelihood() - expected).abs() < 1e-6);
}

#[test]
fn the_cost_of_a_trajectory_counts_prior_noise_and_outputs() {
    let chain = Chain::measured(5);
    // On the prior mean and without noise only outputs cost.
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let cost = |points: &[[f64; 2]]| {
        chain
            .linearised(points, &parameters, &[], &none())
            .reduce()
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
fn results_are_symmetric_to_the_last_bit() {
    let chain = Chain::measured(1);
    let trajectory = chain.trajectory();
    let reduced = chain
        .linearised(
            &trajectory,
            &chain.parameters(),
            &[0, 1, 2, 3],
            &disturbances(&[0.0; 3]),
        )
        .reduce()
        .unwrap();
    let size = 1 + 4 + 3;
    assert_eq!(reduced.gram.shape(), (size, size));
    for i in 0..size {
        for j in 0..size {
            assert_eq!(reduced.gram[(i, j)], reduced.gram[(j, i)]);
        }
    }
    assert_eq!(reduced.last_covariance[1], reduced.last_covariance[2]);
}

#[test]
fn the_gram_matrix_is_the_sum_over_what_is_watched() {
    let chain = Chain::measured(4);
    let trajectory = chain.trajectory();
    let mut seen = Vec::new();
    let reduced = chain
        .linearised(&trajectory, &chain.parameters(), &[0, 2], &none())
        .pass()
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
fn passes_over_a_kept_record_are_the_same() {
    let chain = Chain::measured(8);
    let trajectory = chain.trajectory();
    let (parameters, all) = (chain.parameters(), [0, 1, 2, 3]);
    let columns = disturbances(&[0.1, -0.2, 0.05]);
    let case = chain.linearised(&trajectory, &parameters, &all, &columns);
    let kept = KeptRecord::new(&case.trajectory).unwrap();
    let on_kept = Pass {
        record: &kept,
        ..case.pass()
    };
    assert_eq!(
        on_kept.reduce_with_cost(|_| ()).unwrap(),
        case.reduce().unwrap()
    );
    let change = [0.01, -0.02, 0.3, 0.02, 0.1, -0.1, 0.03];
    assert_eq!(
        on_kept.smooth(&change).unwrap(),
        case.smooth(&change).unwrap()
    );
    let factors = [1.5, 0.5, 2.0, 1.0];
    assert_eq!(
        Pass {
            factors: &factors,
            ..on_kept
        }
        .noise_score()
        .unwrap(),
        case.noise_score(&factors).unwrap()
    );
    // The first rows and rows that are left out, as if the others had no values.
    let mut missing = Chain::measured(8);
    for row in (5..9).chain(20..30) {
        missing.measured[row] = [f64::NAN; 2];
    }
    let part = Pass {
        rows: 20,
        left_out: &(5..9),
        ..on_kept
    };
    let found = part.reduce(|_| ()).unwrap();
    let expected = missing
        .linearised(&trajectory, &parameters, &all, &columns)
        .reduce()
        .unwrap();
    assert_eq!(found.gram, expected.gram);
    // A parameter that it was not linearised by is refused.
    let some = chain_without_first(&missing, &trajectory, &parameters, &columns);
    assert!(matches!(
        some,
        Err(PassError::Estimation(
            EstimationError::InvalidArgument { .. }
        ))
    ));
}

/// A pass with a column of a parameter that the record has no derivatives by.
fn chain_without_first(
    chain: &Chain,
    trajectory: &[[f64; 2]],
    parameters: &[f64],
    columns: &gyrocal_inference::ExtraColumns,
) -> Result<gyrocal_inference::Reduced, PassError> {
    let mut case = chain.linearised(trajectory, parameters, &[0, 1, 2, 3], columns);
    case.trajectory.wanted = &[1, 2, 3];
    case.reduce()
}

#[test]
fn passes_of_a_stopped_job_fail_as_such() {
    let chain = Chain::measured(6);
    let (trajectory, parameters, no_columns) = (chain.trajectory(), chain.parameters(), none());
    let case = chain.linearised(&trajectory, &parameters, &[0, 1, 2, 3], &no_columns);
    let kept = KeptRecord::new(&case.trajectory).unwrap();
    let pass = case.pass();
    let on_kept = pass.on(Some(&kept));
    let change = vec![0.0; case.columns.len()];
    let errors = || {
        [
            pass.reduce(|_| ()).err(),
            on_kept.reduce(|_| ()).err(),
            on_kept.smooth(&change).err(),
            on_kept.noise_score().err(),
            on_kept.jumps(|_, _| ()).err(),
            KeptRecord::new(&case.trajectory).err(),
            case.trajectory.free_run().err(),
        ]
    };
    let stop = Stop::default();
    assert!(stop.over(errors).iter().all(Option::is_none));
    stop.ask();
    let stopped = Some(PassError::Stopped(Stopped));
    assert!(stop.over(errors).iter().all(|error| *error == stopped));
    // The thread goes on with other jobs.
    assert!(errors().iter().all(Option::is_none));
}

#[test]
fn rules_of_integration_are_followed() {
    let chain = Chain::measured(6);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let no_columns = none();
    let rk4 = chain.linearised(&trajectory, &parameters, &[], &no_columns);
    let cost = |case: &chain::Case<'_>| case.reduce().unwrap().trajectory_cost;
    let outputs: f64 = chain.output_squares(&trajectory).iter().sum();
    // The trajectory is that of RK4: by Euler's rule noise must have done what is between them.
    assert!((cost(&rk4) / outputs - 1.0).abs() < 1e-12);
    let mut euler = rk4.clone();
    euler.trajectory.integration = Integration::EULER;
    assert!(cost(&euler) > 1.01 * outputs);
}

//! Invalid arguments are errors.

use gyrocal_estimation::EstimationError;
use gyrocal_inference::PassError;

use crate::chain::{Case, Chain, none};

#[track_caller]
fn assert_refused(case: &Case<'_>, expected: &str) {
    let change = vec![0.0; case.columns.len()];
    for error in [
        case.reduce().err(),
        case.smooth(&change).err(),
        case.noise_score(&[1.0; 4]).err(),
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
    let no_columns = none();
    let good = chain.linearised(&trajectory, &parameters, &all, &no_columns);
    good.reduce().unwrap();
    let changed = |change: &dyn Fn(&mut Case<'_>)| {
        let mut case = chain.linearised(&trajectory, &parameters, &all, &no_columns);
        change(&mut case);
        case.reduce().err()
    };
    let shape = "one point a row";
    for points in [&[][..], &trajectory[1..]] {
        let mut few = good.clone();
        few.trajectory.points = points;
        assert_refused(&few, shape);
    }
    let mut few = good.clone();
    few.trajectory.parameters = &parameters[1..];
    assert_refused(&few, shape);
    for wanted in [&[0, 1, 2, 4][..], &[0, 2, 1, 3]] {
        let mut other = good.clone();
        other.trajectory.wanted = wanted;
        assert_refused(&other, shape);
    }
    let mut other = good.clone();
    other.trajectory.wanted = &all[1..];
    assert_refused(&other, "columns of parameters, states and outputs");
    assert!(good.smooth(&[0.0; 3]).is_err(), "a change for each column");
    assert!(
        good.noise_score(&[1.0; 3]).is_err(),
        "a factor for each noise"
    );

    // The cost of a trajectory needs noise that drives every state.
    let driven = "noise that drives every moving state";
    let refused = |error: Option<PassError>, expected: &str| {
        let error = error.map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains(expected), "{error}");
    };
    refused(
        changed(&|case| case.trajectory.noise_density = [0.0; 2]),
        driven,
    );
    // In one part, noise of the torque moves angle and rate along one line only.
    refused(
        changed(&|case| case.trajectory.longest_step_s = f64::INFINITY),
        driven,
    );
    let flat = [[1.0, 1.0], [1.0, 1.0]];
    let mut other = good.clone();
    other.trajectory.prior_covariance = flat;
    assert_refused(&other, "a positive definite prior");
    let mut other = good.clone();
    other.trajectory.longest_step_s = 1e-9;
    assert_refused(&other, "at most a million");

    let mut lost = trajectory.clone();
    lost[6] = [f64::NAN; 2];
    let pass = chain.linearised(&lost, &parameters, &all, &no_columns);
    assert!(matches!(
        pass.reduce(),
        Err(PassError::Estimation(
            EstimationError::NotFinite { .. } | EstimationError::InvalidArgument { .. }
        ))
    ));
    for time_s in [f64::NAN, chain.times_s[4], chain.times_s[3]] {
        let kept = chain.times_s[5];
        chain.times_s[5] = time_s;
        let pass = chain.linearised(&trajectory, &parameters, &all, &no_columns);
        assert_refused(&pass, "times that rise");
        chain.times_s[5] = kept;
    }
    chain.variance = [1e-4, 0.0];
    let pass = chain.linearised(&trajectory, &parameters, &all, &no_columns);
    assert_eq!(
        pass.reduce().err(),
        Some(EstimationError::InvalidNoise { output: 1 }.into())
    );
}

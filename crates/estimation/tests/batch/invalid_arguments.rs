//! Invalid arguments are errors.

use gyrocal_estimation::EstimationError;
use gyrocal_estimation::batch::{Columns, Linearisation, NoColumns};

use crate::chain::Chain;
use crate::common::Pendulum;

pub(crate) type Pass<'a, C = NoColumns> = Linearisation<'a, Pendulum, Chain, C, 2, 2>;

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
#[expect(clippy::too_many_lines, reason = "a table of cases")]
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

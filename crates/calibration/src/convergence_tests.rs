//! Convergence from poor initial guesses, and failures of the iteration.

use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::{Anchored, Discretisation, FilterSettings, Surveyed};
use gyrocal_record::{Bench, Record};
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};

use crate::attitude::attitude_hypotheses;
use crate::calibrate::calibrate_runs;
use crate::error::CalibrationError;
use crate::initial_trajectory::InitialTrajectory;
use crate::options::Options;
use crate::problem::Problem;
use crate::run::Run;
use crate::settings::filter_settings;
use crate::single_run::single_run_problem;

fn day(seed: u64) -> (Record, Bench) {
    let simulation = simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::AnglesDeg([12.0, -25.0, 40.0]),
        interval_s: 120.0,
        duration_s: 86_400.0,
        ..Scenario::default()
    })
    .unwrap();
    (simulation.record, simulation.bench)
}

fn settings(bench: &Bench) -> FilterSettings<f64> {
    filter_settings(bench, Discretisation::default())
}

/// A problem at given drift coefficients and the noise-free trajectory that belongs to them.
fn problem_at<'a>(
    run: &Run<'a>,
    settings: &FilterSettings<f64>,
    drift: [f64; 9],
) -> Problem<'a, Anchored<Surveyed>, SurveyedInputs<f64>> {
    let prior = attitude_hypotheses(run.record, run.bench).unwrap()[0].prior;
    let rows = run.record.len();
    let start = InitialTrajectory {
        points: vec![prior.orientation; rows],
        drift,
        sigma: [1.0; 9],
        nis_mean: 0.0,
        by_windows: false,
    };
    let options = Options::default();
    let mut problem = single_run_problem(run, rows, settings, &prior, &start, &options);
    let parameters = problem.parameters(0);
    let points = problem.free_run(0, &parameters);
    problem.runs[0].points = points.unwrap();
    problem
}

#[test]
fn a_poor_initial_guess_converges_to_the_same_solution() {
    let (record, bench) = day(1);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let solved = |offset: f64| {
        // Drifts that turn the platform by `offset` times a day more than they do.
        let mut drift = [0.0; 9];
        (drift[0], drift[1]) = (offset, offset);
        let mut problem = problem_at(&run, &settings(&bench), drift);
        let solution = problem.solve(50).unwrap();
        (problem.values, solution)
    };
    let (near, least) = solved(0.1);
    // Five degrees an hour are 120 degrees in a day.
    let (far, cost) = solved(5.0);
    // Both ended within a ten thousandth of a sigma; the largest sigma here is 0.05 deg/h.
    for (near, far) in near.iter().zip(&far) {
        assert!((near - far).abs() < 1e-4 * 0.05, "{near} {far}");
    }
    assert!((least.cost - cost.cost).abs() < 1e-6 * least.cost);
    // Squares of one sigma each: they spread by the root of twice their number.
    let values = least.values as f64;
    assert!((least.cost - values).abs() < 5.0 * (2.0 * values).sqrt());
}

#[test]
fn a_guess_too_far_from_the_solution_is_an_error_with_advice() {
    let (record, bench) = day(1);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    // Twenty degrees an hour: more than a turn in a day, from which the iteration does not converge.
    let mut drift = [0.0; 9];
    (drift[0], drift[1]) = (20.0, 20.0);
    let mut problem = problem_at(&run, &settings(&bench), drift);
    let failure = problem.solve(50).err().unwrap();
    let message = failure.to_string();
    assert!(
        message.contains("no shorter step") || message.contains("did not converge"),
        "{message}"
    );
    assert!(
        message.contains("check latitude, initial angles"),
        "{message}"
    );
}

#[test]
fn an_iteration_that_does_not_converge_is_an_error() {
    let (record, bench) = day(2);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let mut problem = problem_at(&run, &settings(&bench), [0.2; 9]);
    let failure = problem.solve(1).err().unwrap();
    assert!(
        matches!(failure, CalibrationError::NotConverged { iterations: 1, last_step } if last_step > 1.0),
        "{failure:?}"
    );
    let message = failure.to_string();
    assert!(message.contains("did not converge in 1 steps"), "{message}");
}

#[test]
fn the_error_of_several_records_names_the_record() {
    let (record, bench) = day(3);
    let short = Record {
        time_s: record.time_s[..5].to_vec(),
        accel_g: record.accel_g[..5].to_vec(),
        ..record.clone()
    };
    let of = |record| Run {
        record,
        bench: &bench,
    };
    let error = calibrate_runs(&[of(&record), of(&short)], &Options::default(), |_| ());
    let error = error.unwrap_err();
    assert!(
        matches!(&error, CalibrationError::OfSeveral { run: 2, runs: 2, source }
            if matches!(**source, CalibrationError::TooShort { found: 5, .. })),
        "{error}"
    );
}

/// Halvings cost as much as steps, and count.
#[test]
fn halvings_count_as_passes() {
    let (record, bench) = day(1);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    // From so far that steps have to be halved after the first ones.
    let mut drift = [0.0; 9];
    (drift[0], drift[1]) = (20.0, 20.0);
    let passes = 20;
    let mut problem = problem_at(&run, &settings(&bench), drift);
    let failure = problem.solve(passes).err().unwrap();
    assert!(
        matches!(failure, CalibrationError::NotConverged { iterations, .. } if iterations < passes),
        "{failure:?}"
    );
}

//! Tests of far starts, and of how the solver gives up.
#![allow(clippy::unwrap_used)]

use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::{Anchored, Recentring, Settings, Surveyed};
use gyrocal_record::{Bench, Record};
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};

use super::Failure;
use crate::attitude::trials;
use crate::begin::alone;
use crate::calibrate::Options;
use crate::calibrate_runs;
use crate::error::CalibrationError;
use crate::problem::Problem;
use crate::run::Run;
use crate::settings::level;
use crate::start::Start;

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

fn settings(bench: &Bench) -> Settings<f64> {
    Settings {
        recentring: Recentring::EveryStep,
        ..level(bench)
    }
}

/// A problem that begins at a drift, on the trajectory that goes with it.
fn beginning<'a>(
    run: &Run<'a>,
    settings: &Settings<f64>,
    drift: [f64; 9],
) -> Problem<'a, Anchored<Surveyed>, SurveyedInputs<f64>> {
    let prior = trials(run.record, run.bench).unwrap()[0].prior;
    let rows = run.record.len();
    let start = Start {
        points: vec![prior.orientation; rows],
        drift,
        sigma: [1.0; 9],
        nis_mean: 0.0,
    };
    let options = Options::default();
    let mut problem = alone(run, rows, settings, &prior, &start, &options);
    let parameters = problem.parameters(0);
    let points = problem.with_leg(0, &parameters, |pass| pass.free_run());
    problem.legs[0].points = points.unwrap();
    problem
}

#[test]
fn a_start_far_away_leads_to_the_same_solution() {
    let (record, bench) = day(1);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let solved = |offset: f64| {
        // Drifts that turn the platform by `offset` times a day more than they do.
        let mut drift = [0.0; 9];
        (drift[0], drift[1]) = (offset, offset);
        let mut problem = beginning(&run, &settings(&bench), drift);
        let solution = problem.solve(50, |_| ()).unwrap();
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
fn what_no_step_mends_is_told() {
    let (record, bench) = day(1);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    // Twenty degrees an hour: more than a turn in a day, beyond what steps find back from.
    let mut drift = [0.0; 9];
    (drift[0], drift[1]) = (20.0, 20.0);
    let mut problem = beginning(&run, &settings(&bench), drift);
    let failure = problem.solve(50, |_| ()).err().unwrap();
    let said = CalibrationError::from(failure).to_string();
    assert!(
        said.contains("no shorter step") || said.contains("did not converge"),
        "{said}"
    );
    assert!(said.contains("check latitude, initial angles"), "{said}");
}

#[test]
fn steps_that_do_not_end_are_given_up() {
    let (record, bench) = day(2);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let mut problem = beginning(&run, &settings(&bench), [0.2; 9]);
    let failure = problem.solve(1, |_| ()).err().unwrap();
    assert!(
        matches!(failure, Failure::NotConverged { iterations: 1, last_step } if last_step > 1.0),
        "{failure:?}"
    );
    let said = CalibrationError::from(failure).to_string();
    assert!(said.contains("did not converge in 1 steps"), "{said}");
}

#[test]
fn the_record_that_cannot_be_taken_is_named() {
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

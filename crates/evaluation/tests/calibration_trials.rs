//! Trials of the calibration and their summary.

// Failing here is what tests are for.
#![cfg(test)]

use gyrocal_calibration::Options;
use gyrocal_evaluation::{
    CalibrationSummary, CalibrationTrial, Campaign, EvaluationError, Fingerprint,
};
use gyrocal_truth::{Coefficients, Scenario};

fn scenario() -> Scenario {
    Scenario {
        seed: 5,
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: 86_400.0,
        ..Scenario::default()
    }
}

#[test]
fn a_trial_holds_a_calibration_against_its_truth() {
    let trial = CalibrationTrial::of(&scenario(), &Options::default()).unwrap();
    assert_eq!(
        trial.truth,
        [0.5, -0.2, -0.1, -0.5, 0.2, 0.1, 0.5, 0.2, -0.1]
    );
    assert_eq!((trial.rows, trial.values), (1441, 3 * 1441));
    assert!(trial.consistent);
    // A day determines most coefficients; an error of 5 sigmas has a probability of 6e-7.
    assert!(trial.determined.iter().filter(|yes| **yes).count() >= 5);
    for (error, sigma) in trial.error.iter().zip(trial.sigma) {
        assert!(*error != 0.0 && error.abs() < 5.0 * sigma, "{trial:?}");
    }
    // The part cannot exceed the whole.
    assert!(trial.nees_determined > 0.0 && trial.nees_determined <= trial.nees);
}

#[test]
fn a_trial_fails_with_the_reason() {
    let short = Scenario {
        duration_s: 300.0,
        ..scenario()
    };
    let error = CalibrationTrial::of(&short, &Options::default()).unwrap_err();
    assert!(matches!(error, EvaluationError::Calibration(_)), "{error}");
    let nowhere = Scenario {
        latitude_deg: 100.0,
        ..scenario()
    };
    let error = CalibrationTrial::of(&nowhere, &Options::default()).unwrap_err();
    assert!(matches!(error, EvaluationError::Simulation(_)), "{error}");
}

/// Four trials of known errors; the first coefficient is never determined, the second twice.
fn made(seed: u64) -> Result<CalibrationTrial, EvaluationError> {
    if seed == 4 {
        return Err(EvaluationError::NotPositiveDefinite);
    }
    let odd = seed % 2 == 1;
    let mut trial = CalibrationTrial {
        truth: [0.0; 9],
        // 2, -2, 6, -2 sigmas of 0.5.
        error: [[1.0, -1.0, 3.0, -1.0][seed as usize]; 9],
        sigma: [0.5; 9],
        determined: [true; 9],
        bound_sigma: Some([0.4; 9]),
        nees: 10.0 + seed as f64,
        nees_determined: 7.0 + seed as f64,
        nis_sum: 290.0,
        values: 300,
        rows: 100,
        consistent: seed != 2,
    };
    (trial.determined[0], trial.determined[1]) = (false, odd);
    if seed == 3 {
        trial.bound_sigma = None;
    }
    Ok(trial)
}

fn summary(seeds: std::ops::Range<u64>) -> CalibrationSummary {
    let campaign = Campaign::new(seeds, Fingerprint::new("made"));
    CalibrationSummary::of(&campaign.run(made, |_| ()).unwrap())
}

/// Sums of a few numbers.
#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-14, "{found}, not {expected}");
}

#[test]
fn a_summary_is_what_its_definitions_say() {
    let summary = summary(0..5);
    assert_eq!((summary.runs, summary.failures.len()), (4, 1));
    assert_eq!(summary.failures[0].seed, 4);
    assert!(
        summary.failures[0]
            .message
            .contains("not positive definite")
    );

    let nees = summary.nees.unwrap();
    assert_near(nees.mean, 11.5);
    assert_eq!((nees.expected, nees.median), (9.0, 11.5));
    assert!(nees.holds());
    // Seven determined coefficients, in two runs one more.
    assert_eq!(summary.nees_determined.unwrap().expected, 7.5);
    let nis = summary.nis.unwrap();
    assert_near(nis.mean, 2.9);
    assert_eq!(nis.expected, 3.0);
    // Half the width of the band is near 3.29 sqrt(2 * 1200) / 400.
    assert!((nis.band[1] - nis.band[0] - 0.806).abs() < 0.01, "{nis:?}");
    assert_eq!(summary.consistent.unwrap().value, 0.75);

    let never = &summary.coefficients[0];
    assert_eq!((&never.name[..], &never.unit[..]), ("gyro_x.bias", "deg/h"));
    assert_eq!((never.determined, never.bias, never.rmse), (0, None, None));
    assert!(never.coverage.is_none() && never.rmse_over_sigma.is_none());

    let twice = &summary.coefficients[1];
    assert_eq!((twice.determined, twice.bias), (2, Some(-1.0)));
    assert_eq!(twice.bias_standard_error, Some(0.0));

    let always = &summary.coefficients[8];
    assert_eq!(always.name, "gyro_z.g_zz");
    assert_near(always.bias.unwrap(), 0.5);
    // Squares about the mean: 0.25, 2.25, 6.25, 2.25.
    assert_near(
        always.bias_standard_error.unwrap(),
        (11.0_f64 / 12.0).sqrt(),
    );
    assert_near(always.rmse.unwrap(), 3.0_f64.sqrt());
    assert_near(always.rmse_over_sigma.unwrap().value, 12.0_f64.sqrt());
    // 2 sigmas are outside 1.96.
    assert_eq!(always.coverage.unwrap().value, 0.0);
    assert_eq!(always.rmse_over_bound, None, "seed 3 has no bound");
}

#[test]
fn errors_are_held_against_the_bound_of_their_own_run() {
    let ratio = summary(0..3).coefficients[8].rmse_over_bound.unwrap();
    // 2.5, -2.5 and 7.5 bounds.
    assert_near(ratio.value, 2.5 * (11.0_f64 / 3.0).sqrt());
    assert!(ratio.interval[0] < ratio.value && ratio.value < ratio.interval[1]);
}

#[test]
fn a_summary_of_failures_is_empty_and_no_number() {
    let summary = summary(4..5);
    assert_eq!((summary.runs, summary.failures.len()), (0, 1));
    assert!(summary.nees.is_none() && summary.nis.is_none());
    assert!(summary.nees_determined.is_none() && summary.consistent.is_none());
    assert!(summary.coefficients.iter().all(|one| one.determined == 0));
}

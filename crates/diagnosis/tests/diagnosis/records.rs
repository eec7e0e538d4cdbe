//! Several records of one platform, diagnosed together.

use gyrocal_answer::{Answer, SizeChoice, Verdict};
use gyrocal_calibration::Run;
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, Gate, RecordToDiagnose, RecordsDiagnosis, diagnose,
    diagnose_records,
};
use gyrocal_setup::PlatformKind;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

/// A day at an attitude, with effects hidden.
fn simulation(seed: u64, angles_deg: [f64; 3], hidden: &[(&str, &[(&str, f64)])]) -> Simulation {
    let hidden = hidden.iter();
    simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::AnglesDeg(angles_deg),
        duration_s: 86_400.0,
        interval_s: 180.0,
        hidden: hidden
            .map(|(effect, parameters)| Hidden::new(effect, parameters).unwrap())
            .collect(),
        ..Scenario::default()
    })
    .unwrap()
}

fn together(simulations: &[Simulation]) -> Result<RecordsDiagnosis, DiagnosisError> {
    let options = DiagnoseOptions::default();
    let records = simulations.iter().enumerate().map(|(index, one)| {
        let run = Run {
            record: &one.record,
            bench: &one.bench,
        };
        RecordToDiagnose {
            name: format!("record {}", index + 1),
            gate: Gate::new(PlatformKind::Stabilised, &run, &options.calibration),
            bench: &one.bench,
        }
    });
    diagnose_records(records.collect(), &options, |_| ())
}

#[test]
fn a_term_of_two_records_has_one_size_and_a_smaller_error() {
    let hidden: &[(&str, &[(&str, f64)])] = &[("gyro_y.g_z", &[("size", 0.01)])];
    let simulations = [
        simulation(1, [5.0, 10.0, 20.0], hidden),
        simulation(2, [60.0, -30.0, 120.0], hidden),
    ];
    let found = together(&simulations).unwrap();
    let result = &found.together.result;
    assert_eq!(result.verdict, Verdict::EffectsFound);
    let names: Vec<&str> = result.causes().map(|cause| cause.effect.as_str()).collect();
    assert_eq!(names, ["gyro_y.g_z"]);
    let cause = &result.findings[0];
    let size = &cause.parameters[0];
    let sigma = size.sigma.unwrap();
    // One in sixteen thousand is farther off than four sigmas.
    assert!((size.estimate - 0.01).abs() < 4.0 * sigma, "{size:?}");
    let by_record = cause.by_record.as_ref().unwrap();
    assert_eq!(by_record.choice, SizeChoice::Shared);
    assert_eq!(by_record.sizes.len(), 2);
    for one in &by_record.sizes {
        let own = one.estimates[0];
        assert!((own.estimate - 0.01).abs() < 4.0 * own.sigma, "{own:?}");
        assert!(own.sigma > sigma);
    }
    // A block for each record.
    let gain = result.gain.as_ref().unwrap();
    assert_eq!(gain.block_log_score_nats.len(), 2);
    assert!(gain.cross_validated_log_score_nats > 8.0, "{gain:?}");
    assert_eq!(result.records.len(), 2);
    let rows: usize = simulations.iter().map(|one| one.record.len()).sum();
    assert_eq!(result.record.rows, rows);
    assert_eq!(result.record.gaps.count, 0);
    // Coefficients of both together are better known than those of any alone.
    let sigmas = |diagnosis: &gyrocal_diagnosis::Diagnosis<'_>| {
        let fit = diagnosis.extended.as_ref().unwrap_or(&diagnosis.nominal);
        (0..9).map(|i| fit.covariance()[(i, i)]).sum::<f64>()
    };
    for alone in &found.alone {
        assert!(sigmas(&found.together) < sigmas(alone));
    }
    let text = serde_json::to_string(result).unwrap();
    let read: Answer = serde_json::from_str(&text).unwrap();
    assert_eq!(read, *result);
}

#[test]
fn an_effect_of_one_record_is_found_on_the_clock_of_that_record() {
    let simulations = [
        simulation(3, [5.0, 10.0, 20.0], &[]),
        simulation(
            4,
            [60.0, -30.0, 120.0],
            &[("gyro_x.step", &[("size", 0.02), ("onset_s", 50_000.0)])],
        ),
    ];
    let found = together(&simulations).unwrap();
    let result = &found.together.result;
    let names: Vec<&str> = result.causes().map(|cause| cause.effect.as_str()).collect();
    assert_eq!(names, ["gyro_x.step"]);
    let cause = &result.findings[0];
    assert!(cause.by_record.is_none());
    let onset_s = cause.parameter("onset_s").unwrap().estimate;
    // The second record begins ten intervals after the first; onsets are good to five per cent.
    let expected_s = 86_400.0 + 1800.0 + 50_000.0;
    assert!((onset_s - expected_s).abs() < 4_320.0, "{onset_s}");
}

#[test]
fn clean_records_are_clean_together() {
    let simulations = [
        simulation(5, [5.0, 10.0, 20.0], &[]),
        simulation(6, [60.0, -30.0, 120.0], &[]),
        simulation(7, [-20.0, 50.0, -70.0], &[]),
    ];
    let found = together(&simulations).unwrap();
    assert_eq!(found.together.result.verdict, Verdict::Clean);
    // One record alone is told as before.
    let one = &simulations[0];
    let alone = diagnose(&one.record, &one.bench, &DiagnoseOptions::default()).unwrap();
    assert_eq!(found.alone[0].result, alone.result);
}

/// A day at an attitude of a platform whose gyro z drifts otherwise by so much per g, with a latitude of the bench file
/// that is wrong by so much.
fn of_platform(
    seed: u64,
    angles_deg: [f64; 3],
    by_deg_per_h: f64,
    latitude_by_deg: f64,
) -> Simulation {
    let mut coefficients = Coefficients::PAPER_LIKE;
    coefficients.g_deg_per_h_per_g[2] += by_deg_per_h;
    let mut simulation = simulate(&Scenario {
        seed,
        coefficients,
        initial: InitialAttitude::AnglesDeg(angles_deg),
        duration_s: 86_400.0,
        interval_s: 180.0,
        ..Scenario::default()
    })
    .unwrap();
    simulation.bench.latitude_deg += latitude_by_deg;
    simulation
}

#[test]
fn records_of_two_platforms_are_refused() {
    for by_deg_per_h in [0.01, -0.4] {
        let simulations = [
            of_platform(8, [5.0, 10.0, 20.0], 0.0, 0.0),
            of_platform(9, [60.0, -30.0, 120.0], by_deg_per_h, 0.0),
        ];
        let error = together(&simulations).err();
        let error = error.unwrap_or_else(|| panic!("two platforms, {by_deg_per_h}"));
        let DiagnosisError::SeveralPlatforms { name, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(name, "record 2");
    }
}

/// A latitude moves the coefficients of each record alone by hundreds of standard deviations.
#[test]
fn an_error_that_records_share_makes_no_two_platforms_of_one() {
    let simulations = [
        of_platform(8, [5.0, 10.0, 20.0], 0.0, 1.0),
        of_platform(9, [60.0, -30.0, 120.0], 0.0, 1.0),
    ];
    let found = together(&simulations).unwrap();
    let causes: Vec<&str> = found
        .together
        .result
        .causes()
        .map(|one| one.effect.as_str())
        .collect();
    assert_eq!(causes, ["site.latitude"]);
}

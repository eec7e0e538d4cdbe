//! Effects of an extended model, and its gain on a later record.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{FittedPlatform, NoiseModel, Run};
use gyrocal_diagnosis::{
    DiagnoseOptions, Diagnosis, DiagnosisError, Gate, LaterPrediction, RecordToDiagnose, Stage,
    diagnose, diagnose_records, diagnose_watched, fit_effects, predict_later,
};
use gyrocal_hypothesis::{ModelExtension, Stop};
use gyrocal_setup::PlatformKind;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

/// A day or more at a random attitude.
fn simulation(seed: u64, days: f64, hidden: &[Hidden]) -> Simulation {
    simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: days * 86_400.0,
        hidden: hidden.to_vec(),
        ..Scenario::default()
    })
    .unwrap()
}

#[test]
fn a_step_in_the_last_block_is_judged_too() {
    // The other five sixths have no information on it.
    let parameters = [("size", 0.02), ("onset_s", 1.85 * 86_400.0)];
    let hidden = [Hidden::new("gyro_x.step", &parameters).unwrap()];
    let simulation = simulation(11, 2.0, &hidden);
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap();
    let causes: Vec<_> = found.result.causes().collect();
    assert!(!causes.is_empty());
    for cause in &causes {
        let gain_nats = cause.gain_nats.unwrap();
        assert!(gain_nats.is_finite(), "{cause:?}");
        assert_eq!(cause.accepted, Some(gain_nats > 0.0));
    }
    let any = causes.iter().any(|cause| cause.accepted == Some(true));
    assert_eq!(found.extended.is_some(), any);
    assert_eq!(found.result.coefficients.unwrap().extended.is_some(), any);
}

#[test]
fn a_later_record_is_predicted_better_by_what_was_found_in_the_first() {
    let hidden = [Hidden::new("gyro_y.g_z", &[("size", 0.02)]).unwrap()];
    let (first, later) = (simulation(7, 2.0, &hidden), simulation(8, 2.0, &hidden));
    let options = DiagnoseOptions::default();
    let found = diagnose(&first.record, &first.bench, &options).unwrap();
    assert_eq!(found.result.findings[0].effect, "gyro_y.g_z");
    let validation = predicted(&found, &first, &later);
    // The effect is some hundred sigmas.
    assert!(
        validation.gain_nats() > 1000.0,
        "{:?}",
        validation.log_score_nats
    );
    let left = &validation.attitude;
    let [nominal, extended, expected] = left.at_end_arcmin();
    assert!(extended < 0.2 * nominal, "{left:?}");
    // Root mean square of three axes over starts that share one error of the coefficients: three
    // times of it are one in thousands.
    assert!(extended < 3.0 * expected, "{left:?}");
    assert_eq!(left.nominal_arcmin[0], 0.0);
    assert_eq!(
        (left.time_s[0], *left.time_s.last().unwrap()),
        (0.0, 86_400.0)
    );
}

/// The later record, predicted with the findings of the first.
fn predicted(found: &Diagnosis<'_>, first: &Simulation, later: &Simulation) -> LaterPrediction {
    let [first, later] = [first, later].map(|simulation| Run {
        record: &simulation.record,
        bench: &simulation.bench,
    });
    let models = [&found.nominal, found.extended.as_ref().unwrap()];
    let options = DiagnoseOptions::default();
    predict_later(models, &found.noise_model, &first, (&later, None), &options).unwrap()
}

/// Effect of temperature and hysteresis on accelerometer y, g/K: some ten sigmas of its noise in a row.
const OF_TEMPERATURE: f64 = 1e-4;

/// Two days with a temperature of this mean and this daily wave. It acts about `about_c`, and with a play to either
/// side.
#[test]
fn a_diagnosis_that_is_stopped_at_any_stage_has_no_answer() {
    let hidden = [Hidden::new("gyro_y.g_z", &[("size", 0.01)]).unwrap()];
    let simulation = simulation(5, 1.0, &hidden);
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let options = DiagnoseOptions::default();
    let gate = || Gate::new(PlatformKind::Stabilised, &run, &options.calibration);
    let is_stopped = |error: Option<DiagnosisError>| {
        assert!(
            matches!(error, Some(DiagnosisError::Stopped(_))),
            "{error:?}"
        );
    };
    for at in [
        Stage::Audit,
        Stage::Search,
        Stage::Validation,
        Stage::Answer,
    ] {
        let stop = Stop::default();
        let watch = |stage| {
            if stage == at {
                stop.ask();
            }
        };
        let found = stop.over(|| diagnose_watched(gate(), run.bench, &options, watch));
        is_stopped(found.err());
        // Together and alone.
        let stop = Stop::default();
        let watch = |stage| {
            if stage == at {
                stop.ask();
            }
        };
        let record = |name: &str| RecordToDiagnose {
            name: name.to_owned(),
            gate: gate(),
            bench: run.bench,
        };
        let records = vec![record("one"), record("other")];
        let found = stop.over(|| diagnose_records(records, &options, watch));
        is_stopped(found.err());
    }
    let mut found = diagnose(run.record, run.bench, &options).unwrap();
    let stop = Stop::default();
    stop.ask();
    stop.over(|| {
        is_stopped(diagnose(run.record, run.bench, &options).err());
        is_stopped(found.validate(&run, &options).err());
        is_stopped(fit_effects(&run, None, &[], &options).err());
    });
}

fn warm(seed: u64, [mean_c, wave_k]: [f64; 2], about_c: f64, half_play_k: f64) -> Simulation {
    let mut made = simulation(seed, 2.0, &[]);
    let turns = made.record.time_s.iter().map(|time_s| time_s / 86_400.0);
    let course: Vec<f64> = turns
        .map(|turn| mean_c + wave_k * (core::f64::consts::TAU * turn).sin())
        .collect();
    let mut follows_c = course[0];
    for (force_g, value_c) in made.record.accel_g.iter_mut().zip(&course) {
        follows_c = follows_c.clamp(value_c - half_play_k, value_c + half_play_k);
        force_g[1] += OF_TEMPERATURE * ((value_c - about_c) + (value_c - follows_c));
    }
    made.record.temperature_c = Some(course);
    made
}

/// The play of a hysteresis and the zero of a temperature are those of the platform: a later record has what the
/// first tells, whatever its own temperatures are.
#[test]
fn a_warmer_later_record_has_the_play_and_the_mean_of_the_first() {
    let options = DiagnoseOptions::default();
    // A range of 6 K: a play of an eighth of it to either side.
    let first = warm(31, [20.0, 3.0], 20.0, 0.75);
    let run = Run {
        record: &first.record,
        bench: &first.bench,
    };
    let noise = NoiseModel::default();
    let nominal = FittedPlatform::nominal(&run, &options.calibration, &noise).unwrap();
    let hidden = ["accel_y.temperature", "accel_y.temperature_hysteresis"];
    let place = |id: &str| PARAMETERS.iter().position(|one| one.id == id).unwrap();
    let mut extension: ModelExtension = nominal.extension().clone();
    extension
        .parameters
        .extend(hidden.map(|id| (place(id), f64::INFINITY)));
    let extended = nominal.refitted(&extension).unwrap();
    let score_nats = |about_c: f64, half_play_k: f64| {
        let later = warm(32, [25.0, 1.0], about_c, half_play_k);
        let later = Run {
            record: &later.record,
            bench: &later.bench,
        };
        let models = [&nominal, &extended];
        let found = predict_later(models, &noise, &run, (&later, None), &options).unwrap();
        found.log_score_nats[1]
    };
    let of_platform = score_nats(20.0, 0.75);
    // About its own mean, and with an eighth of its own range. Each differs by hundreds of sigmas.
    for [about_c, half_play_k] in [[25.0, 0.75], [20.0, 0.25]] {
        let other = score_nats(about_c, half_play_k);
        assert!(of_platform > other + 1000.0, "{of_platform} {other}");
    }
}

/// A record of hours does not determine its own attitude: no model can be compared with it.
#[test]
fn a_short_later_record_lets_one_expect_little() {
    let hidden = [Hidden::new("gyro_y.g_z", &[("size", 0.02)]).unwrap()];
    let first = simulation(7, 2.0, &hidden);
    let found = diagnose(&first.record, &first.bench, &DiagnoseOptions::default()).unwrap();
    let (mut squares, mut shortest) = (0.0, f64::INFINITY);
    let cases = [
        (0.5, 21),
        (0.5, 22),
        (0.5, 23),
        (6.0, 24),
        (6.0, 25),
        (6.0, 26),
    ];
    for (hours, seed) in cases {
        let later = simulation(seed, hours / 24.0, &hidden);
        let left = predicted(&found, &first, &later).attitude;
        let [_, extended, expected] = left.at_end_arcmin();
        squares += (extended / expected).powi(2) / cases.len() as f64;
        shortest = f64::min(shortest, expected);
    }
    // Chi-square with as many degrees of freedom as cases at least, over its expectation: between
    // 0.06 and 3.7 but for one in a thousand.
    assert!((0.06..3.7).contains(&squares), "{squares}");
    assert!(shortest > 0.1, "{shortest}");
}

#[test]
fn a_shift_is_that_of_its_own_row() {
    let hidden = [Hidden::new("gyro_y.g_z", &[("size", 0.004)]).unwrap()];
    let first = simulation(9, 2.0, &hidden);
    let found = diagnose(&first.record, &first.bench, &DiagnoseOptions::default()).unwrap();
    let (gain, all) = (
        found.result.gain.unwrap(),
        found.result.coefficients.unwrap(),
    );
    let rows = all.nominal.iter().zip(all.extended.as_ref().unwrap());
    assert_eq!(gain.coefficient_shift.len(), all.nominal.len());
    for ((nominal, extended), shift) in rows.zip(&gain.coefficient_shift) {
        assert_eq!(shift.coefficient, nominal.name);
        // The same operations on the same numbers.
        let close = |one: f64, other: f64| (one - other).abs() < 1e-9 * (1e-9 + other.abs());
        let own = extended.estimate - nominal.estimate;
        assert!(close(shift.shift, own), "{shift:?}");
        assert!(close(shift.in_sigmas, own / nominal.sigma), "{shift:?}");
    }
}

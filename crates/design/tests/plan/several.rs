//! Planned runs after several records, with random walks, wrong attitudes and temperatures.

use gyrocal::EFFECTS;
use gyrocal_answer::{Answer, SizeChoice};
use gyrocal_calibration::{
    FittedPlatform, NoiseModel, Options, Run, calibrate_runs, joined_record,
};
use gyrocal_design::{
    Aim, Forecast, NamedCause, PlanOptions, PlanResult, first_screen, fitted_to_records, plan,
};
use gyrocal_diagnosis::{DiagnoseOptions, Gate, RecordToDiagnose, diagnose_records};
use gyrocal_hypothesis::RateNoise;
use gyrocal_record::Prior;
use gyrocal_truth::{Hidden, InitialAttitude, Scenario, Simulation, Temperature, simulate};

use super::{made, named, planned, run, scenario};

/// Two records of one platform in two attitudes, a sample each five minutes.
fn two_records(turn_on_deg_per_h: f64, sizes: [f64; 2]) -> [Simulation; 2] {
    [(41, [5.0, 10.0, 20.0]), (42, [60.0, -30.0, 120.0])].map(|(seed, angles_deg)| {
        let size = sizes[seed as usize - 41];
        simulate(&Scenario {
            initial: InitialAttitude::AnglesDeg(angles_deg),
            prior: Prior {
                turn_on_sigma_deg_per_h: [turn_on_deg_per_h; 3],
                ..Prior::default()
            },
            interval_s: 300.0,
            duration_s: 86_400.0,
            hidden: match size {
                0.0 => Vec::new(),
                size => vec![Hidden::new("gyro_y.g_z", &[("size", size)]).unwrap()],
            },
            ..scenario(seed)
        })
        .unwrap()
    })
}

/// A fit to records with an effect in the model, or none.
fn joined<'a>(records: &[&'a Simulation], effect: Option<&str>) -> FittedPlatform<'a> {
    let fit = |record: &&'a Simulation| {
        FittedPlatform::nominal(&run(record), &Options::default(), &NoiseModel::default()).unwrap()
    };
    let fits: Vec<_> = records.iter().map(fit).collect();
    let benches: Vec<_> = records.iter().map(|record| &record.bench).collect();
    let fitted = FittedPlatform::joined(&fits, &benches).unwrap();
    let row = EFFECTS.iter().find(|row| effect == Some(row.id));
    let Some(row) = row else { return fitted };
    let mut extension = fitted.extension().clone();
    let parameters = row.model_parameters();
    extension
        .parameters
        .extend(parameters.map(|place| (place, f64::INFINITY)));
    fitted.refitted(&extension).unwrap()
}

/// The plan from a fit to two records.
fn planned_from(
    fitted: &FittedPlatform<'_>,
    records: &[Simulation; 2],
    named: &[NamedCause],
) -> PlanResult {
    let (record, _) = joined_record(&records.each_ref().map(|record| &record.record));
    let run = Run {
        record: &record,
        bench: &records[1].bench,
    };
    plan(fitted, &run, named, &PlanOptions::default()).unwrap()
}

/// Standard deviations of the coefficients of a fit over those of a forecast.
fn ratios(fitted: &FittedPlatform<'_>, predicted: &[Forecast]) -> Vec<f64> {
    let sigmas = fitted.covariance().diagonal().map(f64::sqrt);
    let pairs = predicted.iter().zip(sigmas.iter());
    pairs
        .map(|(predicted, found)| found / predicted.sigma)
        .collect()
}

#[test]
fn sigmas_of_several_records_and_of_the_run_after_them_are_those_of_a_joint_calibration() {
    for turn_on in [0.0, 0.02] {
        let records = two_records(turn_on, [0.0; 2]);
        let fitted = joined(&records.each_ref(), None);
        let planned = planned_from(&fitted, &records, &[]);
        assert_eq!(planned.records.len(), 2);
        assert_eq!(planned.record.rows, 2 * planned.records[0].rows);
        let runs = records.each_ref().map(run);
        let found = calibrate_runs(&runs, &Options::default(), |_| ()).unwrap();
        for (now, found) in planned.now.coefficients.iter().zip(found.coefficients()) {
            let ratio = found.sigma / now.sigma;
            // The same records about the same fit.
            assert!((0.999..1.001).contains(&ratio), "{} {ratio}", found.id);
        }
        let best = &planned.proposals[0];
        assert_eq!(best.duration_s, records[1].record.duration_s());
        assert!(best.outlook.sigma_ratio < planned.going_on[0].outlook.sigma_ratio);
        let third = simulate(&Scenario {
            seed: 43,
            initial: InitialAttitude::AnglesDeg(best.angles_deg.unwrap()),
            interval_s: 300.0,
            duration_s: best.duration_s,
            prior: records[0].bench.prior,
            ..scenario(43)
        })
        .unwrap();
        let runs = [run(&records[0]), run(&records[1]), run(&third)];
        let found = calibrate_runs(&runs, &Options::default(), |_| ()).unwrap();
        for (predicted, found) in best.outlook.coefficients.iter().zip(found.coefficients()) {
            let ratio = found.sigma / predicted.sigma;
            // As of one record: the trajectory goes by what the records left uncertain.
            assert!((0.98..1.02).contains(&ratio), "{} {ratio}", found.id);
        }
    }
}

#[test]
fn going_on_with_the_last_record_is_a_longer_last_record() {
    for turn_on in [0.0, 0.02] {
        let records = two_records(turn_on, [0.0; 2]);
        let fitted = joined(&records.each_ref(), None);
        let planned = planned_from(&fitted, &records, &[]);
        let longer = simulate(&Scenario {
            initial: InitialAttitude::AnglesDeg([60.0, -30.0, 120.0]),
            interval_s: 300.0,
            duration_s: 2.0 * 86_400.0,
            prior: records[0].bench.prior,
            ..scenario(42)
        })
        .unwrap();
        let runs = [run(&records[0]), run(&longer)];
        let found = calibrate_runs(&runs, &Options::default(), |_| ()).unwrap();
        let going_on = planned.going_on[0].outlook.coefficients.iter();
        for (predicted, found) in going_on.zip(found.coefficients()) {
            let ratio = found.sigma / predicted.sigma;
            // As of one more record, and the smoothed attitude at the end of the day is uncertain as well.
            assert!((0.97..1.03).contains(&ratio), "{} {ratio}", found.id);
        }
    }
}

/// A run of six hours.
fn short() -> PlanOptions {
    PlanOptions {
        durations_s: vec![21_600.0],
        ..PlanOptions::default()
    }
}

/// The joint diagnosis of two records, as it is written.
fn diagnosed(records: &[Simulation; 2]) -> (Answer, PlanResult) {
    let options = DiagnoseOptions::default();
    let given = records.iter().enumerate().map(|(index, one)| {
        let kind = gyrocal_setup::PlatformKind::Stabilised;
        RecordToDiagnose {
            name: format!("{index}.csv"),
            gate: Gate::new(kind, &run(one), &Options::default()),
            bench: &one.bench,
        }
    });
    let found = diagnose_records(given.collect(), &options, |_| ()).unwrap();
    let together = found.together;
    let run = Run {
        record: &together.record,
        bench: &records[1].bench,
    };
    let named = NamedCause::all(&together.result);
    let fitted = together.extended.as_ref().unwrap_or(&together.nominal);
    let planned = plan(fitted, &run, &named, &short()).unwrap();
    (together.result, planned)
}

#[test]
fn a_plan_from_a_written_joint_diagnosis_is_that_from_the_diagnosis() {
    let records = two_records(0.0, [0.01; 2]);
    let (result, from_diagnosis) = diagnosed(&records);
    let named = NamedCause::all(&result);
    assert_eq!(named[0].effect, "gyro_y.g_z");
    assert!(named[0].turn_on_sigmas.is_empty());
    let runs = records.each_ref().map(run);
    let (fitted, record) = fitted_to_records(&result, &runs, &[], &Options::default()).unwrap();
    let run = Run {
        record: &record,
        bench: &records[1].bench,
    };
    let written = plan(&fitted, &run, &named, &short()).unwrap();
    let [one, other] = [&written, &from_diagnosis].map(|plan| &plan.now.coefficients);
    for (one, other) in one.iter().zip(other) {
        // The same noise about the same fit, which each search for it ends within a thousandth of a sigma of.
        assert!(
            (one.sigma / other.sigma - 1.0).abs() < 1e-3,
            "{one:?} {other:?}"
        );
    }
    assert_eq!(written.now.sizes[0].name, "gyro_y.g_z size");
    assert_eq!(written.records, from_diagnosis.records);
    let screen = first_screen(&written);
    let record = screen.facts.iter().find(|fact| fact.label == "record");
    let words = &record.unwrap().words;
    assert!(words.contains("2 records together: 578 rows"), "{words}");
    // Of an answer without findings, which may be an unexplained one: nothing is said of what is in doubt.
    let mut none = written.clone();
    none.now.sets.clear();
    none.aim = Aim::Sigmas;
    let screen = first_screen(&none);
    let why = screen.facts.iter().find(|fact| fact.label == "why");
    let words = &why.unwrap().words;
    assert_eq!(
        words,
        "there are no findings: the run reduces the sigmas most"
    );
}

#[test]
fn a_cause_with_a_size_for_each_turn_on_has_another_in_the_next_run() {
    let records = two_records(0.0, [0.01; 2]);
    let (mut result, _) = diagnosed(&records);
    let chosen = |result: &Answer, choice: SizeChoice| {
        let mut result = result.clone();
        for finding in &mut result.findings {
            if let Some(found) = &mut finding.by_record {
                found.choice = choice;
            }
        }
        NamedCause::all(&result)
    };
    result
        .findings
        .retain(|finding| finding.by_record.is_some());
    let [shared, own] =
        [SizeChoice::Shared, SizeChoice::PerTurnOn].map(|choice| chosen(&result, choice));
    let named = own.iter().find(|one| !one.turn_on_sigmas.is_empty());
    assert!(named.is_some(), "{own:?}");
    let runs = records.each_ref().map(run);
    let (fitted, record) = fitted_to_records(&result, &runs, &[], &Options::default()).unwrap();
    let run = Run {
        record: &record,
        bench: &records[1].bench,
    };
    let options = PlanOptions {
        aim: Some(Aim::Sigmas),
        ..short()
    };
    let [shared, own] = [shared, own].map(|named| plan(&fitted, &run, &named, &options).unwrap());
    for (one, other) in shared.now.coefficients.iter().zip(&own.now.coefficients) {
        // The past is the same; one more unknown of the next run costs nothing before it.
        assert!(
            (one.sigma / other.sigma - 1.0).abs() < 1e-6,
            "{one:?} {other:?}"
        );
    }
    let after = |plan: &PlanResult| plan.proposals[0].outlook.sizes[0].sigma;
    // A run of another size tells less of that so far.
    assert!(
        after(&own) > after(&shared),
        "{} {}",
        after(&own),
        after(&shared)
    );
}

/// A random walk of a gyro that all records have.
const WALK: f64 = 0.002;

#[test]
fn a_random_walk_that_is_named_alone_is_noise_of_all_runs() {
    let scenario = Scenario {
        hidden: vec![Hidden::new("gyro_y.random_walk", &[("size", WALK)]).unwrap()],
        ..scenario(24)
    };
    let first = simulate(&scenario).unwrap();
    let walk = NamedCause {
        shape: Some(WALK),
        ..named("gyro_y.random_walk", &[])
    };
    let planned = planned(&first, &[walk], &PlanOptions::default()).unwrap();
    assert!(planned.now.sets.is_empty());
    let best = &planned.proposals[0];
    let second = made(&scenario, best);
    let noise = RateNoise {
        white: vec![1.0; 3],
        walk: vec![0.0, WALK, 0.0],
    };
    let walking = |records: &[&Simulation], predicted: &[Forecast]| {
        let fitted = joined(records, None).with_rate_noise(&noise).unwrap();
        ratios(&fitted, predicted)
    };
    for ratio in walking(&[&first], &planned.now.coefficients) {
        // The same record about the same fit.
        assert!((0.999..1.001).contains(&ratio), "{ratio}");
    }
    for ratio in walking(&[&first, &second], &best.outlook.coefficients) {
        // The trajectory goes by what the first record left uncertain, and each row of the plan stands for
        // several, between which the walk goes on.
        assert!((0.97..1.03).contains(&ratio), "{ratio}");
    }
}

#[test]
fn a_random_walk_beside_rivals_is_compared_with_them() {
    let scenario = Scenario {
        hidden: vec![Hidden::new("gyro_y.random_walk", &[("size", 0.5 * WALK)]).unwrap()],
        ..scenario(24)
    };
    let first = simulate(&scenario).unwrap();
    let walk = NamedCause {
        shape: Some(0.5 * WALK),
        ..named("gyro_y.random_walk", &[("gyro_y.ramp", 0.5)])
    };
    let planned = planned(&first, &[walk], &short()).unwrap();
    // Rounding of a sum of probabilities.
    assert!((planned.now.sets[0].mean_size - 2.0).abs() < 1e-12);
    let best = &planned.proposals[0].outlook;
    // A ramp and a walk that drifts as far in a day and a half are seldom told apart by six hours more.
    assert!((1.0..=2.0).contains(&best.sets[0].mean_size));
    assert!(best.sigma_ratio < 1.0, "{best:?}");
}

#[test]
fn a_run_is_planned_after_sizes_of_opposite_sign() {
    let (result, planned) = diagnosed(&two_records(0.0, [0.02, -0.015]));
    let named = NamedCause::all(&result);
    // One of the causes is a walk, which is noise of the fit.
    let walks = named.iter().filter(|one| one.effect.ends_with("walk"));
    assert_eq!(planned.now.sets.len(), named.len() - walks.count());
    assert!(planned.proposals[0].outlook.sigma_ratio < 1.0);
}

#[test]
fn a_wrong_first_attitude_is_of_its_own_record() {
    let mut records = two_records(0.0, [0.0; 2]);
    let off = [("x_deg", 0.3), ("y_deg", 0.0), ("z_deg", 0.0)];
    records[1] = simulate(&Scenario {
        initial: InitialAttitude::AnglesDeg([60.0, -30.0, 120.0]),
        initial_angles_sigma_deg: [0.02; 3],
        interval_s: 300.0,
        duration_s: 86_400.0,
        hidden: vec![Hidden::new("platform.initial_attitude", &off).unwrap()],
        ..scenario(42)
    })
    .unwrap();
    let (result, from_diagnosis) = diagnosed(&records);
    let named = NamedCause::all(&result);
    assert_eq!(named[0].effect, "platform.initial_attitude");
    let runs = records.each_ref().map(run);
    let (fitted, record) = fitted_to_records(&result, &runs, &[], &Options::default()).unwrap();
    let start_s = record.time_s[records[0].record.len()] - record.time_s[0];
    assert_eq!(named[0].shape, Some(start_s));
    let run = Run {
        record: &record,
        bench: &records[1].bench,
    };
    let written = plan(&fitted, &run, &named, &short()).unwrap();
    let [one, other] = [&written, &from_diagnosis].map(|plan| &plan.now.coefficients);
    for (one, other) in one.iter().zip(other) {
        let ratio = one.sigma / other.sigma;
        // As of the cause in two records.
        assert!((0.999..1.001).contains(&ratio), "{} {ratio}", one.name);
    }
}

#[test]
fn temperatures_of_a_planned_run_are_related_to_those_of_the_records() {
    let records = [
        (41, [5.0, 10.0, 20.0], 20.0),
        (42, [60.0, -30.0, 120.0], 30.0),
    ];
    let warm = |(seed, angles_deg, mean_c): (u64, [f64; 3], f64)| {
        simulate(&Scenario {
            initial: InitialAttitude::AnglesDeg(angles_deg),
            temperature: Some(Temperature {
                mean_c,
                ..Temperature::default()
            }),
            interval_s: 300.0,
            duration_s: 86_400.0,
            ..scenario(seed)
        })
        .unwrap()
    };
    let records = records.map(warm);
    let effect = "gyro_x.temperature";
    let fitted = joined(&records.each_ref(), Some(effect));
    let planned = planned_from(&fitted, &records, &[named(effect, &[])]);
    let best = &planned.proposals[0];
    let mut third = warm((43, best.angles_deg.unwrap(), 30.0));
    // The course of the last record again.
    third
        .record
        .temperature_c
        .clone_from(&records[1].record.temperature_c);
    let [a, b] = &records;
    let found = joined(&[a, b, &third], Some(effect));
    let [_, others @ ..] = best.outlook.coefficients.as_slice() else {
        panic!("no coefficients")
    };
    // The bias of x is that at the mean temperature, which is another one of three records.
    let predicted = [&best.outlook.sizes[..1], others, &best.outlook.sizes].concat();
    for (index, ratio) in ratios(&found, &predicted).into_iter().enumerate().skip(1) {
        // As without temperature.
        assert!((0.98..1.02).contains(&ratio), "{index} {ratio}");
    }
}

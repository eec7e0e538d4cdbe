//! Planned runs, simulated: their results agree with the predictions.
#![cfg(test)]

use gyrocal::EFFECTS;
use gyrocal_calibration::{
    FittedPlatform, NoiseModel, Options, Run, calibrate_runs, joined_record,
};
use gyrocal_design::{
    Aim, DesignError, Forecast, Goal, NamedCause, PlanOptions, PlanResult, Proposal, compare,
    first_screen, fitted_to_records, plan,
};
use gyrocal_diagnosis::result::{DiagnosisResult, SizeChoice};
use gyrocal_diagnosis::{DiagnoseOptions, Gate, RecordToDiagnose, diagnose_records};
use gyrocal_hypothesis::RateNoise;
use gyrocal_record::{GimbalLimits, Prior};
use gyrocal_truth::{
    Coefficients, Hidden, InitialAttitude, Scenario, Simulation, Temperature, simulate,
};

/// A day and a half of samples each two minutes.
fn scenario(seed: u64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: 1.5 * 86_400.0,
        ..Scenario::default()
    }
}

/// With a cross-axis term whose near twin, the magnetic sensitivity, explains it as well.
fn with_twin(seed: u64) -> Scenario {
    Scenario {
        magnetic_field_gauss: Some([0.02, 0.25, -0.4]),
        hidden: vec![Hidden::new("gyro_y.g_z", &[("size", 0.0009)]).unwrap()],
        ..scenario(seed)
    }
}

/// The planned run: another draw of all noise.
fn made(scenario: &Scenario, planned: &Proposal) -> Simulation {
    simulate(&Scenario {
        seed: scenario.seed + 1_000,
        initial: InitialAttitude::AnglesDeg(planned.angles_deg.unwrap()),
        duration_s: planned.duration_s,
        ..scenario.clone()
    })
    .unwrap()
}

fn run(simulation: &Simulation) -> Run<'_> {
    Run {
        record: &simulation.record,
        bench: &simulation.bench,
    }
}

fn named(effect: &str, rivals: &[(&str, f64)]) -> NamedCause {
    NamedCause {
        effect: effect.to_owned(),
        shape: None,
        turn_on_sigmas: Vec::new(),
        rivals: rivals
            .iter()
            .map(|(id, d)| ((*id).to_owned(), *d))
            .collect(),
    }
}

fn planned(
    first: &Simulation,
    named: &[NamedCause],
    options: &PlanOptions,
) -> Result<PlanResult, DesignError> {
    let noise = NoiseModel::default();
    let fitted = NamedCause::fitted(named, &run(first), &noise, &Options::default())?;
    plan(&fitted, &run(first), named, options)
}

#[test]
fn sigmas_after_the_planned_run_are_as_predicted() {
    for (seed, turn_on) in [(21, 0.0), (22, 0.02)] {
        let scenario = Scenario {
            prior: Prior {
                turn_on_sigma_deg_per_h: [turn_on; 3],
                ..Prior::default()
            },
            ..scenario(seed)
        };
        let first = simulate(&scenario).unwrap();
        let planned = planned(&first, &[], &PlanOptions::default()).unwrap();
        assert_eq!(planned.aim, Aim::Sigmas);
        let best = &planned.proposals[0];
        // Another attitude gives far more information than continuing.
        assert!(best.outlook.sigma_ratio < 0.8 * planned.going_on[0].outlook.sigma_ratio);
        let second = made(&scenario, best);
        let found =
            calibrate_runs(&[run(&first), run(&second)], &Options::default(), |_| ()).unwrap();
        for (predicted, found) in best.outlook.coefficients.iter().zip(found.coefficients()) {
            let ratio = found.sigma / predicted.sigma;
            // Both are bounds along nearly the same trajectory: what differs is where it goes by
            // what the first record left uncertain, a thousandth of a radian.
            assert!((0.98..1.02).contains(&ratio), "{} {ratio}", found.id);
        }
    }
}

#[test]
fn near_twins_are_planned_apart_and_the_run_tells_them_apart() {
    let scenario = with_twin(33);
    let first = simulate(&scenario).unwrap();
    // This record names the wrong effect.
    let named = [named("gyro_y.magnetic", &[("gyro_y.g_z", 0.1)])];
    let options = PlanOptions {
        goal: Goal {
            one_name: true,
            ..Goal::default()
        },
        ..PlanOptions::default()
    };
    let planned = planned(&first, &named, &options).unwrap();
    assert_eq!(planned.aim, Aim::Set);
    // Rounding of a sum of probabilities.
    assert!((planned.now.sets[0].mean_size - 2.0).abs() < 1e-12);
    let best = &planned.proposals[0];
    assert!(best.outlook.sets[0].one_left > 0.95);
    // The shortest run is shorter, and too long by less than one step of the search.
    let enough = planned.goal.unwrap().run.unwrap();
    assert!(enough.duration_s < best.duration_s);
    assert!((0.95..1.0).contains(&enough.outlook.sets[0].one_left));

    let second = made(&scenario, best);
    let noise = NoiseModel::default();
    let fitted = NamedCause::fitted(&named, &run(&first), &noise, &Options::default()).unwrap();
    let found = compare(
        &fitted,
        &run(&first),
        &run(&second),
        None,
        &named,
        &Options::default(),
    )
    .unwrap();
    let [field, truth] = found.sets[0].as_slice() else {
        panic!("{:?}", found.sets)
    };
    assert!(truth.stays && !field.stays, "{:?}", found.sets);
    let [size, sigma] = truth.sizes[0];
    // One in sixteen thousand is farther off.
    assert!((size - 0.0009).abs() < 4.0 * sigma, "{size} {sigma}");
}

#[test]
fn a_twin_outside_of_the_search_is_planned_for_if_its_size_may_be() {
    let first = simulate(&with_twin(33)).unwrap();
    let options = PlanOptions {
        durations_s: vec![7_200.0],
        ..PlanOptions::default()
    };
    let planned = planned(&first, &[named("gyro_y.g_z", &[])], &options).unwrap();
    let members = planned.now.sets[0]
        .members
        .iter()
        .map(|member| member.effect.clone());
    assert!(
        members
            .into_iter()
            .any(|effect| effect == "gyro_y.magnetic")
    );
}

#[test]
fn what_no_run_separates_is_told_and_not_planned_for() {
    let scenario = Scenario {
        hidden: vec![Hidden::new("gyro_x.g_yy", &[("size", 0.005)]).unwrap()],
        ..scenario(35)
    };
    let first = simulate(&scenario).unwrap();
    let named = [named("gyro_x.g_yy", &[("gyro_x.g_zz", 0.0)])];
    let planned = planned(&first, &named, &PlanOptions::default()).unwrap();
    assert_eq!(planned.inseparable, [["gyro_x.g_yy", "gyro_x.g_zz"]]);
    // They count as one effect, without other alternatives.
    assert_eq!(planned.now.sets[0].members.len(), 1);
    assert_eq!(planned.aim, Aim::Sigmas);
}

#[test]
fn a_run_keeps_the_gimbals_within_their_limits_or_there_is_none() {
    let first = simulate(&scenario(36)).unwrap();
    let limits = GimbalLimits {
        deg: [Some([-40.0, 40.0]), Some([-60.0, 60.0]), None],
    };
    let options = |duration_s| PlanOptions {
        durations_s: vec![duration_s],
        limits,
        ..PlanOptions::default()
    };
    let short = planned(&first, &[], &options(10_800.0)).unwrap();
    for proposal in &short.proposals {
        assert!(limits.hold(proposal.angles_deg.unwrap()));
        let made = made(&scenario(36), proposal);
        for attitude in made.truth.platform_c_enu {
            let angles = attitude.angles_deg();
            // Coarse rows lie a degree apart.
            let near = angles.map(|angle| 0.95 * angle);
            assert!(limits.hold(near), "{angles:?}");
        }
    }
    // The Earth rotates once.
    let error = planned(&first, &[], &options(86_400.0)).unwrap_err();
    assert!(
        matches!(error, DesignError::Limits { longest_h, .. } if (3.0..24.0).contains(&longest_h)),
        "{error}"
    );
}

#[test]
fn what_makes_no_sense_is_refused() {
    let first = simulate(&scenario(37)).unwrap();
    let short = PlanOptions {
        durations_s: vec![60.0],
        ..PlanOptions::default()
    };
    let error = planned(&first, &[], &short).unwrap_err().to_string();
    assert!(
        error.contains("expected from 1440 s, twelve rows"),
        "{error}"
    );
    let unknown = PlanOptions {
        goal: Goal {
            sigmas: vec![("gyro_x.g_y".to_owned(), 1e-4)],
            one_name: false,
        },
        ..PlanOptions::default()
    };
    let error = planned(&first, &[], &unknown).unwrap_err().to_string();
    assert!(
        error.contains("there is no coefficient `gyro_x.g_y`"),
        "{error}"
    );
    let noise = [named("accel_x.noise", &[])];
    let error = planned(&first, &noise, &PlanOptions::default()).unwrap_err();
    assert!(matches!(error, DesignError::NotPlannable { .. }), "{error}");
}

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
fn diagnosed(records: &[Simulation; 2]) -> (DiagnosisResult, PlanResult) {
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
}

#[test]
fn a_cause_with_a_size_for_each_turn_on_has_another_in_the_next_run() {
    let records = two_records(0.0, [0.01; 2]);
    let (mut result, _) = diagnosed(&records);
    let chosen = |result: &DiagnosisResult, choice: SizeChoice| {
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

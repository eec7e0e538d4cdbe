//! Planned runs, simulated: their results agree with the predictions.
#![cfg(test)]

mod several;

use std::time::{Duration, Instant};

use gyrocal_calibration::{NoiseModel, Options, Run, calibrate_runs};
use gyrocal_design::{
    Aim, DesignError, Goal, NamedCause, PlanOptions, PlanResult, Proposal, compare, plan,
};
use gyrocal_hypothesis::Stop;
use gyrocal_record::{GimbalLimits, Prior};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

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
fn a_search_that_is_stopped_plans_nothing() {
    let first = simulate(&scenario(23)).unwrap();
    let noise = NoiseModel::default();
    let fitted = NamedCause::fitted(&[], &run(&first), &noise, &Options::default()).unwrap();
    let stop = Stop::default();
    let found = std::thread::scope(|scope| {
        let ask = || {
            std::thread::sleep(Duration::from_millis(300));
            stop.ask();
            Instant::now()
        };
        let asked = scope.spawn(ask);
        // Of a goal that takes a search for each duration.
        let options = PlanOptions {
            durations_s: (1..200).map(|hours| 3600.0 * f64::from(hours)).collect(),
            ..PlanOptions::default()
        };
        let found = stop.over(|| plan(&fitted, &run(&first), &[], &options));
        (found, asked.join().unwrap().elapsed())
    });
    assert!(
        matches!(found.0, Err(DesignError::Stopped(_))),
        "{:?}",
        found.0
    );
    // All threads of the search have ended.
    assert!(found.1 < Duration::from_secs(2), "{:?}", found.1);
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

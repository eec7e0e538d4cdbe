//! Effects hidden in simulated records: each kind of search finds its own.

use gyrocal_answer::{Answer, FindingKind, Prediction, SetMember, UnmodelledPattern, Verdict};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::{Bench, Record};
use gyrocal_truth::{
    Coefficients, Hidden, InitialAttitude, Moment, Scenario, Term, simulate, simulate_with,
};

/// Two days at a random attitude with an effect hidden.
fn record(seed: u64, effect: &str, parameters: &[(&str, f64)]) -> (Record, Bench) {
    let simulation = simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 2.0 * 86_400.0,
        hidden: vec![Hidden::new(effect, parameters).unwrap()],
        ..Scenario::default()
    })
    .unwrap();
    (simulation.record, simulation.bench)
}

/// The diagnosis of a scenario with the drift of the paper and any attitude.
fn diagnosed(scenario: Scenario) -> Answer {
    let simulation = simulate(&Scenario {
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        ..scenario
    })
    .unwrap();
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options);
    found.unwrap().result
}

/// Diagnoses, and returns the parameters of the single expected finding.
fn only_finding(effect: &str, parameters: &[(&str, f64)]) -> Vec<(String, f64, Option<f64>)> {
    let (record, bench) = record(5, effect, parameters);
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let found = found.result;
    assert_eq!(found.verdict, Verdict::EffectsFound);
    let names: Vec<&str> = found.causes().map(|f| f.effect.as_str()).collect();
    assert_eq!(names, [effect]);
    let noise: Vec<_> = found.of_kind(FindingKind::Noise).collect();
    assert!(noise.is_empty(), "{noise:?}");
    assert!(!found.is_unexplained(), "{}", found.remainder.description);
    // All these are large: a model without them predicts left-out blocks worse.
    assert!(found.gain.unwrap().cross_validated_log_score_nats > 8.0);
    let parameters = found.findings[0].parameters.iter();
    parameters
        .map(|parameter| (parameter.name.clone(), parameter.estimate, parameter.sigma))
        .collect()
}

#[test]
fn none_of_these_is_likelier_where_the_catalogue_lacks_the_cause() {
    let none = |terms: &[Term], hidden: Vec<Hidden>| {
        let scenario = Scenario {
            seed: 7,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::Random,
            duration_s: 2.0 * 86_400.0,
            hidden,
            ..Scenario::default()
        };
        let simulation = simulate_with(&scenario, terms).unwrap();
        let options = DiagnoseOptions::default();
        let found = diagnose(&simulation.record, &simulation.bench, &options);
        let found = found.unwrap().result;
        let first = found.causes().next().unwrap();
        let nats = first.none_of_these_log_likelihood_ratio.unwrap();
        let probability = first.none_of_these.unwrap();
        // At prior odds of one to one; rounding only.
        assert!((probability - 1.0 / (1.0 + (-nats).exp())).abs() < 1e-12);
        nats
    };
    // A scale that changes during two days.
    let ageing = |at: &Moment| [0.0, 1.3e-5 * at.time_s / 172_800.0 * at.accel_g[1], 0.0];
    let ageing = Term::Output(Box::new(ageing));
    let outside = none(&[ageing], Vec::new());
    let listed = none(
        &[],
        vec![Hidden::new("gyro_y.g_z", &[("size", 0.01)]).unwrap()],
    );
    // Likelier than not, and less likely than one to ten.
    assert!(
        outside > 0.0 && listed < -(10.0_f64.ln()),
        "{outside} {listed}"
    );
}

#[test]
fn each_random_walk_has_its_own_p_value() {
    let walk =
        |gyro: &str, size| Hidden::new(&format!("gyro_{gyro}.random_walk"), &[("size", size)]);
    let found = diagnosed(Scenario {
        seed: 5,
        duration_s: 2.0 * 86_400.0,
        hidden: vec![walk("x", 1e-3).unwrap(), walk("y", 3e-4).unwrap()],
        ..Scenario::default()
    });
    let of = |id: &str| {
        let mut causes = found.causes();
        causes
            .find(|cause| cause.effect == id)
            .map(|cause| (cause.z, cause.p_value))
            .unwrap()
    };
    let (large, small) = (of("gyro_x.random_walk"), of("gyro_y.random_walk"));
    // The joint test is that of the larger one; the smaller one is held against what it gains itself.
    assert!(
        large.0 > small.0 && large.1 < small.1,
        "{large:?} {small:?}"
    );
}

#[test]
fn a_term_of_the_drift_is_found_with_its_size() {
    let found = only_finding("gyro_y.g_z", &[("size", 0.01)]);
    let (_, estimate, sigma) = &found[0];
    // One in sixteen thousand is farther off than four sigmas.
    assert!((estimate - 0.01).abs() < 4.0 * sigma.unwrap());
}

/// The causes named in three days of a platform at an attitude of its own, with effects hidden.
fn causes_at(
    (seed, latitude_deg, angles_deg): (u64, f64, [f64; 3]),
    gyro_noise_deg_per_h: f64,
    hidden: &[(&str, &[(&str, f64)])],
) -> Vec<String> {
    let hidden = hidden.iter();
    let simulation = simulate(&Scenario {
        seed,
        latitude_deg,
        initial: InitialAttitude::AnglesDeg(angles_deg),
        initial_angles_sigma_deg: [0.01; 3],
        coefficients: Coefficients {
            bias_deg_per_h: [0.31, -0.22, 0.113],
            g_deg_per_h_per_g: [-0.16, 0.114, 0.187],
            gg_deg_per_h_per_g2: [0.021, -0.048, 0.033],
        },
        accel_noise_g: 1e-5,
        gyro_noise_deg_per_h,
        duration_s: 3.0 * 86_400.0,
        interval_s: 60.0,
        hidden: hidden
            .map(|(effect, parameters)| Hidden::new(effect, parameters).unwrap())
            .collect(),
        ..Scenario::default()
    })
    .unwrap();
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap();
    let causes = found.result.causes();
    causes.map(|cause| cause.effect.clone()).collect()
}

/// Walks are compared with effects also where the effects took the whole budget of the search.
#[test]
fn a_large_warm_up_beside_a_random_walk_leaves_no_effect_for_the_walk() {
    let warm_up: &[_] = &[("size", 0.03), ("time_constant_h", 4.0)];
    let causes = causes_at(
        (3, 47.3, [20.0, 35.0, -70.0]),
        0.002,
        &[
            ("gyro_x.warmup", warm_up),
            ("gyro_z.random_walk", &[("size", 5e-4)]),
        ],
    );
    assert_eq!(causes, ["gyro_x.warmup", "gyro_z.random_walk"]);
}

/// A large effect does not hide that walks beside it are better than further effects.
#[test]
fn walks_beside_a_large_bias_leave_no_effect_of_the_gyros() {
    let causes = causes_at(
        (221, 42.731_315_749_786_745, [-82.0, -50.0, 45.2]),
        0.003_600_550_348_248_304_4,
        &[
            ("accel_x.bias", &[("size", 9.749_410_764_819_277e-5)]),
            ("gyro_x.random_walk", &[("size", 6.736_687_199_369_466e-4)]),
            ("gyro_y.random_walk", &[("size", 6.043_858_104_436_561e-4)]),
            (
                "gyro_z.random_walk",
                &[("size", 1.109_993_492_993_095_2e-4)],
            ),
        ],
    );
    let walks = [
        "gyro_x.random_walk",
        "gyro_y.random_walk",
        "gyro_z.random_walk",
    ];
    assert!(
        causes.iter().any(|cause| cause == "accel_x.bias"),
        "{causes:?}"
    );
    let others = causes.iter().filter(|cause| *cause != "accel_x.bias");
    let mut others = others.filter(|cause| !walks.contains(&cause.as_str()));
    assert_eq!(others.next(), None, "{causes:?}");
}

/// A warm-up of an hour acts like those of two other gyros, or of one and another first attitude: the
/// selection takes these, since about the nominal model each alone gains more.
#[test]
fn a_short_warm_up_is_not_shared_out_among_others() {
    let warm_up: &[_] = &[("size", 0.0293), ("time_constant_h", 1.35)];
    let causes = causes_at(
        (325, 66.0, [170.6, 26.6, -153.3]),
        0.002,
        &[("gyro_z.warmup", warm_up)],
    );
    assert_eq!(causes, ["gyro_z.warmup"]);
}

/// Before both are in the model a curve over a force does the work of two large errors of accelerometers.
#[test]
fn two_errors_of_accelerometers_are_no_curve() {
    let size: &[_] = &[("size", 1e-4)];
    for (seed, effects) in [
        (4, ["accel_x.scale", "accel_y.bias"]),
        (8, ["accel_xy.nonorthogonality", "accel_y.scale"]),
    ] {
        let mut causes = causes_at(
            (seed, 48.2, [12.0, -25.0, 40.0]),
            0.002,
            &effects.map(|effect| (effect, size)),
        );
        causes.sort();
        assert_eq!(causes, effects, "seed {seed}");
    }
}

#[test]
fn a_step_is_found_with_its_onset() {
    let found = only_finding("gyro_x.step", &[("size", 0.01), ("onset_s", 90_000.0)]);
    assert_eq!(found[1].0, "onset_s");
    // Five per cent of the record.
    assert!((found[1].1 - 90_000.0).abs() < 8_640.0, "{found:?}");
}

#[test]
fn a_knock_is_found_in_its_step() {
    let angles = [("x_deg", 0.02), ("y_deg", -0.01), ("z_deg", 0.015)];
    let found = only_finding(
        "platform.knock",
        &[angles[0], angles[1], angles[2], ("onset_s", 100_010.0)],
    );
    for ((_, truth), (_, estimate, sigma)) in angles.iter().zip(&found) {
        assert!((estimate - truth).abs() < 4.0 * sigma.unwrap(), "{found:?}");
    }
    // The row after it, or a neighbour that explains as much: noise is a tenth of the knock.
    assert!((found[3].1 - 100_010.0).abs() <= 180.0, "{found:?}");
}

#[test]
fn a_random_walk_is_no_cause_with_a_law() {
    let found = only_finding("gyro_z.random_walk", &[("size", 0.001)]);
    // Forty increments determine a variance to a fifth and its root to a tenth; the walk is
    // observable in some of them only: a factor of two.
    assert!((0.5..2.0).contains(&(found[0].1 / 0.001)), "{found:?}");
}

#[test]
fn a_term_beside_a_random_walk_is_found_and_judged_forward() {
    let found = diagnosed(Scenario {
        seed: 11,
        duration_s: 2.0 * 86_400.0,
        hidden: vec![
            Hidden::new("gyro_y.g_z", &[("size", 0.05)]).unwrap(),
            Hidden::new("gyro_x.random_walk", &[("size", 0.001)]).unwrap(),
        ],
        ..Scenario::default()
    });
    let names: Vec<&str> = found.causes().map(|f| f.effect.as_str()).collect();
    assert_eq!(names, ["gyro_y.g_z", "gyro_x.random_walk"]);
    let gain = found.gain.unwrap();
    assert_eq!(gain.prediction, Prediction::Forward);
    // The first block is predicted from nothing.
    assert!(gain.block_log_score_nats[0].unwrap().abs() < f64::EPSILON);
    let term = &found.findings[0];
    assert_eq!(term.accepted, Some(true));
    let parameter = &term.parameters[0];
    // One in sixteen thousand is farther off than four sigmas.
    assert!((parameter.estimate - 0.05).abs() < 4.0 * parameter.sigma.unwrap());
    // The sets of effects have a measured coverage, those of walks none.
    assert!(term.coverage.is_some());
    assert_eq!(found.findings[1].coverage, None);
}

#[test]
fn a_ramp_of_one_gyro_is_no_walk_of_it_beside_walks_of_the_others() {
    let hidden = [
        ("gyro_x.ramp", &[("size", 0.02)][..]),
        ("gyro_y.random_walk", &[("size", 0.003)]),
        ("gyro_z.random_walk", &[("size", 0.01)]),
    ];
    let found = diagnosed(Scenario {
        seed: 12,
        duration_s: 2.5 * 86_400.0,
        interval_s: 120.0,
        hidden: hidden
            .iter()
            .map(|(effect, parameters)| Hidden::new(effect, parameters).unwrap())
            .collect(),
        ..Scenario::default()
    });
    let names: Vec<&str> = found.causes().map(|f| f.effect.as_str()).collect();
    // The budget of work ends before the last comparisons, which change no name.
    assert_eq!(names, hidden.map(|(effect, _)| effect));
}

#[test]
fn what_the_catalogue_does_not_hold_has_no_name_and_is_told() {
    type Case<'a> = (&'a str, &'a [(&'a str, f64)], &'a str, Option<&'a str>);
    let tone = |size| [("size", size), ("period_h", 5.3)];
    let cases: [Case<'_>; 4] = [
        ("gyro_x.tone", &tone(0.004), "gyro_x", None),
        ("accel_y.tone", &tone(6e-6), "accel_y", None),
        ("gyro_y.sign_y", &[("size", 0.01)], "gyro_y", Some("y")),
        ("accel_y.sign", &[("size", 5e-5)], "accel_y", Some("y")),
    ];
    for (effect, parameters, channel, axis) in cases {
        let (record, bench) = record(6, effect, parameters);
        let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
        let found = found.result;
        let described = &found.remainder.description;
        assert!(found.is_unexplained(), "{effect}: {described}");
        let strongest = found.remainder.unmodelled.first().expect(effect);
        assert_eq!(strongest.channel, channel, "{effect}: {described}");
        match (strongest.pattern, strongest.period_h) {
            // Determined to a fraction of one cycle in the two days, which would be a tenth.
            (UnmodelledPattern::Line, Some(period_h)) if axis.is_none() => {
                assert!((period_h / 5.3 - 1.0).abs() < 0.03, "{period_h}");
                // A tone is no effect of the catalogue.
                assert!(found.causes().next().is_none(), "{effect}");
                assert_eq!(found.verdict, Verdict::Unexplained);
            }
            (UnmodelledPattern::Curve, None) => {
                assert_eq!(strongest.depends_on.as_deref(), axis, "{effect}");
            }
            other => panic!("{effect}: {other:?}"),
        }
    }
}

#[test]
fn coefficients_hold_for_the_equivalent_that_is_the_cause() {
    // On the unit sphere g_xx, g_yy and g_zz differ by a bias: one name stands for the two that the nominal
    // model does not hold, and its bias is wrong by the whole size if the other is the cause.
    let (record, bench) = record(7, "gyro_x.g_zz", &[("size", 0.02)]);
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let found = found.result;
    let cause = found.causes().next().unwrap();
    let mut names = vec![cause.effect.clone()];
    names.extend(cause.equivalents().map(str::to_owned));
    assert!(names.contains(&"gyro_x.g_zz".to_owned()), "{names:?}");
    let coefficients = found.coefficients.as_ref().unwrap();
    for effect in &names {
        let of_effect = |m: &&SetMember| m.effects.contains(effect);
        let member = coefficients.members.iter().find(of_effect).unwrap();
        assert!((member.weight - coefficients.members[0].weight).abs() < 1e-12);
    }
    let truth = Coefficients::PAPER_LIKE.named();
    let mut outside_of_the_named = 0;
    for (index, interval) in coefficients.over_set.as_ref().unwrap().iter().enumerate() {
        let [low, high] = interval.interval;
        // Three times the half width: a coefficient beyond is impossible in the mixture.
        let margin = high - low;
        let of_name = |(name, ..): &&(&str, f64, &str)| *name == interval.name;
        let (_, truth, _) = *truth.iter().find(of_name).unwrap();
        let held = (low - margin..=high + margin).contains(&truth);
        assert!(held, "{}: {truth} in {low} to {high}", interval.name);
        let named = &coefficients.extended.as_ref().unwrap()[index];
        if (named.estimate - truth).abs() > 5.0 * named.sigma {
            outside_of_the_named += 1;
        }
    }
    // The named one alone is wrong whenever it is not the cause.
    assert_eq!(outside_of_the_named > 0, cause.effect != "gyro_x.g_zz");
}

#[test]
fn correlated_noise_with_rows_minutes_apart_is_named_and_leaves_nothing() {
    // Over an hour its spectrum is nearly that of noise of the gyros, and the levels are not as declared.
    let levels = [
        ("accel_x.noise", 1.0),
        ("accel_y.noise", 1.1),
        ("accel_z.noise", 0.6),
        ("gyro_x.noise", 1.4),
        ("gyro_y.noise", 0.7),
        ("gyro_z.noise", 0.8),
    ];
    const CORRELATION: f64 = 0.24;
    let mut without_cause = 0;
    for seed in 0..4 {
        let level = |(id, ratio): &(&str, f64)| Hidden::new(id, &[("ratio", *ratio)]).unwrap();
        let correlated = [("correlation", CORRELATION)];
        let mut hidden: Vec<Hidden> = levels.iter().map(level).collect();
        hidden.push(Hidden::new("accel.coloured_noise", &correlated).unwrap());
        let found = diagnosed(Scenario {
            seed,
            duration_s: 2.2 * 86_400.0,
            interval_s: 240.0,
            hidden,
            ..Scenario::default()
        });
        assert!(!found.is_unexplained(), "{seed}: {:?}", found.remainder);
        if found.causes().count() > 0 {
            continue;
        }
        without_cause += 1;
        let mut noise = found.findings.iter();
        let named = noise.find(|finding| finding.effect == "accel.coloured_noise");
        let size = &named.unwrap().parameters[0];
        // Four standard deviations: one in sixteen thousand is farther off.
        let off = (size.estimate - CORRELATION).abs();
        assert!(off < 4.0 * size.sigma.unwrap(), "{seed}: {size:?}");
    }
    // Where noise of the gyros leaves no correlation, that of the accelerometers is too small: one of these
    // four records has a false cause, a limit that docs/diagnosis.md tells.
    assert!(without_cause >= 3, "{without_cause}");
}

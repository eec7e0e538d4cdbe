//! Intervals of onsets and time constants.

use gyrocal::EFFECTS;
use gyrocal_calibration::{FittedPlatform, PLATFORM, rows};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_hypothesis::shape_derivative;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, simulate};

#[test]
fn the_time_constant_of_a_large_warm_up_is_that_of_the_noise_it_leaves() {
    const TIME_CONSTANT_H: f64 = 3.0;
    for seed in 0..3 {
        // Some three hundred standard deviations, a part of them in a gap.
        let parameters = [("size", 0.3), ("time_constant_h", TIME_CONSTANT_H)];
        let simulation = simulate(&Scenario {
            seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::Random,
            duration_s: 2.5 * 86_400.0,
            interval_s: 120.0,
            gaps_s: vec![[7_200.0, 21_600.0]],
            hidden: vec![Hidden::new("gyro_x.warmup", &parameters).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        let (record, bench) = (&simulation.record, &simulation.bench);
        let found = diagnose(record, bench, &DiagnoseOptions::default()).unwrap();
        let causes: Vec<_> = found.result.causes().collect();
        assert_eq!(causes.len(), 1, "{seed}: {causes:?}");
        let shape = causes[0].parameter("time_constant_h").unwrap();
        let pieces = shape.interval.as_deref().unwrap();
        let [[low, high]] = pieces else {
            panic!("{seed}: {pieces:?}");
        };
        assert!(
            (*low..=*high).contains(&shape.estimate),
            "{seed}: {shape:?}"
        );
        // Of a normal distribution one in eleven thousand is farther off than twice the 95 % interval.
        let half = 0.5 * (high - low);
        let off = (shape.estimate - TIME_CONSTANT_H).abs();
        assert!(off < 2.0 * half, "{seed}: {shape:?}");
        // Noise of some fifty degrees of freedom: Student's deviates of 200 and of 10 are 1.972 and 2.228.
        let deviate = half / shape.sigma.unwrap();
        assert!((1.972..2.228).contains(&deviate), "{seed}: {deviate}");
    }
}

/// Against the standard deviation from fits that have the derivative of the effect by its time constant.
#[test]
fn the_interval_of_a_time_constant_is_over_the_noise_without_its_unknowns() {
    for seed in 0..4 {
        let parameters = [("size", 0.1), ("time_constant_h", 8.0)];
        let simulation = simulate(&Scenario {
            seed,
            initial: InitialAttitude::Random,
            duration_s: 2.5 * 86_400.0,
            interval_s: 240.0,
            hidden: vec![Hidden::new("gyro_x.warmup", &parameters).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        let (record, bench) = (&simulation.record, &simulation.bench);
        let found = diagnose(record, bench, &DiagnoseOptions::default()).unwrap();
        let cause = found.result.causes().next().unwrap();
        let [size, shape] = ["size", "time_constant_h"].map(|name| cause.parameter(name).unwrap());
        let mut effects = EFFECTS.iter();
        let effect = effects.find(|effect| effect.id == cause.effect).unwrap();
        let between = [0.99 * shape.estimate, 1.01 * shape.estimate];
        let rows = rows(record, Vec::new());
        let column = shape_derivative(&PLATFORM, effect, size.estimate, between, &rows).unwrap();
        let fitted = found.extended.as_ref().unwrap();
        let mut extension = fitted.extension().clone();
        extension.columns.extend([column], f64::INFINITY);
        let searched = fitted.refitted(&extension).unwrap();
        let noise = searched.restricted_noise().unwrap();
        let restricted = searched.with_rate_noise(&noise).unwrap();
        // The derivative is the last of the values.
        let over = |fitted: &FittedPlatform<'_>| {
            let last = fitted.values().len() - 1;
            shape.sigma.unwrap() / fitted.covariance()[(last, last)].sqrt()
        };
        // The likelihood is quadratic to a part in 300; over the noise of the search it is 2 to 10 % narrower.
        assert!((over(&restricted) - 1.0).abs() < 0.01, "{seed}: {shape:?}");
        assert!(over(&searched) > 1.02, "{seed}: {shape:?}");
    }
}

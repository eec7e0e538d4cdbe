//! White noise and random walks of the gyros, estimated from simulated records.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, PLATFORM, Run};
use gyrocal_hypothesis::{Column, ExtraColumns, ModelExtension};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

/// Two days with a random walk on gyro x, white noise of gyro y twice the declared one, and no other
/// drift.
fn simulation() -> Simulation {
    let hidden = |id: &str, name: &str, value: f64| Hidden::new(id, &[(name, value)]).unwrap();
    simulate(&Scenario {
        seed: 11,
        coefficients: Coefficients::NONE,
        initial: InitialAttitude::Random,
        duration_s: 2.0 * 86_400.0,
        interval_s: 60.0,
        hidden: vec![
            hidden("gyro_x.random_walk", "size", 5e-4),
            hidden("gyro_y.noise", "ratio", 2.0),
        ],
        ..Scenario::default()
    })
    .unwrap()
}

/// Two days of rows two minutes apart, with the declared noise alone.
fn two_days(seed: u64) -> Simulation {
    simulate(&Scenario {
        seed,
        duration_s: 2.0 * 86_400.0,
        interval_s: 120.0,
        initial: InitialAttitude::Random,
        ..Scenario::default()
    })
    .unwrap()
}

#[test]
fn noise_of_the_gyros_is_estimated_with_their_walks() {
    let simulation = simulation();
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let nominal =
        FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
    let white = nominal.fit_rate_noise(&[], &[]).unwrap();
    let walk = nominal.fit_rate_noise(&[0, 1, 2], &[]).unwrap();
    // Far beyond the 1e-4 point of a variance that may be zero.
    assert!(
        walk.log_likelihood - white.log_likelihood > 20.0,
        "{white:?} {walk:?}"
    );
    let off = |found: f64, truth: f64, sigma: f64| (found / truth).ln() / sigma;
    // Three standard deviations of the logarithms.
    assert!(
        off(walk.noise.walk[0], 5e-4, walk.walk_sigma[0]).abs() < 3.0,
        "{walk:?}"
    );
    assert!(
        off(walk.noise.white[1], 2.0, walk.white_sigma[1]).abs() < 3.0,
        "{walk:?}"
    );
    // The walk is no part of a fit that has it left out: nothing else has changed.
    let fitted = nominal.with_rate_noise(&walk.noise).unwrap();
    let again = fitted.fit_rate_noise(&[0, 1, 2], &[]).unwrap();
    let without = fitted.fit_rate_noise(&[], &[]).unwrap();
    // Other points of linearisation, and steps that end at a gain of 0.005.
    assert!(
        (again.log_likelihood - walk.log_likelihood).abs() < 0.5,
        "{again:?} {walk:?}"
    );
    assert!(
        (without.log_likelihood - white.log_likelihood).abs() < 0.5,
        "{without:?} {white:?}"
    );

    // With the walk the coefficients are within their standard deviations, of which the largest of
    // nine exceeds 4 in one of two thousand; without it they are not.
    let worst = |fit: &FittedPlatform<'_>| {
        let covariance = fit.covariance();
        let all = (0..9).map(|i| (fit.values()[i] / covariance[(i, i)].sqrt()).abs());
        all.fold(0.0, f64::max)
    };
    assert!(worst(&fitted) < 4.0, "{}", worst(&fitted));
    assert!(worst(&nominal) > 5.0, "{}", worst(&nominal));

    // A walk that two days determine well has nearly the interval of its standard deviation; the profile
    // of a variance is a little skew.
    let intervals = fitted.walk_intervals().unwrap();
    let [low, high] = intervals[0].unwrap();
    assert!(low < 5e-4 && 5e-4 < high, "{low} {high}");
    for (end, deviates) in [(low, -1.96), (high, 1.96)] {
        let expected = again.noise.walk[0] * (deviates * again.walk_sigma[0]).exp();
        assert!((end / expected - 1.0).abs() < 0.2, "{end} {expected}");
    }

    // The drift at the end of the record is the walk.
    let ends = fitted.walk_ends().unwrap();
    let truth = simulation.truth.drift_deg_per_h.last().unwrap();
    for end in &ends {
        let axis = end.parameter / 3;
        let bias = fitted.values()[end.parameter];
        let covariance = fitted.covariance();
        // The change follows from the values; both together have this variance.
        let mut derivative = end.by_values.clone();
        derivative[end.parameter] += 1.0;
        let mut variance = end.sigma.powi(2);
        for (i, a) in derivative.iter().enumerate() {
            for (j, b) in derivative.iter().enumerate() {
                variance += a * covariance[(i, j)] * b;
            }
        }
        let off = (bias + end.change - truth[axis]) / variance.sqrt();
        assert!(off.abs() < 4.0, "{axis}: {off} {end:?}");
    }
}

#[test]
fn an_effect_that_is_left_out_leaves_the_likelihood_of_the_nominal_model() {
    let simulation = simulation();
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let nominal =
        FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
    let place = nominal.values().len();
    let parameter = gyrocal::generated::catalogue::PARAMETERS
        .iter()
        .position(|element| element.id == "gyro_y.g_z")
        .unwrap();
    let extension = ModelExtension {
        parameters: vec![(parameter, f64::INFINITY)],
        ..ModelExtension::default()
    };
    let extended = nominal.refitted(&extension).unwrap();
    let before = nominal.fit_rate_noise(&[], &[]).unwrap();
    let with = extended.fit_rate_noise(&[], &[]).unwrap();
    let without = extended.fit_rate_noise(&[], &[place]).unwrap();
    assert!(with.log_likelihood > before.log_likelihood);
    // Other points of linearisation.
    assert!(
        (without.log_likelihood - before.log_likelihood).abs() < 0.1,
        "{without:?} {before:?}"
    );
}

#[test]
fn degrees_of_freedom_are_those_of_refitted_covariances() {
    let simulation = two_days(12);
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let declared =
        FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
    let noise = declared.fit_rate_noise(&[], &[]).unwrap();
    let fitted = declared.with_rate_noise(&noise.noise).unwrap();
    let white_sigma = fitted.fit_rate_noise(&[], &[]).unwrap().white_sigma;
    let degrees = fitted.degrees_of_freedom().unwrap();
    // Derivative of each variance by the logarithm of a gyro's variance, from fits with other noise.
    let step = 0.1_f64;
    let variances = |axis: usize, change: f64| -> Vec<f64> {
        let mut changed = fitted.rate_noise();
        changed.white[axis] *= (0.5 * change).exp();
        let refitted = fitted.with_rate_noise(&changed).unwrap();
        (0..9).map(|i| refitted.covariance()[(i, i)]).collect()
    };
    let mut of_variance = [0.0; 9];
    for (axis, sigma) in white_sigma.iter().enumerate() {
        let (low, high) = (variances(axis, -step), variances(axis, step));
        for (sum, (low, high)) in of_variance.iter_mut().zip(low.iter().zip(&high)) {
            // The logarithm of a variance has twice the standard deviation of that of its root.
            *sum += ((high - low) / (2.0 * step) * 2.0 * sigma).powi(2);
        }
    }
    for (i, of_variance) in of_variance.iter().enumerate() {
        let expected = 2.0 * fitted.covariance()[(i, i)].powi(2) / of_variance;
        // A row tells of two tilts: what one gyro has more of, the others have less. This correlation,
        // up to -0.5 (the sigma of y falls by 0.14 where the others are held), is left out here, so
        // that the sum is too large by up to a quarter. The curvature over a step is below 0.02.
        let ratio = degrees[i] / expected;
        assert!(
            ratio > 0.98 && ratio < 1.27,
            "{i}: {} {expected}",
            degrees[i]
        );
        assert!(
            degrees[i] > 5.0 && degrees[i] < 500.0,
            "{i}: {}",
            degrees[i]
        );
    }

    // A walk that the record hardly tells of: not fewer than three.
    let mut walking = fitted.rate_noise();
    walking.walk[0] = 1e-4;
    let degrees = fitted
        .with_rate_noise(&walking)
        .unwrap()
        .degrees_of_freedom()
        .unwrap();
    assert!(degrees.iter().all(|degrees| *degrees >= 3.0), "{degrees:?}");
}

#[test]
fn effects_take_no_degrees_off_the_restricted_noise() {
    /// Sections of the record, and the records.
    const SECTIONS: usize = 8;
    const RECORDS: u64 = 20;
    let mut logarithms = [0.0; 2];
    for seed in 0..RECORDS {
        let simulation = two_days(seed);
        let run = Run {
            record: &simulation.record,
            bench: &simulation.bench,
        };
        let nominal =
            FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default()).unwrap();
        // A bias of gyro x of its own in each section but the first.
        let steps = simulation.record.time_s.len() - 1;
        let section = |index: usize| Column::TimeProfile {
            parameter: PLATFORM.rates[0].constant,
            steps: (0..steps)
                .map(|step| f64::from(u8::from(step * SECTIONS / steps == index)))
                .collect(),
        };
        let extension = ModelExtension {
            columns: ExtraColumns::new((1..SECTIONS).map(section).collect()),
            ..ModelExtension::default()
        };
        let extended = nominal.refitted(&extension).unwrap();
        let noise = extended.fit_rate_noise(&[], &[]).unwrap().noise;
        let fitted = extended.with_rate_noise(&noise).unwrap();
        let restricted = fitted.restricted_noise().unwrap();
        logarithms[0] += noise.white[0].ln() / RECORDS as f64;
        logarithms[1] += restricted.white[0].ln() / RECORDS as f64;
    }
    // Some twenty degrees of freedom, of which seven biases take a third: half of ln(13/20) is -0.22. The
    // logarithm of the standard deviation from thirteen is low by 0.04, and scatters by 0.2, over the root of
    // twenty records. Three of its standard deviations.
    let [with_biases, restricted] = logarithms;
    assert!(
        (with_biases - restricted + 0.22).abs() < 0.135,
        "{with_biases}"
    );
    assert!((restricted + 0.04).abs() < 0.135, "{restricted}");
}

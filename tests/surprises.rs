//! Samples that disagree with the state: one wild sample or a burst of them costs next to nothing, a
//! prior that is wrong or a platform that was turned locks no sample out for good.
#![cfg(test)]

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::watch::{PlatformWatch, WatchSettings};
use gyrocal::{
    ControllerError, ControllerFilter, Drift, FilterSettings, InitialAttitude, Limits, SavedForm,
    SavedNumber, Site,
};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude as Declared, Scenario, simulate};

const INTERVAL_S: f64 = 60.0;
const DAY: usize = 1440;

fn scenario(days: f64, seed: u64) -> Scenario {
    Scenario {
        seed,
        duration_s: days * 86_400.0,
        coefficients: Coefficients {
            bias_deg_per_h: [0.3, -0.2, 0.1],
            ..Coefficients::NONE
        },
        ..Scenario::default()
    }
}

fn settings<T: SavedNumber>() -> FilterSettings<T> {
    FilterSettings::at_site(Site::at_latitude_deg(39.1))
}

fn started<T: SavedNumber, F: Form<T> + SavedForm>(limits: Limits<T>) -> ControllerFilter<T, F> {
    let mut filter = ControllerFilter::unset();
    let attitude = InitialAttitude::aligned();
    filter.start(&settings(), &attitude, limits).unwrap();
    filter
}

/// A declared attitude with a sigma of each angle, both in degrees.
fn declared<T: SavedNumber>(angles_deg: [f64; 3], sigma_deg: f64) -> InitialAttitude<T> {
    InitialAttitude::Angles {
        angles_rad: angles_deg.map(|angle| T::from_f64(angle.to_radians())),
        sigma_rad: [T::from_f64(sigma_deg.to_radians()); 3],
    }
}

fn saved<T: SavedNumber, F: Form<T> + SavedForm>(filter: &ControllerFilter<T, F>) -> Vec<u8> {
    let mut place = vec![0; ControllerFilter::<T, F>::SAVED_BYTES];
    filter.save(&mut place).unwrap();
    place
}

/// What a run answered.
#[derive(Default)]
struct Answers {
    surprising: usize,
    diverged: usize,
    /// The row of the last sample that was not taken.
    last: usize,
}

/// Runs a record as a controller would: it reopens where the answer is that the filter has diverged.
fn run<T: SavedNumber, F: Form<T> + SavedForm>(
    filter: &mut ControllerFilter<T, F>,
    samples: &[[f64; 3]],
) -> Answers {
    let mut answers = Answers::default();
    for (row, sample) in samples.iter().enumerate() {
        let sample = sample.map(T::from_f64);
        let answer = match row {
            0 => filter.update(&sample),
            _ => filter.step(T::from_f64(INTERVAL_S), &sample),
        };
        let Err(error) = answer else { continue };
        assert!(error.has_coasted() && !error.is_refusal(), "{error}");
        answers.surprising += 1;
        answers.last = row;
        if error == ControllerError::Diverged {
            answers.diverged += 1;
            filter.reopen(&sample).unwrap();
        }
    }
    answers
}

/// Largest difference of a coefficient in its sigma.
fn apart<T: SavedNumber, F: Form<T> + SavedForm>(
    filter: &ControllerFilter<T, F>,
    other: &ControllerFilter<T, F>,
) -> f64 {
    let numbers = filter.filter().drift().to_array().into_iter();
    let others = other.filter().drift().to_array().into_iter();
    let sigmas = other.filter().drift_sigma().to_array();
    let apart = numbers.zip(others).zip(sigmas);
    apart.fold(0.0, |most, ((value, other), sigma)| {
        ((value - other).abs() / sigma).to_f64().max(most)
    })
}

fn wild_samples_cost_little<T: SavedNumber, F: Form<T> + SavedForm>() {
    let sound = simulate(&scenario(3.0, 1)).unwrap().record.accel_g;
    let mut reference = started::<T, F>(Limits::default());
    assert_eq!(run(&mut reference, &sound).surprising, 0);
    let sideways = [0.02, 0.02, 0.99];
    let shock = [1.9, -1.9, 1.9];
    let cases: [(&str, Vec<usize>, [f64; 3]); 5] = [
        ("one", vec![2 * DAY], sideways),
        ("ten", (0..10).map(|i| DAY + 137 * i).collect(), sideways),
        ("ten in a row", (2 * DAY..2 * DAY + 10).collect(), shock),
        ("a burst at the start", (0..5).collect(), shock),
        ("ten at the start", (0..10).collect(), sideways),
    ];
    for (name, rows, wild) in cases {
        let mut samples = sound.clone();
        for row in &rows {
            samples[*row] = wild;
        }
        let mut filter = started::<T, F>(Limits::default());
        let answers = run(&mut filter, &samples);
        let off = apart(&filter, &reference);
        println!("{name}: {off:.3} sigma, {} not taken", answers.surprising);
        assert_eq!(answers.surprising, rows.len(), "{name}");
        assert_eq!(filter.surprising_samples() as usize, rows.len(), "{name}");
        assert_eq!(answers.diverged, 0, "{name}");
        // A lost sample is information that the record without the wild one has: the whole of the ten is a
        // four-hundredth of it. Those at the start hold the attitude there.
        assert!(off < 0.5, "{name}: {off} sigma");
    }
}

#[test]
fn wild_samples_and_bursts_cost_less_than_half_a_sigma() {
    wild_samples_cost_little::<f64, Covariance>();
    wild_samples_cost_little::<f64, Factors>();
    wild_samples_cost_little::<f32, Factors>();
}

/// Largest error of a coefficient, in its sigma, of some platforms whose first sample comes after a gap.
fn worst_after_gap<T: SavedNumber, F: Form<T> + SavedForm>(
    minutes: usize,
) -> Result<f64, ControllerError> {
    let mut worst = 0.0_f64;
    for seed in 1..=6_u64 {
        // Coefficients all over the prior of 1 deg/h.
        let part = |k: u64| ((seed * 7919 + k * 104_729) % 2001) as f64 / 1000.0 - 1.0;
        let three = |from| core::array::from_fn(|gyro| part(from + gyro as u64));
        let scenario = Scenario {
            initial: Declared::Random,
            coefficients: Coefficients {
                bias_deg_per_h: three(1),
                g_deg_per_h_per_g: three(4),
                gg_deg_per_h_per_g2: three(7),
            },
            ..scenario(1.0 + minutes as f64 / DAY as f64, seed)
        };
        let samples = simulate(&scenario).unwrap().record.accel_g;
        let angles = scenario.declared_angles_deg();
        let mut filter = ControllerFilter::<T, F>::unset();
        let attitude = declared(angles, 0.01);
        filter
            .start(&settings(), &attitude, Limits::default())
            .unwrap();
        for _ in 0..minutes {
            filter.coast(T::from_f64(INTERVAL_S)).unwrap();
        }
        filter.update(&samples[minutes].map(T::from_f64))?;
        for sample in &samples[minutes + 1..] {
            filter.step(T::from_f64(INTERVAL_S), &sample.map(T::from_f64))?;
        }
        let drift = filter.filter().drift().to_array();
        let sigma = filter.filter().drift_sigma().to_array();
        for gyro in 0..3 {
            let Coefficients {
                bias_deg_per_h,
                g_deg_per_h_per_g,
                gg_deg_per_h_per_g2,
            } = scenario.coefficients;
            let truth = [bias_deg_per_h, g_deg_per_h_per_g, gg_deg_per_h_per_g2];
            for (term, truth) in truth.iter().enumerate() {
                let at = 3 * gyro + term;
                let error = (drift[at].to_f64() - truth[gyro]).abs() / sigma[at].to_f64();
                worst = worst.max(error);
            }
        }
    }
    Ok(worst)
}

#[test]
fn a_gap_at_the_start_is_bridged_or_refused() {
    for minutes in [0, 10, 30, 60, 90] {
        let worst = [
            worst_after_gap::<f64, Covariance>(minutes),
            worst_after_gap::<f64, Factors>(minutes),
            worst_after_gap::<f32, Factors>(minutes),
        ];
        println!("{minutes} min: {worst:.2?} sigma");
        for worst in worst {
            // Of 54 normal numbers one is beyond four in 300 sets.
            assert!(worst.is_ok_and(|worst| worst < 4.0), "{minutes} min");
        }
    }
    let refused = worst_after_gap::<f64, Factors>(12 * 60);
    assert_eq!(refused, Err(ControllerError::GapAtStart));
}

#[test]
fn a_sound_record_has_the_bits_of_a_filter_without_the_limit() {
    let samples = simulate(&scenario(3.0, 7)).unwrap().record.accel_g;
    let mut filter = started::<f64, Covariance>(Limits::default());
    let unlimited = Limits {
        largest_nis: f64::INFINITY,
        ..Limits::default()
    };
    let mut other = started::<f64, Covariance>(unlimited);
    assert_eq!(run(&mut filter, &samples).surprising, 0);
    run(&mut other, &samples);
    assert_eq!(saved(&filter), saved(&other));
    // The limit is positive.
    for largest_nis in [0.0, -1.0, f64::NAN] {
        let limits = Limits {
            largest_nis,
            ..Limits::default()
        };
        let answer = filter.start(&settings(), &InitialAttitude::aligned(), limits);
        assert!(matches!(answer, Err(ControllerError::Settings(_))));
    }
}

#[test]
fn a_surprising_sample_leaves_what_coasting_does() {
    let samples = simulate(&scenario(0.5, 3)).unwrap().record.accel_g;
    let mut filter = started::<f32, Factors>(Limits::default());
    run(&mut filter, &samples);
    let mut coasted = filter.clone();
    let answer = filter.step(60.0, &[0.02, 0.02, 0.99]);
    assert_eq!(
        answer.map(|innovation| innovation.nis),
        Err(ControllerError::SampleSurprising)
    );
    coasted.coast(60.0).unwrap();
    assert_eq!(saved(&filter), saved(&coasted));
    assert_eq!(filter.surprising_samples(), 1);
    let mut unlimited = started::<f32, Factors>(Limits {
        largest_nis: f32::INFINITY,
        ..Limits::default()
    });
    unlimited.restore(&saved(&coasted)).unwrap();
    // An hour of them, and a saved state has no memory of them.
    for minute in 2..=60 {
        let error = filter.step(60.0, &[0.02, 0.02, 0.99]).unwrap_err();
        let expected = match minute {
            60 => ControllerError::Diverged,
            _ => ControllerError::SampleSurprising,
        };
        assert_eq!(error, expected, "{minute}");
    }
    assert!(filter.is_running());
    filter.restore(&saved(&coasted)).unwrap();
    let error = filter.step(60.0, &[0.02, 0.02, 0.99]).unwrap_err();
    assert_eq!(error, ControllerError::SampleSurprising);
    unlimited.step(60.0, &[0.02, 0.02, 0.99]).unwrap();
}

#[test]
fn a_prior_that_is_too_tight_by_ten_sigmas_locks_nothing_out() {
    let rows = DAY / 2;
    let (mut locked_out, mut latest) = (0, 0);
    for case in 0..1000_usize {
        let scenario = Scenario {
            initial: Declared::Random,
            coefficients: Coefficients::NONE,
            ..scenario(0.5, case as u64 + 1)
        };
        let samples = simulate(&scenario).unwrap().record.accel_g;
        // One number is off by ten of its sigmas: an angle, or a coefficient.
        let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
        let (mut angles, mut drift) = (scenario.declared_angles_deg(), [0.0; 9]);
        match case % 12 {
            axis @ 0..3 => angles[axis] += 0.1 * sign,
            other => drift[other - 3] = sign,
        }
        let settings = FilterSettings {
            drift: Drift::from_array(drift),
            drift_sigma: Drift::from_array([0.1; 9]),
            ..settings()
        };
        let mut filter = ControllerFilter::<f64>::unset();
        let attitude = declared(angles, 0.01);
        filter
            .start(&settings, &attitude, Limits::default())
            .unwrap();
        let answers = run(&mut filter, &samples);
        latest = latest.max(answers.last);
        locked_out += usize::from(answers.last + 60 > rows);
    }
    println!("{locked_out} of 1000 locked out; the last sample that was not taken is row {latest}");
    assert_eq!(locked_out, 0);
}

#[test]
fn a_filter_that_has_diverged_is_reopened() {
    // The platform is turned by two degrees in the third day.
    let knock = [
        ("x_deg", 2.0),
        ("y_deg", -1.0),
        ("z_deg", 1.0),
        ("onset_s", 216_000.0),
    ];
    let scenario = Scenario {
        hidden: vec![Hidden::new("platform.knock", &knock).unwrap()],
        ..scenario(6.0, 5)
    };
    let samples = simulate(&scenario).unwrap().record.accel_g;
    let mut filter = started::<f64, Covariance>(Limits::default());
    let answers = run(&mut filter, &samples);
    let drift = filter.filter().drift().to_array();
    let sigma = filter.filter().drift_sigma().to_array();
    let [x, y, z] = scenario.coefficients.bias_deg_per_h;
    let truth = [x, 0.0, 0.0, y, 0.0, 0.0, z, 0.0, 0.0];
    let off = drift.iter().zip(truth).zip(sigma);
    let off = off.fold(0.0_f64, |most, ((found, truth), sigma)| {
        most.max((found - truth).abs() / sigma)
    });
    println!(
        "{} not taken, {} times reopened, the last at row {}: {off:.2} sigma",
        answers.surprising, answers.diverged, answers.last
    );
    assert!(answers.diverged >= 1 && answers.last < 3600 + DAY);
    assert!(off < 4.0, "{off} sigma");
}

fn watched<T: SavedNumber>() -> PlatformWatch<T> {
    let mut watched = PlatformWatch::default();
    let attitude = InitialAttitude::aligned();
    let (limits, watch) = (Limits::default(), WatchSettings::default());
    watched
        .start(&settings(), &attitude, limits, &watch)
        .unwrap();
    watched
}

/// Runs a record; gives the coefficients, the number of alarms, and whether one was of a jump.
fn watch<T: SavedNumber>(
    watched: &mut PlatformWatch<T>,
    samples: &[[f64; 3]],
) -> ([T; 9], usize, bool) {
    let (mut alarms, mut jumped) = (0, false);
    for (row, sample) in samples.iter().enumerate() {
        let sample = sample.map(T::from_f64);
        let answer = match row {
            0 => watched.update(&sample).map(|_| ()),
            _ => watched.step(T::from_f64(INTERVAL_S), &sample).map(|_| ()),
        };
        assert!(answer.is_ok_and(|()| true) || answer.is_err_and(|error| error.has_coasted()));
        let alarm = watched.alarm().filter(|_| row > 0);
        alarms += usize::from(alarm.is_some());
        if alarm.is_some() {
            watched.candidates(|effect, _| jumped |= effect.is_none());
            watched.go_on();
        }
    }
    (watched.filter().drift().to_array(), alarms, jumped)
}

#[test]
fn a_watched_filter_passes_wild_samples_over_and_its_watch_sees_a_jump() {
    let sound = simulate(&scenario(3.0, 1)).unwrap().record.accel_g;
    let mut reference = watched::<f64>();
    let (drift, alarms, _) = watch(&mut reference, &sound);
    assert_eq!((alarms, reference.surprising_samples()), (0, 0));
    let sigma = reference.filter().drift_sigma().to_array();
    let mut samples = sound.clone();
    for row in (0..10).map(|i| DAY + 137 * i).chain(0..5) {
        samples[row] = [0.02, 0.02, 0.99];
    }
    let mut filter = watched::<f64>();
    let (found, alarms, _) = watch(&mut filter, &samples);
    assert_eq!((alarms, filter.surprising_samples()), (0, 15));
    let off = found.iter().zip(drift).zip(sigma);
    let off = off.fold(0.0_f64, |most, ((found, drift), sigma)| {
        most.max((found - drift).abs() / sigma)
    });
    println!("{off:.3} sigma");
    assert!(off < 0.5, "{off} sigma");
    // A jump makes all samples after it surprising: the filter takes none, and the watch names it.
    let knock = [
        ("x_deg", 0.1),
        ("y_deg", 0.0),
        ("z_deg", 0.0),
        ("onset_s", 216_000.0),
    ];
    let scenario = Scenario {
        hidden: vec![Hidden::new("platform.knock", &knock).unwrap()],
        ..scenario(2.6, 1)
    };
    let samples = simulate(&scenario).unwrap().record.accel_g;
    let mut filter = watched::<f64>();
    let (_, alarms, jumped) = watch(&mut filter, &samples);
    assert!(alarms > 0 && jumped && filter.surprising_samples() > 0);
}

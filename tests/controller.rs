//! The filter of a controller: refusals leave it as it was, a saved state continues bit by bit, and
//! single precision follows double.
#![cfg(test)]

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::{
    ControllerError, ControllerFilter, Discretisation, FilterSettings, InitialAttitude, Limits,
    SavedForm, SavedNumber, Site,
};
use gyrocal_truth::{Scenario, simulate};

const INTERVAL_S: f64 = 60.0;

fn samples(days: f64) -> Vec<[f64; 3]> {
    let scenario = Scenario {
        duration_s: days * 86_400.0,
        ..Scenario::default()
    };
    // The first one belongs to the start.
    simulate(&scenario).unwrap().record.accel_g[1..].to_vec()
}

fn settings<T: SavedNumber>() -> FilterSettings<T> {
    FilterSettings::at_site(Site::at_latitude_deg(39.1))
}

fn started<T: SavedNumber, F: Form<T> + SavedForm>() -> ControllerFilter<T, F> {
    let mut filter = ControllerFilter::unset();
    filter
        .start(&settings(), &InitialAttitude::aligned(), Limits::default())
        .unwrap();
    filter
}

fn saved<T: SavedNumber, F: Form<T> + SavedForm>(filter: &ControllerFilter<T, F>) -> Vec<u8> {
    let mut place = vec![0; ControllerFilter::<T, F>::SAVED_BYTES];
    filter.save(&mut place).unwrap();
    place
}

fn run<T: SavedNumber, F: Form<T> + SavedForm>(
    filter: &mut ControllerFilter<T, F>,
    samples: &[[f64; 3]],
) {
    for sample in samples {
        let sample = sample.map(T::from_f64);
        filter.step(T::from_f64(INTERVAL_S), &sample).unwrap();
    }
}

fn a_saved_state_continues<T: SavedNumber, F: Form<T> + SavedForm>() {
    // Past a renormalisation of the chart, which counts turns.
    let samples = samples(0.2);
    let (before, after) = samples.split_at(100);
    let mut whole = started::<T, F>();
    run(&mut whole, before);
    let kept = saved(&whole);
    run(&mut whole, after);
    let mut restored = started::<T, F>();
    run(&mut restored, &before[..7]);
    restored.restore(&kept).unwrap();
    assert_eq!(saved(&restored), kept);
    run(&mut restored, after);
    assert_eq!(saved(&restored), saved(&whole));
}

#[test]
fn a_saved_state_continues_bit_by_bit() {
    a_saved_state_continues::<f32, Factors>();
    a_saved_state_continues::<f64, Factors>();
    a_saved_state_continues::<f64, Covariance>();
}

#[test]
fn a_saved_state_belongs_to_its_numbers_and_form() {
    let factors = saved(&started::<f64, Factors>());
    let mut other = started::<f64, Covariance>();
    assert_eq!(other.restore(&factors), Err(ControllerError::SavedVersion));
    let expected = ControllerFilter::<f32>::SAVED_BYTES;
    assert_eq!(
        started::<f32, Factors>().restore(&factors),
        Err(ControllerError::SavedLength { expected })
    );
}

#[test]
fn every_flipped_bit_of_a_saved_state_is_found() {
    let mut filter = started::<f32, Factors>();
    run(&mut filter, &samples(0.05));
    let kept = saved(&filter);
    for byte in 0..kept.len() {
        let mut flipped = kept.clone();
        flipped[byte] ^= 1 << (byte % 8);
        let error = filter.restore(&flipped).unwrap_err();
        let expected = [
            ControllerError::SavedVersion,
            ControllerError::SavedChecksum,
        ];
        assert!(expected.contains(&error), "byte {byte}: {error:?}");
        assert_eq!(saved(&filter), kept, "byte {byte}");
    }
}

#[test]
fn refusals_leave_the_filter_as_it_was() {
    let mut filter = started::<f32, Factors>();
    let samples = samples(0.1);
    run(&mut filter, &samples[..72]);
    let before = saved(&filter);
    let good = [0.0, 0.0, 1.0];
    let not_finite = |axis| ControllerError::SampleNotFinite { axis };
    for (interval_s, sample, expected) in [
        (60.0, [f32::NAN, 0.0, 1.0], not_finite(0)),
        (60.0, [0.0, f32::INFINITY, 1.0], not_finite(1)),
        (
            60.0,
            [0.0, 0.0, -2.1],
            ControllerError::SampleOutOfRange { axis: 2 },
        ),
        (0.0, good, ControllerError::IntervalNotPositive),
        (-1.0, good, ControllerError::IntervalNotPositive),
        (f32::NAN, good, ControllerError::IntervalNotPositive),
        (3601.0, good, ControllerError::IntervalTooLong),
        (f32::INFINITY, good, ControllerError::IntervalTooLong),
    ] {
        let error = filter.step(interval_s, &sample).unwrap_err();
        assert_eq!(error, expected);
        assert!(error.is_refusal() && filter.is_running());
        assert_eq!(saved(&filter), before);
    }
    filter.coast(60.0).unwrap();
    run(&mut filter, &samples[73..]);
    let unlimited = Limits {
        longest_interval_s: f32::INFINITY,
        ..Limits::default()
    };
    filter
        .start(&settings(), &InitialAttitude::aligned(), unlimited)
        .unwrap();
    assert_eq!(filter.coast(1e30), Err(ControllerError::IntervalTooLong));
    assert!(filter.is_running());
}

#[test]
fn settings_without_meaning_are_refused() {
    let mut filter = ControllerFilter::<f32>::unset();
    let aligned = InitialAttitude::aligned();
    type Change = fn(&mut FilterSettings<f32>);
    let changes: [(&str, Change); 11] = [
        ("latitude", |of| of.site.latitude_rad = 1e30),
        ("latitude", |of| of.site.latitude_rad = f32::NAN),
        ("latitude", |of| of.site.latitude_rad = -1.6),
        ("Earth", |of| of.site.earth_rate_rad_per_s = f32::INFINITY),
        ("gravity", |of| of.site.gravity_g = 0.0),
        ("coefficients", |of| of.drift.gyro_y_bias = f32::NAN),
        ("sigmas", |of| of.drift_sigma.gyro_z_bias = f32::INFINITY),
        ("sigmas", |of| of.drift_sigma.gyro_z_bias = 1e-30),
        ("noise", |of| of.accel_noise_g = f32::INFINITY),
        ("noise", |of| of.drift_noise_deg_per_h = -0.002),
        ("step", |of| of.discretisation.longest_step_s = f32::NAN),
    ];
    for (named, change) in changes {
        let mut bad = settings();
        change(&mut bad);
        let error = filter.start(&bad, &aligned, Limits::default()).unwrap_err();
        assert!(error.to_string().contains(named), "{error}");
        assert!(!filter.is_running());
    }
    for (angle, sigma) in [(f32::NAN, 1e-4), (0.0, 0.0), (0.0, f32::INFINITY)] {
        let attitude = InitialAttitude::Angles {
            angles_rad: [0.0, angle, 0.0],
            sigma_rad: [1e-4, sigma, 1e-4],
        };
        let error = filter.start(&settings(), &attitude, Limits::default());
        assert!(error.unwrap_err().to_string().contains("attitude"));
    }
    // The poles have a meaning, rounded up.
    let mut pole = settings();
    pole.site.latitude_rad = core::f32::consts::FRAC_PI_2;
    filter.start(&pole, &aligned, Limits::default()).unwrap();
}

#[test]
fn a_filter_that_is_not_running_says_so() {
    let mut filter = ControllerFilter::<f32>::unset();
    let not_running = Err(ControllerError::NotRunning);
    assert_eq!(filter.coast(60.0), not_running);
    assert_eq!(filter.update(&[0.0, 0.0, 1.0]).map(|_| ()), not_running);
    let kept = saved(&started::<f32, Factors>());
    assert_eq!(filter.restore(&kept), not_running);
    // A chart of its own would not move; the code for it is not there.
    let mut fixed = settings();
    fixed.discretisation = Discretisation::paper_baseline();
    let error = filter
        .start(&fixed, &InitialAttitude::aligned(), Limits::default())
        .unwrap_err();
    assert!(matches!(error, ControllerError::Settings(_)), "{error}");
    assert_eq!(filter.restore(&kept), not_running);
}

#[test]
fn a_filter_that_failed_runs_again_from_a_saved_state() {
    let mut filter = started::<f32, Factors>();
    run(&mut filter, &samples(0.05));
    let kept = saved(&filter);
    let mut absurd = settings();
    absurd.drift.gyro_x_bias = f32::MAX;
    filter.reset(&absurd, &InitialAttitude::aligned()).unwrap();
    let error = filter.coast(60.0).unwrap_err();
    assert!(matches!(error, ControllerError::Failed(_)), "{error}");
    assert_eq!(filter.coast(60.0), Err(ControllerError::NotRunning));
    filter
        .reset(&settings(), &InitialAttitude::aligned())
        .unwrap();
    filter.restore(&kept).unwrap();
    filter.coast(60.0).unwrap();
}

#[test]
fn single_precision_follows_double() {
    let samples = samples(3.0);
    let (mut single, mut double) = (started::<f32, Factors>(), started::<f64, Covariance>());
    run(&mut single, &samples);
    run(&mut double, &samples);
    let (single, double) = (single.filter(), double.filter());
    let numbers = single.drift().to_array().into_iter();
    let others = double.drift().to_array().into_iter();
    let sigmas = double.drift_sigma().to_array();
    for ((value, reference), sigma) in numbers.zip(others).zip(sigmas) {
        // The target of `cargo figures embedded --part controller`, over random records and five days.
        let apart = (f64::from(value) - reference).abs() / sigma;
        assert!(apart < 0.1, "{value} and {reference}: {apart} sigma");
    }
}

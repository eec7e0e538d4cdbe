//! The generated model against the independent simulator `gyrocal-truth`, which carries one
//! quaternion against inertial space and knows no Euler angle, no chart and no generated code.
#![cfg(test)]

use gyrocal::scalar::Model;
use gyrocal::{
    Anchored, Drift, FilterSettings, InitialAttitude, Integration, Platform, PlatformFilter, Site,
};
use gyrocal_truth::{Attitude, Coefficients, Population};

const STEP_S: f64 = 60.0;
const DAY_S: f64 = 86_400.0;
/// Five days.
const STEPS: usize = 7200;

/// Largest difference between the samples of the model and those of the simulator.
///
/// A sample of the noise is 1e-5 g, and the main job is judged at 1e-4 of that. A Runge-Kutta
/// step of 60 s turns the platform by 4.4e-3 rad, of which the fifth power over 5! is 1.4e-14:
/// even if all 7200 steps erred alike, that is 1e-10.
const TOLERANCE_G: f64 = 1e-9;

fn minutes() -> Vec<f64> {
    (0..=STEPS).map(|step| step as f64 * STEP_S).collect()
}

fn drift_of(coefficients: &Coefficients) -> Drift<f64> {
    Drift::from_array(coefficients.named().map(|(_, value, _)| value))
}

/// A filter with the true state of the platform.
fn settings_of(platform: &gyrocal_truth::Platform) -> FilterSettings<f64> {
    let site = Site {
        gravity_g: platform.specific_force_at_rest_g,
        ..Site::at_latitude_deg(platform.latitude_deg)
    };
    FilterSettings {
        drift: drift_of(&platform.coefficients),
        drift_sigma: Drift::from_array([1e-9; Platform::PARAMETERS]),
        ..FilterSettings::at_site(site)
    }
}

/// The largest difference of a sample over five days, and when.
///
/// The filter has no measurement update, so its states follow the generated rates. Its samples are
/// computed twice: from its attitude, and by the generated output in its chart.
fn worst(platform: &gyrocal_truth::Platform, settings: &FilterSettings<f64>) -> (f64, usize) {
    let gravity_g = settings.site.gravity_g;
    let attitude = InitialAttitude::Angles {
        angles_rad: platform.initial_platform_c_enu.angles_rad(),
        sigma_rad: [1e-9; 3],
    };
    let mut filter = PlatformFilter::new(settings, &attitude).unwrap();
    let mut worst = (0.0, 0);
    let truth = platform.specific_force_g(&minutes());
    for (step, expected) in truth.iter().enumerate() {
        if step > 0 {
            filter.predict(STEP_S).unwrap();
        }
        let up = filter.platform_c_enu().map(|row| row[2] * gravity_g);
        let kernel = filter.kernel();
        let (moving, parameters) = kernel.state().split_first_chunk().unwrap();
        let output = Anchored(Platform).output(moving, parameters, kernel.inputs());
        for axis in 0..3 {
            for measured in [up[axis], output[axis]] {
                // NaN must not pass for small.
                let difference = (measured - expected[axis]).abs();
                if difference.is_nan() || difference > worst.0 {
                    worst = (difference, step);
                }
            }
        }
    }
    worst
}

fn check(what: &str, platform: &gyrocal_truth::Platform) {
    let (difference, step) = worst(platform, &settings_of(platform));
    println!("{what}: {difference:.1e} g at step {step}");
    assert!(
        difference < TOLERANCE_G,
        "{what}: {difference:e} g at step {step}"
    );
}

fn aligned() -> gyrocal_truth::Platform {
    gyrocal_truth::Platform {
        latitude_deg: 39.1,
        specific_force_at_rest_g: 1.0,
        coefficients: Coefficients::PAPER_LIKE,
        initial_platform_c_enu: Attitude::IDENTITY,
    }
}

#[test]
fn the_model_follows_the_truth_past_gimbal_lock() {
    let platform = aligned();
    // The platform passes half a degree from the pole on the fourth day.
    let attitudes = platform.platform_c_enu(&minutes());
    let (from_pole_deg, step) = attitudes
        .iter()
        .map(|attitude| 90.0 - attitude.angles_deg()[1].abs())
        .zip(0..)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap();
    let day = f64::from(step) * STEP_S / DAY_S;
    assert!(from_pole_deg < 0.6, "{from_pole_deg} deg on day {day}");
    assert!(
        (3.0..4.0).contains(&day),
        "{from_pole_deg} deg on day {day}"
    );
    check("aligned at 39.1 deg", &platform);
}

#[test]
fn the_model_follows_the_truth_from_any_attitude_at_any_latitude() {
    let population = Population::new(2);
    let mut hemispheres = [0; 2];
    for number in 0..12 {
        let mut platform = population.scenario(number).platform();
        // Every third record is in a unit that is not local gravity, by 0.3 %.
        if number % 3 == 2 {
            platform.specific_force_at_rest_g = 0.997;
        }
        hemispheres[usize::from(platform.latitude_deg > 0.0)] += 1;
        let what = format!("scenario {number} at {:.1} deg", platform.latitude_deg);
        check(&what, &platform);
    }
    assert!(
        hemispheres.iter().all(|count| *count >= 3),
        "{hemispheres:?}"
    );
}

/// Power of the tests above: small errors of the inputs of the model, and a coarser integration
/// rule, are detected.
#[test]
fn a_slightly_wrong_model_does_not_follow() {
    let platform = aligned();
    let exact = settings_of(&platform);
    let mut drift = exact;
    drift.drift.gyro_x_bias *= 1.0 + 1e-6;
    let mut latitude = exact;
    latitude.site.latitude_rad += 1e-7;
    let mut rule = exact;
    rule.discretisation.integration = Integration::Euler { substeps: 64 };
    for wrong in [drift, latitude, rule] {
        let (difference, _) = worst(&platform, &wrong);
        assert!(difference > 10.0 * TOLERANCE_G, "{difference:e}");
    }
}

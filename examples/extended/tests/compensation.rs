//! Gain of the extended filter on a later record of the platform with the fault.
#![cfg(test)]

use gyrocal::{FilterSettings, InitialAttitude, PlatformFilter, Site};
use gyrocal_extended::controller;
use gyrocal_truth::{Scenario, simulate};

const FAULT: &str = include_str!("../fault.scenario.toml");
const STEP_S: f64 = 60.0;
/// Three days of samples; the fourth goes without.
const LEARNING_ROWS: usize = 3 * 1440 + 1;

#[test]
fn a_day_without_samples_is_predicted_to_a_tenth_of_the_nominal_error() {
    let mut scenario = Scenario::parse(FAULT, "fault.scenario.toml").unwrap();
    // Not the record that the model file is from.
    scenario.seed += 1;
    let record = simulate(&scenario).unwrap().record;
    let bench = scenario.bench();
    let settings = FilterSettings::at_site(Site::at_latitude_deg(bench.latitude_deg));
    let attitude = InitialAttitude::Angles {
        angles_rad: bench.initial_angles_deg.unwrap().map(f64::to_radians),
        sigma_rad: bench.initial_angles_sigma_deg.map(f64::to_radians),
    };
    let mut nominal = PlatformFilter::new(&settings, &attitude).unwrap();
    let mut extended = controller(&settings, &attitude).unwrap();
    let (mut of_nominal, mut of_extended) = (0.0, 0.0);
    for (row, sample) in record.accel_g.iter().enumerate() {
        if row == 0 {
            nominal.update(sample).unwrap();
            extended.take(0.0, sample).unwrap();
        } else if row < LEARNING_ROWS {
            nominal.step(STEP_S, sample).unwrap();
            extended.take(STEP_S, sample).unwrap();
        } else {
            nominal.predict(STEP_S).unwrap();
            extended.coast(STEP_S).unwrap();
            let [_, up] = nominal.kernel().inputs().orientation();
            of_nominal += squared_distance(&up, sample);
            of_extended += squared_distance(&extended.expected_g(), sample);
        }
    }
    // The fault is 300 sigmas of one record; the error of the extended filter is noise and the
    // uncertainty of ten coefficients after four days.
    assert!(
        of_extended.sqrt() < 0.1 * of_nominal.sqrt(),
        "{of_extended:e} {of_nominal:e}"
    );
}

fn squared_distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

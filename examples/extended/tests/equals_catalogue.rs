//! The filter on the extended model is that on the model with every effect of the catalogue.

#![cfg(test)]

use gyrocal::Drift;
use gyrocal_extended::controller;
use gyrocal_extended::extended::START;
use gyrocal_testkit::extended_comparison::{after_one_step, after_three_days, attitude, settings};

#[test]
fn one_step_from_one_state_is_the_same() {
    let [state, sigma] = after_one_step();
    // The same operations but for terms that are zero: some roundings of 1e-16.
    assert!(state < 1e-9, "{state:e}");
    assert!(sigma < 1e-9, "{sigma:e}");
}

#[test]
fn three_days_are_the_same() {
    let [state, sigma] = after_three_days();
    // Rounding of this form of the covariance is 1e-7 of a sigma in 300 steps.
    assert!(state < 1e-5, "{state:e}");
    assert!(sigma < 1e-5, "{sigma:e}");
}

#[test]
fn the_drift_that_is_compensated_is_that_of_the_equations() {
    let drift = [0.41, -0.13, 0.04, -0.29, 0.21, -0.07, 0.15, 0.09, 0.02];
    let settings = settings(Drift::from_array(drift));
    let controller = controller(&settings, &attitude([0.4, -0.6, 1.1])).unwrap();
    let a = [0.3_f64, -0.5, 0.8];
    let mut expected: [f64; 3] =
        std::array::from_fn(|i| drift[3 * i] + a[i] * (drift[3 * i + 1] + a[i] * drift[3 * i + 2]));
    expected[1] += START[0].value * a[2];
    for (given, expected) in controller.drift_deg_per_h(&a).iter().zip(expected) {
        // Rates of 1e-6 rad/s, a few roundings of 1e-16.
        assert!((given - expected).abs() < 1e-13, "{given} {expected}");
    }
}

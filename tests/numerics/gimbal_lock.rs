use std::f64::consts::FRAC_PI_2;

use gyrocal::estimation::{ArrayStorage, Filter};
use gyrocal::{Anchored, Integration, Platform, Recentring};

use crate::truth::{DENSITY, STEP_S, Truth, VARIANCE, chart};

/// Euler angles as states in one chart, started on and around the singularity. The result may be
/// huge or an error, but the state must not contain NaN.
#[test]
fn near_gimbal_lock_numbers_are_huge_or_refused_but_never_nan() {
    let mut sigma = [1.0; Platform::STATES];
    sigma[..3].fill(2e-4);
    let distances = [1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0];
    for integration in [Integration::EULER, Integration::RK4] {
        let mut largest = 0.0_f64;
        for distance in distances
            .iter()
            .flat_map(|distance| [*distance, -*distance])
        {
            let mut state = [0.0; Platform::STATES];
            state[1] = FRAC_PI_2 - distance;
            let mut truth = Truth::at([state[0], state[1], state[2]], 13);
            let storage = ArrayStorage::<f64, 3, 3, 12>::new();
            let (model, chart) = (Anchored(Platform), chart());
            let mut filter = Filter::new(
                model,
                chart,
                integration,
                Recentring::Never,
                storage,
                &state,
                &sigma,
            )
            .unwrap();
            for step in 0..50 {
                let sample = truth.sample();
                let result = filter
                    .predict(STEP_S, &DENSITY)
                    .and_then(|()| filter.update(&sample, &VARIANCE).map(|_| ()));
                let state = filter.state();
                largest = state
                    .iter()
                    .fold(largest, |largest, state| largest.max(state.abs()));
                assert!(
                    state.iter().all(|state| !state.is_nan()),
                    "{integration:?}, {distance:e} rad, step {step}, {result:?}: {state:?}"
                );
                if result.is_err() {
                    break;
                }
                assert!(
                    (0..Platform::STATES).all(|i| !filter.covariance(i, i).is_nan()),
                    "{integration:?}, {distance:e} rad, step {step}: a variance is NaN"
                );
            }
        }
        // An Earth rate of 7e-5 rad/s over 60 s, divided by a cosine of 1e-16.
        assert!(largest > 1e9, "{integration:?}: the singularity was missed");
    }
}

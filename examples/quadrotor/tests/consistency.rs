//! Over many flights the errors of the filter are what it says of them.
#![cfg(test)]

use gyrocal_example_quadrotor::simulation::{Hover, STEP_S};
use gyrocal_example_quadrotor::{GYROS, SENSORS, filter};

const FLIGHTS: u64 = 40;
const STEPS: usize = 1000;

#[test]
fn errors_are_as_large_as_the_filter_says() {
    let mut nis = 0.0;
    let mut squares = [0.0; 6];
    for seed in 0..FLIGHTS {
        let mut plant = Hover::new(seed);
        let mut filter = filter().unwrap();
        for _ in 0..STEPS {
            let (omega, sample) = plant.step();
            filter.inputs_mut().omega = omega;
            filter.predict(STEP_S, &GYROS).unwrap();
            nis += filter.update(&sample, &SENSORS).unwrap().nis;
        }
        let [roll, pitch, yaw] = plant.angles_rad();
        let [x, y, z] = plant.bias;
        let truth = [roll, pitch, yaw, x, y, z];
        for (i, square) in squares.iter_mut().enumerate() {
            *square += ((filter.state()[i] - truth[i]) / filter.sigma(i)).powi(2);
        }
    }
    // Chi-square with 6 degrees of freedom a step: its mean has a sigma of sqrt(12 / steps) = 0.017.
    // Five of them, and one for what linearisation leaves.
    let nis = nis / (FLIGHTS as usize * STEPS) as f64;
    assert!((nis - 6.0).abs() < 0.1, "mean NIS {nis}, expected 6");
    // Chi-square with 40 degrees of freedom lies between 14 and 87 in all but 1e-5 of cases.
    for (i, square) in squares.into_iter().enumerate() {
        assert!(
            (14.0..87.0).contains(&square),
            "state {i}: {square} over {FLIGHTS} flights"
        );
    }
}

//! Over many carts the errors of the filter are what it says of them.
#![cfg(test)]

use gyrocal_example_cart_pole::simulation::{CartAndPole, STEP_S};
use gyrocal_example_cart_pole::{GUSTS, SENSORS, filter};

const CARTS: u64 = 40;
const STEPS: usize = 1000;

#[test]
fn errors_are_as_large_as_the_filter_says() {
    let mut nis = 0.0;
    let mut squares = [0.0; 6];
    for seed in 0..CARTS {
        let mut plant = CartAndPole::new(seed);
        let mut filter = filter().unwrap();
        for _ in 0..STEPS {
            filter.inputs_mut().drive = [plant.force()];
            let sample = plant.step();
            filter.predict(STEP_S, &GUSTS).unwrap();
            nis += filter.update(&sample, &SENSORS).unwrap().nis;
        }
        for (i, square) in squares.iter_mut().enumerate() {
            *square += ((filter.state()[i] - plant.state[i]) / filter.sigma(i)).powi(2);
        }
    }
    // Chi-square with 2 degrees of freedom a step: its mean has a sigma of 2 / sqrt(steps) = 0.01.
    // Five of them, and one for what linearisation leaves.
    let nis = nis / (CARTS as usize * STEPS) as f64;
    assert!((nis - 2.0).abs() < 0.06, "mean NIS {nis}, expected 2");
    // Chi-square with 40 degrees of freedom lies between 14 and 87 in all but 1e-5 of cases.
    for (i, square) in squares.into_iter().enumerate() {
        assert!(
            (14.0..87.0).contains(&square),
            "state {i}: {square} over {CARTS} carts"
        );
    }
}

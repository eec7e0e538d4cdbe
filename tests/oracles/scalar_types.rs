//! One generated function for several types of numbers: lanes and single precision.

use gyrocal_oracle::points::{Purpose, states};
use gyrocal_oracle::rounding::{ROUNDOFF_F32, ROUNDOFF_F64, RunningError};
use gyrocal_scalar::Lanes;

use crate::STATES;
use crate::functions::generated;

#[test]
fn lanes_have_the_bits_of_single_numbers() {
    let states = states(Purpose::ScalarTypes, STATES);
    for function in generated() {
        let Some(lanes) = function.lanes else {
            continue;
        };
        for (batch, four) in states.chunks_exact(4).enumerate() {
            let inputs: Vec<Vec<f64>> = four.iter().map(|state| function.inputs(state)).collect();
            let together: Vec<Lanes<f64, 4>> = (0..inputs[0].len())
                .map(|place| Lanes(core::array::from_fn(|lane| inputs[lane][place])))
                .collect();
            let together = lanes(&together);
            for (lane, inputs) in inputs.iter().enumerate() {
                let alone = (function.double)(inputs);
                assert_eq!(alone.len(), together.len());
                for (nonzero, (alone, together)) in alone.iter().zip(&together).enumerate() {
                    let (alone, together) = (alone.to_bits(), together.0[lane].to_bits());
                    let name = function.name;
                    assert_eq!(alone, together, "{name}, nonzero {nonzero}, batch {batch}");
                }
            }
        }
    }
}

#[test]
fn single_precision_differs_by_its_rounding_only() {
    let states = states(Purpose::ScalarTypes, STATES);
    for function in generated() {
        let (mut closest, mut rounds): (f64, bool) = (0.0, false);
        for state in &states {
            let single: Vec<f32> = function.inputs(state).iter().map(|&x| x as f32).collect();
            let double: Vec<f64> = single.iter().map(|&x| x.into()).collect();
            let bounded: Vec<RunningError> =
                double.iter().map(|&x| RunningError::exact(x)).collect();
            let (single, double) = ((function.single)(&single), (function.double)(&double));
            for (nonzero, bound) in (function.bounded)(&bounded).iter().enumerate() {
                let error = (f64::from(single[nonzero]) - double[nonzero]).abs();
                // The bound is of first order; products of two errors are 1e-4 of it at most,
                // with 1e3 roundoffs of 6e-8 in a factor.
                let allowed = 1.001 * bound.bound() * (ROUNDOFF_F32 + ROUNDOFF_F64);
                assert!(
                    error <= allowed,
                    "{}, nonzero {nonzero}: {error:e}",
                    function.name
                );
                if allowed > 0.0 {
                    rounds = true;
                    closest = closest.max(error / allowed);
                }
            }
        }
        // Worst cases seldom meet in one sum, but a bound that is never approached to a
        // tenth would prove little. What only moves inputs about does not round at all.
        assert!(
            closest > 0.1 || !rounds,
            "{}: never more than {closest} of the bound",
            function.name
        );
    }
}

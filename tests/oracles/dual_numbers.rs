//! Generated Jacobians against dual numbers through the value functions.

use gyrocal_oracle::compare::Comparison;
use gyrocal_oracle::points::{Purpose, states};

use crate::callable::dual_jacobian;
use crate::derivatives::derivatives;
use crate::interpreted::EXACT;
use crate::{STATES, hold, named, programs};

#[test]
fn generated_jacobians_agree_with_dual_numbers() {
    let states = states(Purpose::Dual, STATES);
    let programs = programs();
    let comparisons = derivatives().into_iter().map(|derivative| {
        let name = derivative.function.name;
        let program = named(&programs, name);
        let index = derivative.place(program);
        let mut comparison = Comparison::new(name, &program.outputs[index], EXACT);
        for (point, state) in states.iter().enumerate() {
            let inputs = derivative.function.inputs(state);
            let value = (derivative.function.double)(&inputs);
            // The chain rule rounds at other places than CasADi's expressions, as often.
            let rounding: Vec<f64> = derivative
                .function
                .rounding(&inputs)
                .iter()
                .map(|bound| 2.0 * bound)
                .collect();
            let expected = dual_jacobian(
                derivative
                    .of
                    .dual
                    .expect("a function that can be differentiated"),
                &derivative.of.inputs(state),
                &derivative.places(state),
            );
            let dense = |flat: &[f64]| program.dense_outputs(flat, 0.0).swap_remove(index);
            comparison.add(point, &dense(&value), &expected, &dense(&rounding));
        }
        comparison
    });
    hold(comparisons);
}

//! Generated code against an interpreter of the program that it was emitted from.

use gyrocal_oracle::compare::{Comparison, Tolerance};
use gyrocal_oracle::points::{Purpose, states};

use crate::derivatives::{value_function, values};
use crate::functions::{function, generated};
use crate::{STATES, hold, named, programs};

/// Both sides do the same operations but for what the emitter shares or reorders, with 1 ulp
/// of sine and cosine between the two libraries: 1e-13 is some hundred roundings. A column
/// that is proportional to a specific force a, or to a², holds rounding of 1e-16 / |a|, and
/// misses 1e-13 where |a| is below some 1e-3. That is the case for 4e-5 of the elements of the
/// derivatives by drift, and for none of the others.
pub(crate) const EXACT: Tolerance = Tolerance {
    relative: 1e-13,
    ill_conditioned_share: 2e-4,
};

#[test]
fn generated_functions_agree_with_the_interpreter() {
    let states = states(Purpose::Interpreter, STATES);
    let programs = programs();
    for program in &programs {
        for function_of_program in &program.functions {
            let function = function(&function_of_program.name);
            let mut comparisons: Vec<Comparison<'_>> = function_of_program
                .outputs
                .iter()
                .map(|output| Comparison::new(function.name, output, EXACT))
                .collect();
            for (point, state) in states.iter().enumerate() {
                let inputs = function.inputs(state);
                let dense = |flat: &[f64]| function_of_program.dense_outputs(flat, 0.0);
                let value = dense(&(function.double)(&inputs));
                let expected = dense(&function_of_program.evaluate(&inputs).unwrap());
                // Each side has its own rounding.
                let rounding: Vec<f64> = function
                    .rounding(&inputs)
                    .iter()
                    .map(|bound| 2.0 * bound)
                    .collect();
                let rounding = dense(&rounding);
                for (output, comparison) in comparisons.iter_mut().enumerate() {
                    comparison.add(point, &value[output], &expected[output], &rounding[output]);
                }
            }
            hold(comparisons);
        }
    }
}

#[test]
fn values_beside_jacobians_are_those_of_the_value_functions() {
    let states = states(Purpose::Interpreter, STATES);
    let programs = programs();
    for (name, output, value_name) in values() {
        let function = function(name);
        let value_function = value_function(value_name);
        let program = named(&programs, name);
        let (first, own) = (&program.outputs[0], program.outputs[0].nonzeros.len());
        assert_eq!(first.name, output, "the value comes first");
        let mut comparison = Comparison::new(name, first, EXACT);
        for (point, state) in states.iter().enumerate() {
            let inputs = function.inputs(state);
            let value = (function.double)(&inputs);
            let expected = (value_function.double)(&value_function.inputs(state));
            let rounding: Vec<f64> = function.rounding(&inputs)[..own]
                .iter()
                .map(|bound| 2.0 * bound)
                .collect();
            comparison.add(point, &value[..own], &expected, &rounding);
        }
        hold([comparison]);
    }
    assert_eq!(
        generated().len(),
        programs.iter().map(|p| p.functions.len()).sum::<usize>()
    );
}

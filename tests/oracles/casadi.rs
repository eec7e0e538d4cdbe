//! Generated code against the numbers that CasADi itself computed.

use std::path::Path;

use gyrocal_oracle::compare::Comparison;
use gyrocal_oracle::reference::{REFERENCE_PATH, Reference};

use crate::functions::function;
use crate::interpreted::EXACT;
use crate::{hold, programs};

#[test]
fn generated_functions_agree_with_casadi_at_its_points() {
    let reference = Reference::read(Path::new(REFERENCE_PATH)).unwrap();
    assert_eq!(reference.inputs.len(), 200);
    for program in programs().iter().flat_map(|program| &program.functions) {
        let function = function(&program.name);
        let rows = reference.function(&program.name).unwrap();
        assert_eq!(rows.len(), reference.inputs.len());
        let mut comparisons: Vec<Comparison<'_>> = program
            .outputs
            .iter()
            .map(|output| Comparison::new(function.name, output, EXACT))
            .collect();
        for (point, (groups, row)) in reference.inputs.iter().zip(rows).enumerate() {
            let inputs: Vec<f64> = function
                .groups
                .iter()
                .flat_map(|&group| groups[group].clone())
                .collect();
            let value = program.dense_outputs(&(function.double)(&inputs), 0.0);
            let expected = program.dense_outputs(row, 0.0);
            // Each side has its own rounding.
            let rounding: Vec<f64> = function
                .rounding(&inputs)
                .iter()
                .map(|bound| 2.0 * bound)
                .collect();
            let rounding = program.dense_outputs(&rounding, 0.0);
            for (output, comparison) in comparisons.iter_mut().enumerate() {
                comparison.add(point, &value[output], &expected[output], &rounding[output]);
            }
        }
        hold(comparisons);
    }
}

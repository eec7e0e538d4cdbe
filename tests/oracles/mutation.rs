//! Proof that the oracles can disagree: every instruction of every program is spoilt in
//! turn, and every oracle must notice, and name an element that the instruction feeds.

use gyrocal_oracle::compare::{Comparison, Mismatch, Tolerance};
use gyrocal_oracle::difference;
use gyrocal_oracle::dual;
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_oracle::program::{Binary, Function, Instruction, Unary};

use crate::callable::VARIABLES;
use crate::derivatives::derivatives;
use crate::differences::{NUMERIC, steps};
use crate::functions::function;
use crate::interpreted::EXACT;
use crate::programs;

/// States at which a mutant is run: enough that none hides where a term happens to vanish.
const FEW: usize = 4;

/// Another instruction that an emitter or a derivation might have got instead.
fn spoilt(function: &Function, instruction: Instruction) -> Instruction {
    match instruction {
        // Wrong in the sixth digit.
        Instruction::Const { to, value } => Instruction::Const { to, value: value * (1.0 + 1e-6) },
        // The neighbour of the right input.
        Instruction::Input { to, scalar } => {
            let scalar = if scalar == 0 { function.input_count() - 1 } else { scalar - 1 };
            Instruction::Input { to, scalar }
        }
        // Of the opposite sign: an output cannot be negated, but what it reads can.
        Instruction::Output { nonzero, from } => {
            Instruction::Output { nonzero, from: (from + 1) % function.work_size }
        }
        Instruction::Unary { operation, to, operand } => {
            let operation = match operation {
                Unary::Neg => Unary::Copy,
                Unary::Sq => Unary::Twice,
                Unary::Twice => Unary::Sq,
                Unary::Sin => Unary::Cos,
                Unary::Cos => Unary::Sin,
                _ => Unary::Neg,
            };
            Instruction::Unary { operation, to, operand }
        }
        Instruction::Binary { operation, to, left, right } => {
            let operation = match operation {
                Binary::Add => Binary::Sub,
                Binary::Sub => Binary::Add,
                Binary::Mul => Binary::Div,
                _ => Binary::Mul,
            };
            Instruction::Binary { operation, to, left, right }
        }
    }
}

/// Which nonzeros depend on the instruction at `index`.
fn fed_by(function: &Function, index: usize) -> Vec<bool> {
    let mut work = vec![false; function.work_size];
    let mut outputs = vec![false; function.nonzero_count()];
    for (at, instruction) in function.instructions.iter().enumerate() {
        let own = at == index;
        match *instruction {
            Instruction::Const { to, .. } | Instruction::Input { to, .. } => work[to] = own,
            Instruction::Output { nonzero, from } => outputs[nonzero] = own || work[from],
            Instruction::Unary { to, operand, .. } => work[to] = own || work[operand],
            Instruction::Binary { to, left, right, .. } => {
                work[to] = own || work[left] || work[right];
            }
        }
    }
    outputs
}

/// Compares one output of a spoilt function with what it should be, at each state.
fn compare(
    spoilt: &Function,
    output: usize,
    tolerance: Tolerance,
    expected: &[Vec<f64>],
    inputs: &[Vec<f64>],
) -> Option<Mismatch> {
    let mut comparison = Comparison::new(&spoilt.name, &spoilt.outputs[output], tolerance);
    for (point, (inputs, expected)) in inputs.iter().zip(expected).enumerate() {
        let value = spoilt.dense_outputs(&spoilt.evaluate(inputs).unwrap(), 0.0);
        // Nothing is excused: the right program passes at these states without.
        let rounding = vec![0.0; expected.len()];
        comparison.add(point, &value[output], expected, &rounding);
    }
    comparison.finish().err()
}

/// Spoils each `stride`-th instruction of a function in turn and asserts that the comparison
/// of `output` fails if and only if the instruction feeds it, naming an element it feeds.
/// Returns how many were noticed.
fn every_mutant_is_named(
    program: &Function,
    output: usize,
    stride: usize,
    tolerance: Tolerance,
    expected: &[Vec<f64>],
    states: &[State],
) -> usize {
    let generated = function(&program.name);
    let inputs: Vec<Vec<f64>> = states.iter().map(|state| generated.inputs(state)).collect();
    let right = compare(program, output, tolerance, expected, &inputs);
    assert_eq!(right, None, "the right program must pass");
    let mut noticed = 0;
    for index in (0..program.instructions.len()).step_by(stride) {
        let mut mutant = program.clone();
        mutant.instructions[index] = spoilt(program, program.instructions[index]);
        let fed = program.dense_outputs(&fed_by(program, index), false).swap_remove(output);
        let shape = &program.outputs[output];
        let names: Vec<(String, String)> = (0..fed.len())
            .filter(|&place| fed[place])
            .map(|place| (place / shape.columns, place % shape.columns))
            .map(|(row, column)| (shape.row_name(row), shape.column_label(column)))
            .collect();
        let change = (program.instructions[index], mutant.instructions[index]);
        match compare(&mutant, output, tolerance, expected, &inputs) {
            None => assert!(names.is_empty(), "{}, {index}: {change:?} hides", program.name),
            Some(Mismatch::Element(worst)) => {
                let named = (worst.row.clone(), worst.column.clone());
                assert!(names.contains(&named), "{index}: {change:?} is named {worst}");
                noticed += 1;
            }
            Some(other) => panic!("{index}: {other}"),
        }
    }
    noticed
}

#[test]
fn the_interpreter_notices_every_spoilt_instruction() {
    let states = states(Purpose::Mutation, FEW);
    for program in programs().iter().flat_map(|program| &program.functions) {
        let generated = function(&program.name);
        // Of the thousands of instructions of the written-out step every 13th is enough.
        let stride = if program.instructions.len() > 1000 { 13 } else { 1 };
        let mut noticed = 0;
        for output in 0..program.outputs.len() {
            let expected: Vec<Vec<f64>> = states
                .iter()
                .map(|state| (generated.double)(&generated.inputs(state)))
                .map(|flat| program.dense_outputs(&flat, 0.0).swap_remove(output))
                .collect();
            noticed += every_mutant_is_named(program, output, stride, EXACT, &expected, &states);
        }
        // Every instruction feeds at least one output.
        assert!(noticed >= program.instructions.len() / stride, "{}: {noticed}", program.name);
    }
}

#[test]
fn dual_numbers_and_differences_notice_every_spoilt_jacobian() {
    let states = states(Purpose::Mutation, FEW);
    let programs = programs();
    for derivative in derivatives() {
        let name = derivative.function.name;
        let program = programs.iter().find_map(|program| program.function(name).ok()).unwrap();
        let stride = if program.instructions.len() > 1000 { 101 } else { 1 };
        let index = program.outputs.iter().position(|o| o.name == derivative.output).unwrap();
        let by_dual = |state: &State| {
            let function = derivative.of.dual.unwrap();
            let inputs = derivative.of.inputs(state);
            dual::jacobian::<VARIABLES>(function, &inputs, &derivative.places(state))
        };
        let by_difference = |state: &State| {
            let (inputs, places) = (derivative.of.inputs(state), derivative.places(state));
            let steps = steps(&derivative, state);
            difference::jacobian(derivative.of.double, &inputs, &places, &steps)
        };
        let duals: Vec<Vec<f64>> = states.iter().map(by_dual).collect();
        let differences: Vec<Vec<f64>> = states.iter().map(by_difference).collect();
        for (tolerance, expected) in [(EXACT, duals), (NUMERIC, differences)] {
            let noticed =
                every_mutant_is_named(program, index, stride, tolerance, &expected, &states);
            assert!(noticed > 0, "{name}");
        }
    }
}

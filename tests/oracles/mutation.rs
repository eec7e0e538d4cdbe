//! Mutation test of the oracles: every instruction of every program is changed in turn, and every
//! oracle must detect it and name an element that the instruction feeds.

use std::collections::{BTreeMap, BTreeSet};

use gyrocal_oracle::compare::{Comparison, Mismatch, Tolerance};
use gyrocal_oracle::difference;
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_oracle::program::{Binary, Function, Instruction, Unary};

use crate::callable::{Callable, dual_jacobian};
use crate::derivatives::derivatives;
use crate::differences::{NUMERIC, steps};
use crate::functions::function;
use crate::interpreted::EXACT;
use crate::{named, programs};

/// States at which a mutant is run: enough that none hides where a term happens to vanish.
const FEW: usize = 4;

/// Another instruction that an emitter or a derivation might have got instead.
fn spoilt(function: &Function, instruction: Instruction) -> Instruction {
    match instruction {
        // Wrong in the sixth digit.
        Instruction::Const { to, value } => Instruction::Const {
            to,
            value: value * (1.0 + 1e-6),
        },
        // The neighbour of the right input.
        Instruction::Input { to, scalar } => {
            let scalar = if scalar == 0 {
                function.input_count() - 1
            } else {
                scalar - 1
            };
            Instruction::Input { to, scalar }
        }
        // The neighbour of the right place.
        Instruction::Output { nonzero, from } => Instruction::Output {
            nonzero,
            from: (from + 1) % function.work_size,
        },
        Instruction::Unary {
            operation,
            to,
            operand,
        } => {
            let operation = match operation {
                Unary::Neg => Unary::Copy,
                Unary::Sq => Unary::Twice,
                Unary::Twice => Unary::Sq,
                Unary::Sin => Unary::Cos,
                Unary::Cos => Unary::Sin,
                _ => Unary::Neg,
            };
            Instruction::Unary {
                operation,
                to,
                operand,
            }
        }
        Instruction::Binary {
            operation,
            to,
            left,
            right,
        } => {
            let operation = match operation {
                Binary::Add => Binary::Sub,
                Binary::Sub => Binary::Add,
                Binary::Mul => Binary::Div,
                _ => Binary::Mul,
            };
            Instruction::Binary {
                operation,
                to,
                left,
                right,
            }
        }
    }
}

/// Nonzeros that depend on the instruction at `index`.
fn fed_by(function: &Function, index: usize) -> Vec<bool> {
    let mut work = vec![false; function.work_size];
    let mut outputs = vec![false; function.nonzero_count()];
    for (at, instruction) in function.instructions.iter().enumerate() {
        let own = at == index;
        match *instruction {
            Instruction::Const { to, .. } | Instruction::Input { to, .. } => work[to] = own,
            Instruction::Output { nonzero, from } => outputs[nonzero] = own || work[from],
            Instruction::Unary { to, operand, .. } => work[to] = own || work[operand],
            Instruction::Binary {
                to, left, right, ..
            } => {
                work[to] = own || work[left] || work[right];
            }
        }
    }
    outputs
}

/// Expected value of one output at one state, by an oracle.
struct Verdict {
    inputs: Vec<f64>,
    expected: Vec<f64>,
    rounding: Vec<f64>,
}

/// Compares one output of a program, original or mutated, with an oracle.
fn compare(
    program: &Function,
    output: usize,
    relative: f64,
    verdicts: &[Verdict],
) -> Option<Mismatch> {
    // A share says nothing of a handful of states.
    let tolerance = Tolerance {
        relative,
        ill_conditioned_share: 1.0,
    };
    let mut comparison = Comparison::new(&program.name, &program.outputs[output], tolerance);
    for (point, verdict) in verdicts.iter().enumerate() {
        let value = program.dense_outputs(&program.evaluate(&verdict.inputs).unwrap(), 0.0);
        comparison.add(point, &value[output], &verdict.expected, &verdict.rounding);
    }
    comparison.finish().err()
}

/// Spoils each `stride`-th instruction of a function in turn and asserts that the comparison
/// of `output`, if it fails, names an element that the instruction feeds. Returns for each
/// of those instructions whether it was noticed, or `None` if it does not feed the output.
fn spoil_each(
    program: &Function,
    output: usize,
    stride: usize,
    relative: f64,
    verdicts: &[Verdict],
) -> Vec<Option<bool>> {
    let right = compare(program, output, relative, verdicts);
    assert_eq!(right, None, "the right program must pass");
    let spoil = |index: usize| {
        let mut mutant = program.clone();
        mutant.instructions[index] = spoilt(program, program.instructions[index]);
        let fed = program
            .dense_outputs(&fed_by(program, index), false)
            .swap_remove(output);
        let shape = &program.outputs[output];
        let names: Vec<(String, String)> = (0..fed.len())
            .filter(|&place| fed[place])
            .map(|place| (place / shape.columns, place % shape.columns))
            .map(|(row, column)| (shape.row_name(row), shape.column_label(column)))
            .collect();
        let change = (program.instructions[index], mutant.instructions[index]);
        match compare(&mutant, output, relative, verdicts) {
            None => (!names.is_empty()).then_some(false),
            Some(Mismatch::Element(worst)) => {
                let named = (worst.row.clone(), worst.column.clone());
                assert!(
                    names.contains(&named),
                    "{index}: {change:?} is named {worst}"
                );
                Some(true)
            }
            Some(other) => panic!("{index}: {other}"),
        }
    };
    (0..program.instructions.len())
        .step_by(stride)
        .map(spoil)
        .collect()
}

#[test]
fn the_interpreter_notices_every_spoilt_instruction() {
    let states = states(Purpose::Mutation, FEW);
    for program in programs().iter().flat_map(|program| &program.functions) {
        let generated = function(&program.name);
        // Of the thousands of instructions of the written-out step every 13th is enough.
        let stride = if program.instructions.len() > 1000 {
            13
        } else {
            1
        };
        let verdict = |state: &State, output: usize| {
            let inputs = generated.inputs(state);
            let flat = (generated.double)(&inputs);
            let expected = program.dense_outputs(&flat, 0.0).swap_remove(output);
            Verdict {
                inputs,
                rounding: vec![0.0; expected.len()],
                expected,
            }
        };
        let noticed_by: Vec<Vec<Option<bool>>> = (0..program.outputs.len())
            .map(|output| {
                let verdicts: Vec<Verdict> =
                    states.iter().map(|state| verdict(state, output)).collect();
                spoil_each(program, output, stride, EXACT.relative, &verdicts)
            })
            .collect();
        for mutant in 0..noticed_by[0].len() {
            let noticed = noticed_by.iter().any(|output| output[mutant] == Some(true));
            let index = mutant * stride;
            let instruction = program.instructions[index];
            let inputs: Vec<Vec<f64>> =
                states.iter().map(|state| generated.inputs(state)).collect();
            assert!(
                noticed || !is_changed(program, index, &inputs),
                "{}, {index}: spoilt {instruction:?} hides",
                program.name
            );
        }
    }
}

#[test]
fn dual_numbers_and_differences_notice_every_spoilt_jacobian() {
    let states = states(Purpose::Mutation, FEW);
    let programs = programs();
    // Of each instruction of each function: by which outputs it went unnoticed.
    let mut hidden: BTreeMap<(&str, usize), Vec<&str>> = BTreeMap::new();
    let mut noticed_somewhere: BTreeSet<(&str, usize)> = BTreeSet::new();
    for derivative in derivatives() {
        let name = derivative.function.name;
        let program = named(&programs, name);
        let stride = if program.instructions.len() > 1000 {
            101
        } else {
            1
        };
        let index = derivative.place(program);
        let by_dual = |state: &State| {
            let function = derivative.of.dual.unwrap();
            let inputs = derivative.of.inputs(state);
            let expected = dual_jacobian(function, &inputs, &derivative.places(state));
            let rounding = vec![0.0; expected.len()];
            Verdict {
                inputs: derivative.function.inputs(state),
                expected,
                rounding,
            }
        };
        let by_difference = |state: &State| {
            let (inputs, places) = (derivative.of.inputs(state), derivative.places(state));
            let steps = steps(&derivative, state);
            let expected = difference::jacobian(derivative.of.double, &inputs, &places, &steps);
            let rounding = difference::rounding(&derivative.of.rounding(&inputs), &steps);
            Verdict {
                inputs: derivative.function.inputs(state),
                expected,
                rounding,
            }
        };
        let duals: Vec<Verdict> = states.iter().map(by_dual).collect();
        let differences: Vec<Verdict> = states.iter().map(by_difference).collect();
        for (relative, verdicts) in [(EXACT.relative, duals), (NUMERIC.relative, differences)] {
            let noticed = spoil_each(program, index, stride, relative, &verdicts);
            assert!(noticed.contains(&Some(true)), "{name}");
            for (mutant, noticed) in noticed.into_iter().enumerate() {
                let place = (name, mutant * stride);
                match noticed {
                    Some(true) => drop(noticed_somewhere.insert(place)),
                    Some(false) => hidden.entry(place).or_default().push(derivative.output),
                    None => {}
                }
            }
        }
    }
    // A value that one derivative does not depend on enters another.
    hidden.retain(|place, _| !noticed_somewhere.contains(place));
    for ((name, index), outputs) in hidden {
        let generated = function(name);
        let program = named(&programs, name);
        let instruction = program.instructions[index];
        let inputs: Vec<Vec<f64>> = states.iter().map(|state| generated.inputs(state)).collect();
        assert!(
            reads_omega_x(&generated, instruction, &states[0])
                || !is_changed(program, index, &inputs),
            "{name}, {outputs:?}, {index}: spoilt {instruction:?} hides",
        );
    }
}

/// Whether a mutated instruction has another value at any of the inputs: a product with cos² + sin²
/// equals the quotient by it.
fn is_changed(program: &Function, index: usize, inputs: &[Vec<f64>]) -> bool {
    let result = |instruction: Instruction| {
        let mut part = program.clone();
        part.instructions.truncate(index);
        part.instructions.push(instruction);
        let to = match instruction {
            Instruction::Const { to, .. }
            | Instruction::Input { to, .. }
            | Instruction::Unary { to, .. }
            | Instruction::Binary { to, .. } => to,
            // The neighbour of the right place may hold the same number.
            Instruction::Output { from, .. } => from,
        };
        part.instructions.push(Instruction::Output {
            nonzero: 0,
            from: to,
        });
        let values = inputs.iter().map(|x| part.evaluate(x).unwrap()[0]);
        values.collect::<Vec<f64>>()
    };
    let right = program.instructions[index];
    let (right, wrong) = (result(right), result(spoilt(program, right)));
    // No oracle detects less than some rounding errors.
    let differs = |(right, wrong): (&f64, &f64)| (right - wrong).abs() > 1e-14 * right.abs();
    right.iter().zip(&wrong).any(differs)
}

/// Earth rate along chart x makes the rates (1, 0, 0) times itself at any attitude, as the
/// first rotation is about that axis: a spoilt one is in no derivative by angles.
fn reads_omega_x(function: &Callable, instruction: Instruction, state: &State) -> bool {
    let omega_x = function.places("omega_0", state)[0];
    matches!(instruction, Instruction::Input { scalar, .. } if scalar == omega_x)
}

//! Simplification keeps values and saves operations.
#![cfg(test)]

mod common;

use common::{Random, one_function};
use gyrocal_codegen::ir::{Binary, Expressions, Node, Unary, evaluate, lower};
use gyrocal_codegen::{Program, emit_module, simplify};

const POINTS: usize = 200;

/// Inputs of a function at `POINTS` points, every element within 1.
fn points(program: &Program, function: usize, random: &mut Random) -> Vec<Vec<Vec<f64>>> {
    let function = &program.functions[function];
    (0..POINTS)
        .map(|_| {
            program
                .inputs_of(function)
                .map(|group| group.elements.iter().map(|_| random.next()).collect())
                .collect()
        })
        .collect()
}

#[test]
fn values_stay_the_same() {
    for file in [
        "tests/data/pendulum/pendulum.json",
        "../../src/generated/platform.json",
        "../../src/generated/oracle.json",
    ] {
        let program = common::program(file);
        let mut random = Random(7);
        let mut cost = (0, 0);
        for (index, function) in program.functions.iter().enumerate() {
            let before = lower(function);
            let after = simplify(&before);
            for point in points(&program, index, &mut random) {
                let pairs = evaluate(&before, &point)
                    .into_iter()
                    .zip(evaluate(&after, &point));
                for ((expected, found), output) in pairs.zip(&function.outputs) {
                    // Shared reciprocals round once more, 1.1e-16 of the quotient each, and
                    // sums may cancel: errors are relative to the largest element of the
                    // output. The written-out RK4 step has the longest chain.
                    let scale = expected
                        .iter()
                        .fold(0.0_f64, |most, value| most.max(value.abs()));
                    for (expected, found) in expected.iter().zip(&found) {
                        assert!(
                            (found - expected).abs() <= 1e-13 * scale,
                            "{file}, {}, {}: {expected} became {found} at {point:?}",
                            function.name,
                            output.name
                        );
                    }
                }
            }
            cost.0 += cost_of(&before);
            cost.1 += cost_of(&after);
        }
        assert!(
            cost.1 < cost.0,
            "{file}: a cost of {} became {}",
            cost.0,
            cost.1
        );
    }
}

/// Number of nodes, a division being worth four: about the ratio of its time to that of a product.
fn cost_of(expressions: &Expressions) -> usize {
    let nodes = expressions.graph.iter().map(|(_, node)| match node {
        Node::Binary(Binary::Div, ..) | Node::Unary(Unary::Reciprocal, _) => 4,
        _ => 1,
    });
    nodes.sum()
}

#[test]
fn what_is_simple_stays_as_it_is() {
    let program = common::program("../../src/generated/platform.json");
    for function in &program.functions {
        let once = simplify(&lower(function));
        let twice = simplify(&once);
        assert!(twice.graph.len() <= once.graph.len(), "{}", function.name);
    }
}

/// The statements of the function `f` of [`one_function`].
fn body(elements: usize, outputs: usize, instructions: &str) -> String {
    let text = one_function(elements, outputs, instructions);
    let program = Program::from_json(&text, "test.json").unwrap();
    let module = emit_module(&program, &common::header()).unwrap();
    let (_, body) = module.split_once("pub fn f<T: Scalar>").unwrap();
    let (_, body) = body.split_once("= *x;\n").unwrap();
    body.lines().map(str::trim).collect::<Vec<_>>().join(" ")
}

const X0: &str = r#"["input",0,0,0],"#;
const X1: &str = r#"["input",1,0,1],"#;

#[test]
fn rules_do_what_they_say() {
    // What, the instructions after x0 and x1, and the result.
    let cases = r#"
        x + 0 | ["const",2,0],["add",2,0,2],["output",0,0,2] | [x0]
        1 x | ["const",2,1],["mul",2,2,0],["output",0,0,2] | [x0]
        -(-x) | ["neg",2,0],["neg",2,2],["output",0,0,2] | [x0]
        x0 + (-x1) | ["neg",2,1],["add",2,0,2],["output",0,0,2] | [x0 - x1]
        (-x0) (-x1) | ["neg",2,0],["neg",3,1],["mul",2,2,3],["output",0,0,2] | [x0 * x1]
        -x0 - x1 | ["neg",2,0],["sub",2,2,1],["output",0,0,2] | [-x0 - x1]
        -(x0 - x1) | ["sub",2,0,1],["neg",2,2],["output",0,0,2] | [x1 - x0]
        cos(-x) | ["neg",2,0],["cos",2,2],["output",0,0,2] | let (_, cos_x0) = x0.sin_cos(); [cos_x0]
        sin(-x) cos(x) | ["neg",2,0],["sin",2,2],["cos",3,0],["mul",2,2,3],["output",0,0,2] | let (sin_x0, cos_x0) = x0.sin_cos(); [-sin_x0 * cos_x0]
        twice | ["twice",2,0],["output",0,0,2] | [x0 + x0]
        2 x | ["const",2,2],["mul",2,2,0],["output",0,0,2] | [x0 + x0]
        x / 4 is exact as a product | ["const",2,4],["div",2,0,2],["output",0,0,2] | [x0 * T::from_f64(2.5e-1)]
        x / 3 is not | ["const",2,3],["div",2,0,2],["output",0,0,2] | [x0 / T::from_f64(3e0)]
        2 + 3 | ["const",2,2],["const",3,3],["add",2,2,3],["output",0,0,2] | [T::from_f64(5e0)]
        x^5 | ["const",2,5],["pow",2,0,2],["output",0,0,2] | let x0_squared = x0 * x0; [x0_squared * x0_squared * x0]
        x^-1 | ["const",2,-1],["pow",2,0,2],["output",0,0,2] | [T::from_f64(1e0) / x0]
        x^0.3 | ["const",2,0.3],["pow",2,0,2],["output",0,0,2] | [x0.powf(T::from_f64(3e-1))]
        x - x stays: x may be infinite | ["sub",2,0,0],["output",0,0,2] | [x0 - x0]
        0 x stays | ["const",2,0],["mul",2,2,0],["output",0,0,2] | [T::from_f64(0e0) * x0]
        a + (b + c) needs no parentheses | ["mul",2,0,1],["add",2,2,1],["add",2,0,2],["output",0,0,2] | [x0 * x1 + x1 + x0]
        a - (b + c) needs them | ["mul",2,0,1],["add",2,2,1],["sub",2,0,2],["output",0,0,2] | [x0 - (x0 * x1 + x1)]
        a / (b c) needs them | ["mul",2,0,1],["div",2,0,2],["output",0,0,2] | [x0 / (x0 * x1)]
        (a + b).sqrt() | ["add",2,0,1],["sqrt",2,2],["output",0,0,2] | [(x0 + x1).sqrt()]
        not not (x0 < x1) | ["lt",2,0,1],["not",2,2],["not",2,2],["output",0,0,2] | [x0.less(x1)]
        dead code | ["exp",2,0],["output",0,0,1] | [x1]
    "#;
    for case in cases.trim().lines() {
        let [what, instructions, expected] =
            [0, 1, 2].map(|column| case.split('|').nth(column).unwrap().trim());
        let result = body(2, 1, &format!("{X0}{X1}{instructions}"));
        let (result, _) = result.split_once(" }").unwrap();
        assert_eq!(result, expected, "{what}");
    }
}

#[test]
fn differences_and_their_negatives_are_one() {
    let result = body(
        2,
        2,
        &format!(r#"{X0}{X1}["sub",2,0,1],["sub",3,1,0],["output",0,0,2],["output",1,0,3]"#),
    );
    assert!(
        result.starts_with("let t1 = x0 - x1; F { y0: [t1], y1: [-t1]"),
        "{result}"
    );
}

#[test]
fn quotients_of_one_denominator_share_its_reciprocal() {
    let result = body(
        3,
        2,
        &format!(
            r#"{X0}{X1}["input",2,0,2],["div",3,0,2],["div",4,1,2],
               ["output",0,0,3],["output",1,0,4]"#
        ),
    );
    let expected = "let inverse_x2 = T::from_f64(1e0) / x2; \
                    F { y0: [x0 * inverse_x2], y1: [x1 * inverse_x2]";
    assert!(result.starts_with(expected), "{result}");
}

#[test]
fn products_of_either_order_are_one() {
    let result = body(
        2,
        2,
        &format!(r#"{X0}{X1}["mul",2,0,1],["mul",3,1,0],["output",0,0,2],["output",1,0,3]"#),
    );
    assert!(
        result.starts_with("let t1 = x0 * x1; F { y0: [t1], y1: [t1]"),
        "{result}"
    );
}

#[test]
fn logic_of_the_program_is_that_of_c() {
    // Nonzero numbers and NaN are true.
    let cases = [
        (
            "and",
            [
                [2.0, 3.0, 1.0],
                [2.0, 0.0, 0.0],
                [0.0, 3.0, 0.0],
                [f64::NAN, 1.0, 1.0],
            ],
        ),
        (
            "or",
            [
                [2.0, 3.0, 1.0],
                [2.0, 0.0, 1.0],
                [0.0, 0.0, 0.0],
                [f64::NAN, 0.0, 1.0],
            ],
        ),
        (
            "ne",
            [
                [2.0, 3.0, 1.0],
                [2.0, 2.0, 0.0],
                [0.0, -0.0, 0.0],
                [f64::NAN, 1.0, 1.0],
            ],
        ),
    ];
    for (operation, rows) in cases {
        let text = one_function(
            2,
            1,
            &format!(r#"{X0}{X1}["{operation}",2,0,1],["output",0,0,2]"#),
        );
        let program = Program::from_json(&text, "test.json").unwrap();
        let lowered: Expressions = lower(&program.functions[0]);
        for expressions in [lowered.clone(), simplify(&lowered)] {
            for [x, y, expected] in rows {
                let found = evaluate(&expressions, &[vec![x, y]])[0][0];
                assert_eq!(found, expected, "{x} {operation} {y}");
            }
        }
    }
}

//! Every fault of a program has a message with where, found, expected and what to do.
#![cfg(test)]

mod common;

use common::{one_function, read};
use gyrocal_codegen::{Error, Program, emit_module};

/// Asserts on a faulty program's message; texts between `...` must stand in this order.
#[track_caller]
fn assert_message(error: &Error, expected: &str) {
    let message = error.to_string();
    let mut rest = message.as_str();
    for part in expected.split("...") {
        let Some((_, after)) = rest.split_once(part) else {
            panic!("`{part}` not found in order in:\n{message}");
        };
        rest = after;
    }
}

#[track_caller]
fn refused(text: &str) -> Error {
    match Program::from_json(text, "test.json") {
        Err(error) => error,
        Ok(program) => emit_module(&program, &common::header()).expect_err("a fault"),
    }
}

/// The pendulum with a piece of text replaced everywhere.
#[track_caller]
fn pendulum_with(from: &str, to: &str) -> Error {
    let text = read("tests/data/pendulum/pendulum.json");
    assert!(text.contains(from), "the pendulum has no `{from}`");
    refused(&text.replace(from, to))
}

#[test]
fn another_schema_version() {
    let error = pendulum_with("\"schema_version\": 1", "\"schema_version\": 2");
    assert!(matches!(error, Error::SchemaVersion { .. }));
    assert_message(
        &error,
        "test.json: schema_version: found 2, expected 1; derive the program again with the \
         exporter that comes with this version",
    );
    assert_message(
        &refused("{}"),
        "test.json: schema_version: found none, expected 1; derive the program again",
    );
}

#[test]
fn not_a_program() {
    let error = refused("{\"schema_version\": 1,\n nonsense");
    assert!(matches!(error, Error::Json { .. }));
    assert_message(
        &error,
        "test.json: not a program: ... at line 2 column ... derive it again",
    );
    let error = pendulum_with("\"casadi_version\"", "\"casadi\"");
    assert_message(
        &error,
        "test.json: not a program: unknown field `casadi`, expected one of ... at line 5",
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of cases")]
fn faulty_instructions() {
    let cases = [
        (
            r#"["printme",0,0]"#,
            "instruction 0: found the operation `printme`, expected one of abs, acos, ... tanh, \
             twice; write the expression with these",
        ),
        (
            r#"["neg",0,3]"#,
            "instruction 0: found a use of work element 3, which is not set yet",
        ),
        (
            r#"["input",99,0,0]"#,
            "test.json: function `f`, instruction 0: found work element 99, expected below 16; \
             derive the program again",
        ),
        (r#"["input",0,1,0]"#, "found input 1, expected below 1"),
        (
            r#"["input",0,0,2]"#,
            "found element of the input 2, expected below 2",
        ),
        (
            r#"["input",0,0,0],["output",1,0,0]"#,
            "instruction 1: found output 1, expected below 1",
        ),
        (
            r#"["input",0,0,0],["output",0,1,0]"#,
            "found nonzero of the output 1, expected below 1",
        ),
        (
            r#"["input",0,0,0],["output",0,0,0],["output",0,0,0]"#,
            "instruction 2: found a second write of nonzero 0 of output `y0`, expected one write",
        ),
        (
            r#"["input",0,0,0]"#,
            "function `f`: found no write of nonzero 0 of output `y0`, expected one write",
        ),
        (r#"["add",0,1]"#, "found 2 operands, expected 3 operands"),
        (
            r#"["input",0,0,-1]"#,
            "found the operand -1, expected a count from 0 on",
        ),
        (
            r#"[1,0]"#,
            "found [1,0], expected a list that begins with the name of an operation",
        ),
        (
            r#"["const",0,null]"#,
            "found the constant null, expected a finite number; look for a division by zero or an \
             overflow in the derivation",
        ),
        (
            r#"["const",0,"inf"]"#,
            "found the constant \"inf\", expected a finite number",
        ),
        (
            r#"["const",0,1e999]"#,
            "function `f`, instruction 0: found the constant \"1e999\", expected a finite number",
        ),
        (
            r#"["input",0,0,0],["const",1,NaN]"#,
            "test.json: function `f`, instruction 1: found the constant \"NaN\", expected a finite \
             number; look for a division by zero",
        ),
        (
            r#"["const",0,-Infinity]"#,
            "function `f`, instruction 0: found the constant \"-Infinity\", expected a finite",
        ),
        (
            r#"["call",0,"lift",0]"#,
            "instruction 0: found a call of \"lift\", expected the name of an external function",
        ),
        (
            r#"["input",0,18446744073709551615,0]"#,
            "instruction 0: found input 18446744073709551615, expected below 1",
        ),
        (
            r#"["add",0,0,1],["add",1,0,0],["output",0,0,1]"#,
            "instruction 0: found a use of work element 0, which is not set yet",
        ),
        (
            r#"["const",0,0],["inv",0,0],["output",0,0,0]"#,
            "test.json: function `f`: found the constant inf, expected a finite one; look for a \
             division by zero",
        ),
    ];
    for (instructions, expected) in cases {
        assert_message(&refused(&one_function(2, 1, instructions)), expected);
    }
    let unknown = refused(&one_function(1, 1, r#"["printme",0,0]"#));
    assert!(matches!(unknown, Error::Operation { .. }));
    let infinite = refused(&one_function(
        1,
        1,
        r#"["const",0,0],["inv",0,0],["output",0,0,0]"#,
    ));
    assert!(matches!(infinite, Error::NotFinite { .. }));
}

#[test]
fn names_that_rust_cannot_take() {
    for name in [
        "Angle", "2nd", "a__b", "a-b", "", "type", "gen", "self", "_x", "winkelä",
    ] {
        let error = pendulum_with("\"name\": \"angle\"", &format!("\"name\": \"{name}\""));
        assert!(matches!(error, Error::Name { .. }), "{name}: {error}");
        assert_message(
            &error,
            &format!(
                "test.json: group `swing`: found the name `{name}`, expected lower-case words \
                 joined by `_` that are no Rust keyword, such as `rate_x`; rename it in the \
                 derivation"
            ),
        );
    }
    assert_message(
        &pendulum_with("\"name\": \"Pendulum\"", "\"name\": \"pendulum\""),
        "test.json: model: found the name `pendulum`, expected a Rust type name",
    );
}

#[test]
fn names_that_collide() {
    assert_message(
        &pendulum_with("\"name\": \"rate\"", "\"name\": \"angle\""),
        "group `swing`: found the name `angle`, expected each name once",
    );
    // The struct of the group and that of the function's outputs.
    assert_message(
        &pendulum_with(
            "\"name\": \"heading\",\n   \"doc\": \"Direction",
            "\"name\": \"rod\",\n   \"doc\": \"Direction",
        ),
        "function `rod`: found the name `Rod`, expected a name of a Rust item that group `rod` \
         does not take; rename it",
    );
    assert_message(
        &pendulum_with("\"name\": \"Pendulum\"", "\"name\": \"Scalar\""),
        "model `Scalar`: found the name `Scalar`, expected a name of a Rust item that the emitted \
         code itself does not take",
    );
    // A parameter and a moving state are fields of one struct.
    assert_message(
        &pendulum_with("\"name\": \"damping\"", "\"name\": \"angle\""),
        "model `Pendulum`, state: found the name `angle`, expected names that differ between \
         moving states and parameters",
    );
}

#[test]
fn shapes_that_do_not_fit() {
    assert_message(
        &pendulum_with("[[1,0],[0,1],[1,1]]", "[[1,0],[0,1],[2,1]]"),
        "output `swing_dot_d_swing`: found a nonzero at row 2, column 1, expected places inside 2 \
         rows and 2 columns",
    );
    assert_message(
        &pendulum_with("[[1,0],[0,1],[1,1]]", "[[1,0],[0,1],[0,1]]"),
        "found two nonzeros at row 0, column 1, expected each place once",
    );
    assert_message(
        &pendulum_with("[\"angle_dot\", \"rate_dot\"]", "[\"angle_dot\"]"),
        "function `swing_rates`, output `swing_dot`: found 1 row names, expected 2, one for each",
    );
    assert_message(
        &pendulum_with("\"group\": \"field\"", "\"group\": \"meadow\""),
        "function `swing_rates`, inputs: found the group `meadow`, expected a group of the program",
    );
}

#[test]
fn models_whose_parts_do_not_fit() {
    let cases = [
        (
            "\"moving\": \"swing\"",
            "\"moving\": \"swong\"",
            "model, moving: found the group `swong`, expected a group that a function takes",
        ),
        (
            "\"parameters\": \"rod\"",
            "\"parameters\": \"field\"",
            "model: found the group `field` in two parts, expected each group in one part",
        ),
        (
            "\"value\": \"swing_rates\"",
            "\"value\": \"rates\"",
            "model, rates, value: found the function `rates`, expected a function of the program",
        ),
        (
            "\"inputs\": [\"field\"]",
            "\"inputs\": []",
            "model, rates, value: found the function `swing_rates` of the group `field`, expected \
             functions of moving, parameters and inputs alone; add the group to the inputs",
        ),
        (
            "\"value\": \"swing_rates\"",
            "\"value\": \"reach\"",
            "model, rates: found the first output `swing_dot` (2 rows, 1 columns, 2 nonzeros)",
        ),
        (
            "\"value\": \"bob_place\"",
            "\"value\": \"bob_place_jacobian\"",
            "model, output: found the function `bob_place_jacobian` with the outputs `bob` ... \
             expected one output, a column without structural zeros",
        ),
        (
            "\"name\": \"swing_dot_d_push\"",
            "\"name\": \"swing_dot_push\"",
            "model, rates, output `swing_dot_push`: found its name, expected `swing_dot_d_GROUP`",
        ),
        (
            "\"noise\": \"push\"",
            "\"noise\": null",
            "output `swing_dot_d_push`: found a Jacobian with respect to `push`, expected one with \
             respect to moving, parameters or noise",
        ),
        (
            "\"name\": \"bob_d_rod\"",
            "\"name\": \"bob_d_push\"",
            "model, output, output `bob_d_push`: found a Jacobian with respect to `push`, expected \
             one with respect to moving or parameters; an output has no noise inputs",
        ),
        (
            "\"name\": \"swing_dot_d_rod\"",
            "\"name\": \"swing_dot_d_push_of_rod\"",
            "found a Jacobian with respect to `push_of_rod`",
        ),
    ];
    for (from, to, expected) in cases {
        assert_message(&pendulum_with(from, to), expected);
    }
}

/// The program as a value, to change it where text alone is ambiguous.
fn pendulum_value() -> serde_json::Value {
    serde_json::from_str(&read("tests/data/pendulum/pendulum.json")).unwrap()
}

#[test]
fn more_noise_inputs_than_moving_states() {
    let mut program = pendulum_value();
    let function = &mut program["functions"][1];
    let output = &mut function["outputs"][3];
    assert_eq!(output["name"], "swing_dot_d_push");
    output["columns"] = 3.into();
    output["column_names"] = serde_json::json!([]);
    assert_message(
        &refused(&program.to_string()),
        "model, rates, output `swing_dot_d_push`: found 3 noise inputs, expected no more than the 2 \
         moving states, so that their Jacobian fits the matrix that a filter keeps; combine",
    );
}

#[test]
fn a_form_at_the_origin_that_does_not_fit() {
    let at_origin = |function: &str| {
        let mut program = pendulum_value();
        program["model"]["rates"]["jacobian_at_origin"] = function.into();
        refused(&program.to_string())
    };
    assert_message(
        &at_origin("rates"),
        "test.json: model, rates, jacobian_at_origin: found the function `rates`, expected a \
         function of the program; name one of the functions",
    );
    assert_message(
        &at_origin("swing_rates_jacobian"),
        "test.json: model, rates, jacobian_at_origin: found the function `swing_rates_jacobian` of \
         the group `swing`, expected functions of parameters and inputs alone; put zeros in the \
         place of the moving states, and take the group out of the function",
    );
    assert_message(
        &at_origin("bob_place_at_origin"),
        "found the function `bob_place_at_origin` with the outputs `bob`, `bob_d_swing`, \
         `bob_d_rod`, expected those of `swing_rates_jacobian`: `swing_dot`, `swing_dot_d_swing`, \
         `swing_dot_d_rod`, `swing_dot_d_push`; give both functions the same outputs in the same \
         order",
    );

    let edited = |edit: &dyn Fn(&mut serde_json::Value)| {
        let mut program = pendulum_value();
        let function = &mut program["functions"][6];
        assert_eq!(function["name"], "swing_rates_at_origin");
        edit(function);
        refused(&program.to_string())
    };
    assert_message(
        &edited(&|function| {
            function["inputs"][1]["group"] = "push".into();
        }),
        "model, rates, jacobian_at_origin: found the function `swing_rates_at_origin` of the group \
         `push`, expected functions of parameters and inputs alone; add the group",
    );
    assert_message(
        &edited(&|function| {
            function["outputs"][2]["columns"] = 3.into();
            function["outputs"][2]["column_names"] = serde_json::json!([]);
        }),
        "model, rates, jacobian_at_origin: found the output `swing_dot_d_rod` (2 rows, 3 columns, 0 \
         nonzeros), expected 2 rows and 2 columns; keep the rows and columns of the full form",
    );
    assert_message(
        &edited(&|function| {
            function["outputs"][3]["nonzeros"][0] = serde_json::json!([0, 0]);
        }),
        "model, rates, jacobian_at_origin, output `swing_dot_d_push`: found a nonzero at row 0, \
         column 0, expected nonzeros only where `swing_rates_jacobian` has them; sparsify",
    );
}

#[test]
fn a_missing_jacobian_of_a_dependence() {
    let mut program = pendulum_value();
    program["model"]["rates"]["jacobian_at_origin"] = serde_json::Value::Null;
    let function = &mut program["functions"][1];
    assert_eq!(function["outputs"][2]["name"], "swing_dot_d_rod");
    function["outputs"].as_array_mut().unwrap().remove(2);
    let instructions = function["instructions"].as_array_mut().unwrap();
    instructions.retain(|instruction| instruction[0] != "output" || instruction[1] != 2);
    for instruction in instructions
        .iter_mut()
        .filter(|i| i[0] == "output" && i[1] == 3)
    {
        instruction[1] = 2.into();
    }
    assert_message(
        &refused(&program.to_string()),
        "model, rates: found no `swing_dot_d_rod` in `swing_rates_jacobian`, although \
         `swing_rates` depends on `rod`, expected the output `swing_dot_d_rod`; add that Jacobian",
    );
}

/// Sizes that no program has are refused before anything of that size is made.
#[test]
fn absurd_sizes() {
    let text = one_function(1, 1, r#"["input",0,0,0],["output",0,0,0]"#);
    for size in ["18446744073709551615", "1000000000000000000", "1000001"] {
        assert_message(
            &refused(&text.replace(r#""work_size":16"#, &format!(r#""work_size":{size}"#))),
            &format!(
                "test.json: function `f`: found a work vector of {size} scalars, expected at most \
                 1000000"
            ),
        );
        let rows = text.replace(r#""rows":1"#, &format!(r#""rows":{size}"#));
        let message = format!(
            "test.json: function `f`, output `y0`: found {size} rows and 1000000000000 columns, \
             expected at most 16777216 elements"
        );
        let both = rows.replace(r#""columns":1"#, r#""columns":1000000000000"#);
        assert_message(&refused(&both), &message);
    }
    let negative = text.replace(r#""work_size":16"#, r#""work_size":-1"#);
    assert_message(
        &refused(&negative),
        "test.json: not a program: invalid value: integer `-1`",
    );
}

/// More instructions than a compiler takes.
#[test]
fn too_many_instructions() {
    let many = vec![r#"["input",0,0,0]"#; gyrocal_codegen::program::MOST_INSTRUCTIONS].join(",");
    let text = one_function(1, 1, &format!(r#"{many},["output",0,0,0]"#));
    assert_message(
        &refused(&text),
        "test.json: function `f`: found 1000001 instructions, expected at most 1000000, what a \
         compiler can take; split the function",
    );
}

#[test]
fn external_functions_that_cannot_be_called() {
    let with = |external: &str| {
        let text = one_function(
            1,
            1,
            r#"["input",0,0,0],["call",1,"lift",0],["output",0,0,1]"#,
        );
        text.replace(
            r#""model":null"#,
            &format!(r#""model":null,"externals":[{external}]"#),
        )
    };
    let cases = [
        (
            r#"{"name":"lift","path":"crate::drag","doc":"","arguments":1}"#,
            "external function `lift`: found the path `crate::drag`, expected a path that ends in \
             its name, such as `crate::lift`",
        ),
        (
            r#"{"name":"lift","path":"crate::lift","doc":"","arguments":5}"#,
            "external function `lift`: found 5 arguments, expected 1 to 4",
        ),
        (
            r#"{"name":"lift","path":"crate::lift","doc":"","arguments":2}"#,
            "function `f`, instruction 1: found 1 arguments of `lift`, expected 2",
        ),
        (
            r#"{"name":"Lift","path":"crate::Lift","doc":"","arguments":1}"#,
            "external functions: found the name `Lift`, expected lower-case words",
        ),
        (
            r#"{"name":"x_index","path":"crate::x_index","doc":"","arguments":1},
               {"name":"f","path":"crate::f","doc":"","arguments":1},
               {"name":"lift","path":"crate::lift","doc":"","arguments":1}"#,
            "function `f`: found the name `f`, expected a name of a Rust item that external \
             function `f` does not take",
        ),
    ];
    for (external, expected) in cases {
        assert_message(&refused(&with(external)), expected);
    }
}

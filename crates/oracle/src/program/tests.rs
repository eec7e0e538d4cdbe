use super::*;

/// y = (a / b, 7), z = sin(a) of (a, b); `{instructions}` is what a test fills in.
const TEMPLATE: &str = r#"{
 "schema_version": 1, "name": "small", "doc": "", "casadi_version": "0", "model": null,
 "groups": [{"name": "u", "doc": "", "elements": [{"name": "a", "id": "", "unit": "1", "doc": ""}]},
            {"name": "v", "doc": "", "elements": [{"name": "b", "id": "", "unit": "1", "doc": ""}]}],
 "functions": [{"name": "f", "doc": "", "source": "", "domain": "",
  "inputs": [{"group": "u"}, {"group": "v"}],
  "outputs": [{"name": "y", "doc": "", "unit": "1", "rows": 2, "columns": 2,
               "row_names": ["first", "second"], "column_names": [], "nonzeros": [[0,0],[1,1]]},
              {"name": "z", "doc": "", "unit": "1", "rows": 1, "columns": 1,
               "row_names": [], "column_names": [], "nonzeros": [[0,0]]}],
  "work_size": 3, "instructions": [{instructions}]}]}"#;

const INSTRUCTIONS: &str = r#"["input", 0, 0, 0], ["input", 1, 1, 0], ["div", 2, 0, 1],
 ["output", 0, 0, 2], ["const", 2, 7.0], ["output", 0, 1, 2], ["sin", 2, 0], ["output", 1, 0, 2]"#;

fn read(instructions: &str) -> Result<Program, OracleError> {
    Program::from_json(&TEMPLATE.replace("{instructions}", instructions))
}

#[test]
fn a_program_is_read_and_run() {
    let program = read(INSTRUCTIONS).unwrap();
    let function = program.function("f").unwrap();
    let flat = function.evaluate(&[0.5, 4.0]).unwrap();
    assert_eq!(flat, [0.125, 7.0, 0.5_f64.sin()]);
    let dense = function.dense_outputs(&flat, 0.0);
    assert_eq!(dense[0], [0.125, 0.0, 0.0, 7.0]);
    assert_eq!(function.outputs[0].row_name(1), "second");
    assert_eq!(function.outputs[0].column_name(1), "1");
}

#[test]
fn an_output_that_is_never_written_agrees_with_nothing() {
    let program = read(r#"["const", 0, 1.0], ["output", 0, 0, 0]"#).unwrap();
    let flat = program
        .function("f")
        .unwrap()
        .evaluate(&[0.0, 0.0])
        .unwrap();
    assert!(flat[1].is_nan() && flat[2].is_nan());
}

#[test]
fn every_operation_of_the_schema_does_what_its_name_says() {
    let at = |operation: &str, operands: &str| {
        let program = read(&format!(
            r#"["input", 0, 0, 0], ["input", 1, 1, 0], ["{operation}", 2, {operands}], ["output", 1, 0, 2]"#
        ))
        .unwrap();
        program
            .function("f")
            .unwrap()
            .evaluate(&[0.75, -2.0])
            .unwrap()[2]
    };
    // Expected values to 16 digits, worked out outside this crate.
    let unary = [
        ("neg", -0.75),
        ("sq", 0.5625),
        ("twice", 1.5),
        ("inv", 1.333_333_333_333_333_3),
        ("sqrt", 0.866_025_403_784_438_6),
        ("exp", 2.117_000_016_612_675),
        ("log", -0.287_682_072_451_780_9),
        ("sin", 0.681_638_760_023_334_1),
        ("cos", 0.731_688_868_873_820_9),
        ("tan", 0.931_596_459_944_072_5),
        ("asin", 0.848_062_078_981_481),
        ("acos", 0.722_734_247_813_415_7),
        ("atan", 0.643_501_108_793_284_4),
        ("sinh", 0.822_316_731_935_829_9),
        ("cosh", 1.294_683_284_676_844_7),
        ("tanh", 0.635_148_952_387_287_3),
        ("abs", 0.75),
        ("sign", 1.0),
        ("not", 0.0),
        ("copy", 0.75),
    ];
    let binary = [
        ("add", -1.25),
        ("sub", 2.75),
        ("mul", -1.5),
        ("div", -0.375),
        ("pow", 1.777_777_777_777_777_7),
        ("atan2", 2.782_821_983_319_221),
        ("min", -2.0),
        ("max", 0.75),
        ("lt", 0.0),
        ("le", 0.0),
        ("eq", 0.0),
        ("ne", 1.0),
        ("and", 1.0),
        ("or", 1.0),
        ("if_else_zero", -2.0),
    ];
    let cases = unary.map(|(name, value)| (name, "0", value)).into_iter();
    for (name, operands, expected) in cases.chain(binary.map(|(name, value)| (name, "0, 1", value)))
    {
        let error = (at(name, operands) - expected).abs();
        // Both sides rounded once: one unit in the last place of numbers below 4.
        assert!(error <= 5e-16, "{name}: off by {error:e}");
    }
    for (name, expected) in [("abs", 2.0), ("sign", -1.0)] {
        assert_eq!(at(name, "1"), expected, "{name}");
    }
}

#[test]
fn what_cannot_be_run_is_refused_when_read() {
    for (instructions, says) in [
        (r#"["input", 3, 0, 0]"#, "3 is beyond the work vector of 3"),
        (r#"["input", 0, 1, 1]"#, "1 is beyond the vector of 1"),
        (
            r#"["output", 2, 0, 0]"#,
            "2 is beyond the list of vectors of 2",
        ),
        (r#"["frobnicate", 0, 0]"#, "unknown operation `frobnicate`"),
        (r#"["add", 0, 0]"#, "unknown operation `add`"),
        (r#"["const", 0]"#, "no constant"),
    ] {
        let message = read(instructions).unwrap_err().to_string();
        assert!(message.contains("function `f`, instruction 0"), "{message}");
        assert!(message.contains(says), "{message}");
    }
    let other = TEMPLATE.replace(r#""schema_version": 1"#, r#""schema_version": 2"#);
    let message = Program::from_json(&other.replace("{instructions}", ""))
        .unwrap_err()
        .to_string();
    assert_eq!(message, "program `small` has schema version 2, expected 1");
    let program = read(INSTRUCTIONS).unwrap();
    assert!(
        program
            .function("g")
            .unwrap_err()
            .to_string()
            .contains("`g`")
    );
    let message = program.functions[0]
        .evaluate(&[1.0])
        .unwrap_err()
        .to_string();
    assert_eq!(message, "function `f` takes 2 scalars, 1 were given");
}

//! Tables of a program: what is emitted for them, and which are refused.
#![cfg(test)]

mod common;

use common::{header, one_function};
use gyrocal_codegen::{Program, emit_module};

/// A program of one function with a table of these fields and rows, as JSON.
fn program(row: &str, fields: &str, rows: &str) -> String {
    let function = one_function(1, 1, r#"["input",0,0,0],["output",0,0,0]"#);
    let table = format!(
        r#""tables":[{{"name":"planets","row":"{row}","doc":"Planets with \"seas\".",
            "fields":[{fields}],"rows":[{rows}]}}],"model":null"#
    );
    function.replace(r#""model":null"#, &table)
}

const FIELDS: &str = r#"{"name":"id","doc":"its name"},{"name":"mass","doc":"of the Earth"},
    {"name":"has_air","doc":""},{"name":"moons","doc":"by name"}"#;

#[test]
fn a_table_becomes_a_struct_and_a_static_array() {
    let rows = r#"["earth",1.0,true,["moon"]],["mars",0.107,true,["phobos","deimos"]],
        ["mercury",-0.5,false,[]]"#;
    let program = Program::from_json(&program("Planet", FIELDS, rows), "test.json").unwrap();
    let emitted = emit_module(&program, &header()).unwrap();
    for expected in [
        "/// A row of [`PLANETS`].\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Planet {\n    \
         /// Its name.\n    pub id: &'static str,\n",
        "pub mass: f64,",
        "pub has_air: bool,",
        "pub moons: &'static [&'static str],",
        "/// Planets with \"seas\".\npub static PLANETS: [Planet; 3] = [",
        "id: \"mars\",\n        mass: 1.07e-1,\n        has_air: true,\n        \
         moons: &[\"phobos\", \"deimos\"],",
        "mass: -5e-1,",
        "moons: &[],",
    ] {
        assert!(
            emitted.contains(expected),
            "{expected}\nis not in\n{emitted}"
        );
    }
}

#[test]
fn faulty_tables_are_refused_with_their_place() {
    let cases = [
        (
            program("planet", FIELDS, r#"["earth",1.0,true,[]]"#),
            "table `planets`: found the name `planet`, expected a Rust type name",
        ),
        (
            program("Planet", r#"{"name":"Mass","doc":""}"#, "[1.0]"),
            "table `planets`, fields: found the name `Mass`",
        ),
        (
            program("Planet", FIELDS, ""),
            "table `planets`: found 4 fields and 0 rows, expected one of each at least",
        ),
        (
            program("Planet", FIELDS, r#"["earth",1.0,true]"#),
            "table `planets`, row 0: found 3 values, expected 4, one for each field",
        ),
        (
            program(
                "Planet",
                FIELDS,
                r#"["earth",1.0,true,[]],["mars","light",true,[]]"#,
            ),
            "table `planets`, row 1, field `mass`: found Text(\"light\"), expected Number, as in \
             the first row",
        ),
        (
            program("Planet", FIELDS, r#"["earth",null,true,[]]"#),
            "table `planets`, row 0: found null, expected text, a finite number",
        ),
        (
            program("Planet", FIELDS, r#"["earth",1.0,true,[1]]"#),
            "table `planets`, row 0: found [1], expected text, a finite number",
        ),
        (
            program("X", FIELDS, r#"["earth",1.0,true,[]]"#),
            "table `planets`: found the name `X`, expected a name of a Rust item that group `x`",
        ),
    ];
    for (text, expected) in cases {
        let refused = Program::from_json(&text, "test.json")
            .and_then(|program| emit_module(&program, &header()));
        let message = refused.expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}\nhas no\n{expected}");
    }
}

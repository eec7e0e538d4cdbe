//! The command line of `cargo figures`, and that `cargo test` builds the program, which the gate runs.

#![cfg(test)]

use std::process::Command;

/// Exit code, stdout and stderr of the program.
fn figures(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gyrocal-figures"))
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn a_part_that_no_topic_has_is_told_with_those_that_it_has() {
    let (code, out, error) = figures(&["doors", "--part", "nothing"]);
    assert_eq!((code, &*out), (Some(1), ""));
    assert!(error.contains("doors has no part `nothing`"), "{error}");
    assert!(error.contains("structure, answers"), "{error}");
}

#[test]
fn slow_sections_have_a_list_and_stamps_of_those_alone() {
    let (code, out, _) = figures(&["section", "--all"]);
    assert_eq!(code, Some(0));
    assert!(out.lines().any(|name| name == "firmware"), "{out}");
    let (code, _, error) = figures(&["section", "--passed", "nothing"]);
    assert_eq!(code, Some(1));
    assert!(
        error.contains("no slow section is called `nothing`"),
        "{error}"
    );
}

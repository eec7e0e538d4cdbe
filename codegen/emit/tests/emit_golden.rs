//! The emitted module of a small program, byte by byte.
#![cfg(test)]

mod common;

use common::{header, pendulum, read};
use gyrocal_codegen::{Error, Options, Program, emit_module, emit_module_with};

/// Set to write the snapshot instead of comparing it.
const UPDATE: &str = "GYROCAL_UPDATE_SNAPSHOTS";

#[test]
fn a_small_program_gives_the_committed_module() {
    let emitted = emit_module(&pendulum(), &header()).unwrap();
    let path = common::path("tests/data/pendulum/pendulum.rs");
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(&path, &emitted).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let difference = emitted
        .lines()
        .zip(committed.lines())
        .find(|(new, old)| new != old);
    assert!(
        emitted == committed,
        "{} differs from what is emitted, first at {difference:?}; if that is meant, run \
         `{UPDATE}=1 cargo test -p gyrocal-codegen --test emit_golden` and look at the change",
        path.display()
    );
}

/// The trait has a default for it.
#[test]
fn a_model_without_a_form_at_the_origin_has_no_method_for_it() {
    let mut program: serde_json::Value =
        serde_json::from_str(&read("tests/data/pendulum/pendulum.json")).unwrap();
    for part in ["rates", "output"] {
        let functions = program["model"][part].as_object_mut().unwrap();
        assert!(functions.remove("jacobian_at_origin").is_some());
    }
    let program = Program::from_json(&program.to_string(), "test.json").unwrap();
    let emitted = emit_module(&program, &header()).unwrap();
    assert!(emitted.contains("fn rates_jacobian("));
    assert!(!emitted.contains("jacobian_at_origin"));
}

/// Every map of the emitter that is hashed has its own random state, so an order that leaks
/// into the text differs between two runs.
#[test]
fn the_same_program_gives_the_same_bytes() {
    let platform = || {
        let program = common::program("../../src/generated/platform.json");
        emit_module(&program, &header()).unwrap()
    };
    assert_eq!(platform(), platform());
}

/// The names of groups and elements must not move any operation.
#[test]
fn names_do_not_change_the_operations() {
    let costs = |text: &str| -> Vec<String> {
        text.lines()
            .filter(|line| line.contains("multiplication"))
            .map(str::to_owned)
            .collect()
    };
    let original = read("tests/data/pendulum/pendulum.json");
    let renamed = original
        .replace("\"angle\"", "\"zeta\"")
        .replace("\"swing\"", "\"alpha\"");
    let emit = |text: &str| {
        // The Jacobians carry the name of the group.
        let text = text
            .replace("_d_swing", "_d_alpha")
            .replace("\"swing\"", "\"alpha\"");
        let program = gyrocal_codegen::Program::from_json(&text, "renamed.json").unwrap();
        emit_module(&program, &header()).unwrap()
    };
    let costs_of_original = costs(&emit(&original));
    assert!(!costs_of_original.is_empty());
    assert_eq!(costs_of_original, costs(&emit(&renamed)));
}

#[test]
fn an_extension_can_name_another_crate() {
    let emit = |scalar_crate: &str| {
        let mut options = Options::default();
        options.scalar_crate = scalar_crate.to_owned();
        emit_module_with(&pendulum(), &header(), &options)
    };
    assert!(
        emit("gyrocal::scalar")
            .unwrap()
            .contains("use ::gyrocal::scalar::{Element, Model")
    );
    assert!(
        emit("crate::scalar")
            .unwrap()
            .contains("use crate::scalar::{Element, Model")
    );
    let error = emit("not a path").unwrap_err();
    assert!(matches!(error, Error::Option { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "options, scalar_crate: found `not a path`, expected a path such as `gyrocal_scalar` or \
         `crate::scalar`; change the caller of gyrocal-codegen"
    );
}

#[test]
fn a_header_cannot_smuggle_in_code() {
    let mut header = header();
    header.source = "here\nfn main() {}".to_owned();
    let error = emit_module(&pendulum(), &header).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("header, source: found `here\nfn main() {}`"),
        "{error}"
    );
}

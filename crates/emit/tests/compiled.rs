//! Emitted files compile by themselves, and their tests pass.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test may stop at what must not happen"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gyrocal_emit::{Emission, EmitError, Extension, Number};
use gyrocal_record::{ModelFile, ParameterEstimate};

/// The module that the example package has derived, which has one effect.
const MODULE: &str = include_str!("../../../examples/extended/src/generated/extended.rs");
const EFFECT: &str = "gyro_y.g_z";

fn model() -> ModelFile {
    let estimate = ParameterEstimate {
        parameter: EFFECT.to_owned(),
        value: 0.02,
        sigma: 0.05,
    };
    ModelFile {
        effects: vec![EFFECT.to_owned()],
        estimates: vec![estimate],
        ..ModelFile::default()
    }
}

fn emitted(number: Number, extended: bool) -> String {
    let model = model();
    let extension = Extension {
        model: &model,
        name: "extended",
        module: MODULE,
    };
    let extension = extended.then_some(extension);
    Emission { number, extension }.write().unwrap()
}

fn rustc(file: &Path, arguments: &[&str]) -> Output {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let mut command = Command::new(compiler);
    command.args(["--edition", "2024", "--deny", "warnings"]);
    command.args(arguments).arg(file);
    command
        .current_dir(file.parent().unwrap())
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    let (out, err) = (&output.stdout, &output.stderr);
    format!(
        "{}{}",
        String::from_utf8_lossy(out),
        String::from_utf8_lossy(err)
    )
}

/// Compiles a file with its tests and runs them.
fn run_tests(text: &str) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let file: PathBuf = folder.path().join("filter.rs");
    std::fs::write(&file, text).unwrap();
    let compiled = rustc(&file, &["--test", "-Copt-level=1", "-o", "tests"]);
    assert!(compiled.status.success(), "{}", said(&compiled));
    Command::new(folder.path().join("tests")).output().unwrap()
}

fn passes(number: Number, extended: bool) {
    let text = emitted(number, extended);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("filter.rs");
    std::fs::write(&file, &text).unwrap();
    let library = rustc(&file, &["--crate-type", "lib", "--emit", "metadata"]);
    assert!(library.status.success(), "{}", said(&library));
    let tests = run_tests(&text);
    assert!(tests.status.success(), "{}", said(&tests));
}

#[test]
fn the_nominal_filter_in_f32() {
    passes(Number::F32, false);
}

#[test]
fn the_nominal_filter_in_f64() {
    passes(Number::F64, false);
}

#[test]
fn an_extended_filter_in_f32() {
    passes(Number::F32, true);
}

#[test]
fn an_extended_filter_in_f64() {
    passes(Number::F64, true);
}

#[test]
fn a_changed_step_fails_the_tests_of_the_file() {
    // The spectral density of the noise of the drift, by a hundredth.
    let text = emitted(Number::F32, false);
    let held = "const HELD_S: f64 = 60.0;";
    assert_eq!(text.matches(held).count(), 1);
    let tests = run_tests(&text.replace(held, "const HELD_S: f64 = 60.6;"));
    assert!(!tests.status.success());
    assert!(said(&tests).contains("parameter"), "{}", said(&tests));
}

#[test]
fn a_module_of_another_model_is_refused() {
    let model = model();
    let extension = Extension {
        model: &model,
        name: "other",
        module: MODULE,
    };
    let emission = Emission {
        number: Number::F32,
        extension: Some(extension),
    };
    assert!(matches!(emission.write(), Err(EmitError::Module { .. })));
}

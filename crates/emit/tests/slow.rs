//! Emitted files compile by themselves, and their tests pass.
#![cfg(test)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gyrocal_emit::{Emission, Extension, Number};
use gyrocal_record::{Gyros, ModelFile, ParameterEstimate};

/// The module that the example package has derived, which has one effect.
const MODULE: &str = include_str!("../../../examples/extended/src/generated/extended.rs");
const EFFECT: &str = "gyro_y.g_z";
/// That of a strapdown unit, which has two effects.
const UNIT_MODULE: &str = include_str!("../../../examples/extended/src/generated/unit.rs");
const UNIT_EFFECTS: [&str; 2] = ["gyro_y.ramp", "accel_x.ramp"];

/// The filter in a file.
#[derive(Clone, Copy)]
enum Kind {
    Nominal,
    Extended,
    Strapdown,
}

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

fn unit_model() -> ModelFile {
    ModelFile {
        gyros: Gyros::Strapdown,
        effects: UNIT_EFFECTS.map(str::to_owned).to_vec(),
        ..ModelFile::default()
    }
}

fn emitted(number: Number, kind: Kind) -> String {
    let (model, unit) = (model(), unit_model());
    let extension = match kind {
        Kind::Nominal => None,
        Kind::Extended => Some(Extension {
            model: &model,
            name: "extended",
            module: MODULE,
        }),
        Kind::Strapdown => Some(Extension {
            model: &unit,
            name: "unit",
            module: UNIT_MODULE,
        }),
    };
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

fn passes(number: Number, kind: Kind) {
    let text = emitted(number, kind);
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
    passes(Number::F32, Kind::Nominal);
}

#[test]
fn the_nominal_filter_in_f64() {
    passes(Number::F64, Kind::Nominal);
}

#[test]
fn an_extended_filter_in_f32() {
    passes(Number::F32, Kind::Extended);
}

#[test]
fn an_extended_filter_in_f64() {
    passes(Number::F64, Kind::Extended);
}

#[test]
fn the_filter_of_a_strapdown_unit_in_f32() {
    passes(Number::F32, Kind::Strapdown);
}

#[test]
fn the_filter_of_a_strapdown_unit_in_f64() {
    passes(Number::F64, Kind::Strapdown);
}

#[test]
fn other_axes_fail_the_tests_of_the_file() {
    let text = emitted(Number::F64, Kind::Strapdown);
    let own =
        "take_turning(interval_s, [&axes(row as Number - 0.5), &axes(row as Number)], sample)";
    assert_eq!(text.matches(own).count(), 1);
    let tests = run_tests(&text.replace(own, "take(interval_s, sample)"));
    assert!(!tests.status.success());
}

#[test]
fn a_changed_step_fails_the_tests_of_the_file() {
    // The spectral density of the noise of the drift, by a hundredth.
    let text = emitted(Number::F32, Kind::Nominal);
    let held = "const HELD_S: f64 = 60.0;";
    assert_eq!(text.matches(held).count(), 1);
    let tests = run_tests(&text.replace(held, "const HELD_S: f64 = 60.6;"));
    assert!(!tests.status.success());
    assert!(said(&tests).contains("parameter"), "{}", said(&tests));
}

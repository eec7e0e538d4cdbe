//! The program in which functions of several generators are timed: its source, its build.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_codegen::{Header, Options, Program, emit_module_with};

use super::Form;
use crate::error::Error;
use crate::kernel::instructions::{cargo, output, root};
use crate::kernel::speed::has_x86_64_v3;

const PEERS: &str = include_str!("../peers.py");

/// A program with the functions of every generator.
pub(super) struct Contest {
    pub(super) program: PathBuf,
    /// The processor that it is built for.
    pub(super) target: &'static str,
}

/// Functions by the other generators, and the program without ours; returns its directory.
pub(super) fn written(directory: &Path, python: &Path) -> Result<PathBuf, Error> {
    let source = directory.join("race");
    std::fs::create_dir_all(source.join("src"))?;
    let script = directory.join("peers.py");
    std::fs::write(&script, PEERS)?;
    let exporter = root().join("codegen/emit/exporter");
    let mut command = Command::new(python);
    command.arg(&script).arg(exporter).arg(source.join("src"));
    output(&mut command)?;
    Ok(source)
}

/// Adds our functions in a form, and builds the program.
pub(super) fn built(source: &Path, form: Form) -> Result<Contest, Error> {
    let text = std::fs::read_to_string(source.join("src/ours.json"))?;
    let header = Header {
        rebuild_command: "cargo figures kernel --part generator".into(),
        source: "peers.py".into(),
        fingerprint: "none".into(),
    };
    let mut options = Options::default();
    options.fused_multiply_add = form == Form::Fused;
    let program = Program::from_json(&text, "ours.json")?;
    let module = emit_module_with(&program, &header, &options)?;
    std::fs::write(source.join("src/ours.rs"), module)?;
    let target = if has_x86_64_v3() {
        "x86-64-v3"
    } else {
        "native"
    };
    let (object, library) = (
        source.join("casadi_peer.o"),
        source.join("libcasadi_peer.a"),
    );
    output(
        Command::new("gcc")
            .args(["-O3", &format!("-march={target}"), "-c", "-o"])
            .args([&object, &source.join("src/casadi_peer.c")]),
    )?;
    output(Command::new("ar").arg("rcs").args([&library, &object]))?;
    let scalar = root().join("crates/scalar").canonicalize()?;
    let features = match form {
        Form::Fused => ", features = [\"fused\"]",
        Form::EqualBits => "",
    };
    std::fs::write(
        source.join("Cargo.toml"),
        format!(
            "[package]\nname = \"race\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
             [dependencies]\ngyrocal-scalar = {{ path = {scalar:?}{features} }}\n\
             nalgebra = \"0.35\"\n\n[profile.release]\ncodegen-units = 1\n\n[workspace]\n"
        ),
    )?;
    output(
        Command::new(cargo())
            .current_dir(source)
            .args(["build", "--release", "--quiet"])
            .env("CARGO_TARGET_DIR", source.join("target"))
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env(
                "RUSTFLAGS",
                format!("-C target-cpu={target} -L native={}", source.display()),
            ),
    )?;
    let program = source
        .join("target/release")
        .join(form.name().replace(' ', "_"));
    std::fs::rename(source.join("target/release/race"), &program)?;
    Ok(Contest { program, target })
}

//! The program in which functions of several generators are timed: its source, its build.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_codegen::{Header, Options, Program, emit_module_with};

use super::Form;
use crate::error::Error;
use crate::kernel::instructions::{cargo, output, root};
use crate::kernel::times::has_x86_64_v3;

const PEERS: &str = include_str!("../peers.py");

/// Functions by the other generators, and the program without ours; returns its directory.
pub(super) fn written(directory: &Path, python: &Path) -> Result<PathBuf, Error> {
    let source = directory.join("race");
    std::fs::create_dir_all(source.join("src"))?;
    let script = directory.join("peers.py");
    std::fs::write(&script, PEERS)?;
    let exporter = root().join("codegen/emit/exporter");
    let mut command = Command::new(python);
    output(command.arg(&script).arg(exporter).arg(source.join("src")))?;
    Ok(source)
}

/// Adds our functions in a form, and builds the program; returns its path, and the processor that it is built for.
pub(super) fn built(source: &Path, form: Form) -> Result<(PathBuf, &'static str), Error> {
    let header = Header {
        rebuild_command: "cargo figures kernel --part generator".into(),
        source: "peers.py".into(),
        fingerprint: "none".into(),
    };
    let mut options = Options::default();
    options.fused_multiply_add = form == Form::Fused;
    let text = std::fs::read_to_string(source.join("src/ours.json"))?;
    let program = Program::from_json(&text, "ours.json")?;
    let module = emit_module_with(&program, &header, &options)?;
    std::fs::write(source.join("src/ours.rs"), module)?;
    let (target, features) = (
        if has_x86_64_v3() {
            "x86-64-v3"
        } else {
            "native"
        },
        if form == Form::Fused { "\"fused\"" } else { "" },
    );
    let object = source.join("casadi_peer.o");
    let mut gcc = Command::new("gcc");
    gcc.args(["-O3", &format!("-march={target}"), "-c", "-o"]);
    output(gcc.args([&object, &source.join("src/casadi_peer.c")]))?;
    let library = source.join("libcasadi_peer.a");
    output(Command::new("ar").arg("rcs").args([&library, &object]))?;
    let scalar = root().join("crates/scalar").canonicalize()?;
    std::fs::write(
        source.join("Cargo.toml"),
        format!(
            "[package]\nname = \"race\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
             [dependencies]\ngyrocal-scalar = {{ path = {scalar:?}, features = [{features}] }}\n\
             nalgebra = \"0.35\"\n\n[profile.release]\ncodegen-units = 1\n\n[workspace]\n"
        ),
    )?;
    let flags = format!("-C target-cpu={target} -L native={}", source.display());
    output(
        Command::new(cargo())
            .current_dir(source)
            .args(["build", "--release", "--quiet"])
            .env("CARGO_TARGET_DIR", source.join("target"))
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env("RUSTFLAGS", flags),
    )?;
    let folder = source.join("target/release");
    let program = folder.join(form.name().replace(' ', "_"));
    std::fs::rename(folder.join("race"), &program)?;
    Ok((program, target))
}

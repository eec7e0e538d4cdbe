//! Puts the Rust of the model files into `OUT_DIR`: the committed copies if they are fresh, otherwise
//! derived with CasADi from the physics of the `gyrocal` that is linked.

use gyrocal_codegen::build::{Error, Outcome, Variant};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for file in ["extended.model.toml", "unit.model.toml"] {
        match build(file) {
            Ok(outcome) => print!("{}", outcome.cargo_lines()),
            Err(error) => {
                eprintln!("{error}");
                std::process::exit(1);
            }
        }
    }
}

fn build(file: &str) -> Result<Outcome, Error> {
    let out_dir = std::env::var_os("OUT_DIR").unwrap_or_default();
    Variant::of_dependency("gyrocal", file)?
        .committed("src/generated")
        .build(out_dir)
}

//! Puts the Rust of `extended.model.toml` into `OUT_DIR`: the committed copy if it is fresh,
//! otherwise derived with CasADi from the physics of the `gyrocal` that is linked.

use gyrocal_codegen::build::{Error, Outcome, Variant};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    match build() {
        Ok(outcome) => print!("{}", outcome.cargo_lines()),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}

fn build() -> Result<Outcome, Error> {
    let out_dir = std::env::var_os("OUT_DIR").unwrap_or_default();
    Variant::of_dependency("gyrocal", "extended.model.toml")?
        .committed("src/generated")
        .build(out_dir)
}

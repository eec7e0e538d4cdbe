//! Decides which model is compiled: the committed one, or, when the derivation was edited
//! (and feature `derive` is on), one that CasADi derives now. See `gyrocal_codegen::build`.

use std::path::{Path, PathBuf};

fn main() {
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let derivation = package.join("codegen").join("derive");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(gyrocal_rederived)");
    // Packages that embed an extended filter find the physics of this version by it.
    println!("cargo::metadata=derive={}", derivation.display());
    freshen(&derivation);
}

#[cfg(feature = "derive")]
fn freshen(derivation: &Path) {
    use gyrocal_codegen::build::Derivation;

    let out_dir = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    match Derivation::open(derivation).and_then(|derivation| derivation.build(&out_dir)) {
        Ok(outcome) => print!("{}", outcome.cargo_instructions("gyrocal_rederived")),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}

#[cfg(not(feature = "derive"))]
fn freshen(_derivation: &Path) {}

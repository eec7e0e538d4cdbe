//! Compiles the committed Rust of the model, or derives it again if `derive` was edited.

use gyrocal_codegen::build::Derivation;

fn main() {
    let out_dir = std::env::var_os("OUT_DIR").unwrap_or_default();
    match Derivation::open("derive").and_then(|derivation| derivation.build(out_dir)) {
        Ok(outcome) => print!("{}", outcome.cargo_instructions("rederived")),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}

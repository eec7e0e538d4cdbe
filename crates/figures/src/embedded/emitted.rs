//! Files of `gyrocal emit`, compiled for the target.

use std::fs;

use gyrocal_emit::{Emission, Extension, Number};
use gyrocal_record::ModelFile;

use super::target::Tools;
use crate::harness::{Error, Figure};
use crate::kernel::instructions::root;

const MANIFEST: &str = "[package]\nname = \"gyrocal-emitted\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
                        [profile.release]\npanic = \"abort\"\n\n[workspace]\n";
const LOCK: &str = "version = 4\n\n[[package]]\nname = \"gyrocal-emitted\"\nversion = \"0.0.0\"\n";
/// The effect of the example package, whose derived module is committed.
const EFFECT: &str = "gyro_y.g_z";

/// One figure for each kind of file.
pub(super) fn figures(tools: &Tools) -> Result<Vec<Figure>, Error> {
    let module = root().join("examples/extended/src/generated/extended.rs");
    let module = fs::read_to_string(module)?;
    let model = ModelFile {
        effects: vec![EFFECT.to_owned()],
        ..ModelFile::default()
    };
    let extension = Extension {
        model: &model,
        name: "extended",
        module: &module,
    };
    let mut figures = Vec::new();
    for (kind, extension) in [("nominal", None), ("extended", Some(extension))] {
        for number in [Number::F32, Number::F64] {
            let text = Emission { number, extension }.write()?;
            let compiled = compiles(tools, &text);
            if let Err(error) = &compiled {
                eprintln!("{error}");
            }
            let name = format!(
                "gyrocal emit, {kind}, {}: compiles for the target",
                number.name()
            );
            figures.push(Figure::truth(&name, compiled.is_ok()));
        }
    }
    Ok(figures)
}

/// Compiles a file for the target, as the library of a package of its own.
fn compiles(tools: &Tools, text: &str) -> Result<(), Error> {
    let package = root().join("target/emitted");
    fs::create_dir_all(package.join("src"))?;
    fs::write(package.join("Cargo.toml"), MANIFEST)?;
    fs::write(package.join("Cargo.lock"), LOCK)?;
    fs::write(package.join("src/lib.rs"), text)?;
    tools.build("target/emitted", &[])?;
    Ok(())
}

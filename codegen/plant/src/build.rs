//! The plant of a package, for its build script.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use gyrocal_codegen::build::{
    CARGO_OFFLINE_VARIABLE, ENVIRONMENTS_VARIABLE, OFFLINE_VARIABLE, PYTHON_VARIABLE, Settings,
    WRITE_VARIABLE,
};

use crate::derive::{derive, model, open};
use crate::error::{Error, at};

/// Start of the line of a generated file that has the fingerprint of its inputs.
const INPUTS: &str = "// Inputs: ";

/// The whole `main` of a build script: derives the plant of a script and writes `plant.rs` into `OUT_DIR`,
/// for `include!`. It has a function `plant()` that returns the loaded plant with generated functions.
///
/// Nothing is derived, and no Python is needed, where `NAME.rs` and `NAME.json` stand beside `NAME.py` and
/// are of the same inputs; with `GYROCAL_CODEGEN_WRITE=1` they are written anew if they are there and
/// stale. Modules that a script imports are no inputs. An error is printed, and the code is 1.
#[must_use]
pub fn build(script: impl AsRef<Path>) -> ExitCode {
    let out_dir = PathBuf::from(std::env::var_os("OUT_DIR").unwrap_or_default());
    match build_in(script.as_ref(), &out_dir) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn build_in(script: &Path, out_dir: &Path) -> Result<(), Error> {
    let committed = ["rs", "json"].map(|form| script.with_extension(form));
    for path in [script, &committed[0], &committed[1]] {
        println!("cargo::rerun-if-changed={}", path.display());
    }
    for variable in [
        CARGO_OFFLINE_VARIABLE,
        ENVIRONMENTS_VARIABLE,
        OFFLINE_VARIABLE,
        PYTHON_VARIABLE,
        WRITE_VARIABLE,
    ] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    let work = out_dir.join("derivation");
    let fingerprint = open(script, &work)?.fingerprint().to_owned();
    let texts = match fresh(&committed, &fingerprint) {
        Some(texts) => texts,
        None => {
            let settings = Settings::from_env();
            let write = settings.write && committed.iter().all(|path| path.exists());
            let derived = derive(script, settings)?;
            let texts = [derived.rust, derived.program];
            if write {
                for (path, text) in committed.iter().zip(&texts) {
                    fs::write(path, text).map_err(at("written", path))?;
                }
            } else if committed[0].exists() {
                println!("cargo::warning={} is stale", committed[0].display());
            }
            texts
        }
    };
    let [rust, program] = &texts;
    let module = format!(
        "/// The functions of the plant.\n#[rustfmt::skip]\n#[allow(missing_docs, unreachable_pub, \
         dead_code, clippy::all, clippy::too_many_lines, reason = \"generated for every use\")]\nmod generated {{\n    include!(concat!(env!(\"OUT_DIR\"), \
         \"/generated.rs\"));\n}}\n\n/// The plant, with generated functions.\n///\n/// # Errors\n/// If \
         the program is not one of a plant.\npub fn plant() -> \
         Result<::gyrocal_plant::LoadedPlant, ::gyrocal_plant::PlantError> {{\n    \
         ::gyrocal_plant::LoadedPlant::parse(include_str!(concat!(env!(\"OUT_DIR\"), \"/plant.json\")), \
         \"plant.json\")?\n        .with_model(generated::{})\n}}\n",
        model(program)?
    );
    let files = [
        ("generated.rs", rust.as_str()),
        ("plant.json", program.as_str()),
        ("plant.rs", &module),
    ];
    for (file, text) in files {
        let path = out_dir.join(file);
        fs::write(&path, text).map_err(at("written", &path))?;
    }
    Ok(())
}

/// The committed files, if they are of these inputs.
fn fresh(committed: &[PathBuf; 2], fingerprint: &str) -> Option<[String; 2]> {
    let [rust, program] = committed;
    let rust = fs::read_to_string(rust).ok()?;
    let inputs = rust.lines().find_map(|line| line.strip_prefix(INPUTS))?;
    (inputs.trim() == fingerprint)
        .then(|| fs::read_to_string(program).ok())
        .flatten()
        .map(|program| [rust, program])
}

//! A package for one plant: its script, a build script that derives it, and a command.

use std::path::{Path, PathBuf};

use gyrocal_codegen::program::is_snake_case;

use crate::error::{Error, at};

/// Where a package takes the libraries from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A tree of gyrocal.
    Path(PathBuf),
    /// Published packages of exactly this version.
    Version(String),
}

/// A file of a new package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackageFile {
    /// Its path in the package.
    pub path: &'static str,
    /// What it is for.
    pub what: &'static str,
    /// Its text.
    pub text: String,
}

/// Files of a new package.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Package {
    /// The files.
    pub files: Vec<PackageFile>,
    /// Where it takes the libraries from.
    pub source: Source,
}

/// Directories of the libraries in a tree.
const LIBRARIES: [(&str, &str); 4] = [
    ("gyrocal-cli", "crates/cli"),
    ("gyrocal-plant", "crates/plant"),
    ("gyrocal-scalar", "crates/scalar"),
    ("gyrocal-plant-codegen", "codegen/plant"),
];

impl Package {
    /// A package of this name with an oscillator to begin with.
    ///
    /// # Errors
    /// [`Error::Package`] if the name is none of a package, or the path has no tree of gyrocal;
    /// [`Error::File`] if the path cannot be found.
    pub fn new(name: &str, source: Source) -> Result<Self, Error> {
        refuse_name(name)?;
        let source = match source {
            Source::Path(path) => Source::Path(tree(&path)?),
            version @ Source::Version(_) => version,
        };
        let dependency = |index: usize, more: &str| {
            let (name, directory) = LIBRARIES[index];
            let from = match &source {
                Source::Path(path) => {
                    let path = path.join(directory);
                    format!("path = \"{}\"", toml_escaped(&path.to_string_lossy()))
                }
                Source::Version(version) => format!("version = \"={version}\""),
            };
            format!("{name} = {{ {from}{more} }}\n")
        };
        let manifest = format!(
            "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\n\
             {}{}{}\n[build-dependencies]\n{}\n# What computes, in `cargo run` as well.\n[profile.dev]\n\
             opt-level = 1\n\n[profile.dev.package.gyrocal-plant]\nopt-level = 3\n\n# No part of a \
             workspace around it.\n[workspace]\n",
            dependency(0, ", default-features = false"),
            dependency(1, ""),
            dependency(2, ""),
            dependency(3, ""),
        );
        let file = |path, what, text: &str| PackageFile {
            path,
            what,
            text: text.to_owned(),
        };
        let files = vec![
            file("Cargo.toml", "the package", &manifest),
            file(".gitignore", "leaves out what is built", "/target\n"),
            file(
                "build.rs",
                "derives the plant",
                include_str!("../package/build.rs"),
            ),
            file(
                "plant.py",
                "the plant: states, parameters, inputs, equations, sensors",
                include_str!("../package/plant.py"),
            ),
            file(
                "columns.toml",
                "columns of your record",
                include_str!("../package/columns.toml"),
            ),
            file(
                "src/main.rs",
                "the command",
                include_str!("../package/main.rs"),
            ),
        ];
        Ok(Self { files, source })
    }
}

/// Crates of Rust, and folders of a build: cargo makes no program of these names.
const TAKEN: [&str; 9] = [
    "alloc",
    "build",
    "core",
    "deps",
    "examples",
    "incremental",
    "proc_macro",
    "std",
    "test",
];

/// Refuses a name of which cargo builds no package.
fn refuse_name(name: &str) -> Result<(), Error> {
    let module = name.to_ascii_lowercase().replace('-', "_");
    let refused = |why: &str| Err(Error::Package(format!("`{name}` {why}")));
    if module == "gyrocal" || module.starts_with("gyrocal_") {
        return refused(
            "is the name of a package of gyrocal, or may become one: give another name",
        );
    }
    if TAKEN.contains(&module.as_str()) {
        return refused("is a name that cargo keeps for itself: give another name, as my-plant");
    }
    match is_snake_case(&module) {
        true => Ok(()),
        false => refused(
            "is no name of a package: give words of letters and digits, joined by - or _, of which the first begins \
             with a letter, and no keyword of Rust",
        ),
    }
}

/// The root of a tree of gyrocal.
fn tree(path: &Path) -> Result<PathBuf, Error> {
    let path = path.canonicalize().map_err(at("read", path))?;
    for (name, directory) in LIBRARIES {
        if !path.join(directory).join("Cargo.toml").is_file() {
            return Err(Error::Package(format!(
                "{} has no {directory}, where {name} is expected: give the root of a tree of gyrocal",
                path.display()
            )));
        }
    }
    Ok(path)
}

fn toml_escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

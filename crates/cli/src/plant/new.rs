//! `gyrocal new-plant`: a package for one plant.

use std::path::PathBuf;

use clap::Args;
use gyrocal_document::{Screen, Standing};
use gyrocal_plant_codegen::{Package, Source};
use gyrocal_record::{printable_path, shell_quoted};
use miette::miette;

use crate::outputs::make_folder;
use crate::{Failure, Reply};

/// Make a package for a plant of your own: its Python script, a build that derives it, a command.
///
/// It begins with an oscillator: write your own equations into plant.py and your columns into columns.toml.
#[derive(Debug, Args)]
pub(crate) struct NewPlantArguments {
    /// The new directory; its last part is the name of the package.
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// A tree of gyrocal that the package is built with, instead of the published packages of this version.
    #[arg(long, value_name = "PATH")]
    gyrocal: Option<PathBuf>,
}

/// Runs the command; returns its answer.
pub(crate) fn run(arguments: &NewPlantArguments) -> Result<Reply, Failure> {
    let name = arguments.name.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        let given = printable_path(&arguments.name);
        Failure::Work(miette!(
            "`{given}` has no name of a package for its last part"
        ))
    })?;
    let taken = std::fs::read_dir(&arguments.name);
    if taken.is_ok_and(|mut files| files.next().is_some()) || arguments.name.is_file() {
        return Err(Failure::of(
            &arguments.name,
            "exists and is not empty: give another name",
        ));
    }
    let source = match &arguments.gyrocal {
        Some(path) => Source::Path(path.clone()),
        None => Source::Version(env!("CARGO_PKG_VERSION").to_owned()),
    };
    let package = Package::new(name, source)?;
    let from = match &package.source {
        Source::Path(path) => format!("gyrocal of {}, by its path", printable_path(path)),
        Source::Version(version) => format!("the published gyrocal {version}, exactly"),
    };
    let what = format!("{name} has a plant to begin with and a command to diagnose it.");
    let mut screen = Screen::new(Standing::Good, "NEW PACKAGE", what);
    screen.fact("built with", from);
    let words = format!(
        "cd {} && cargo run -- diagnose data.csv --columns columns.toml",
        shell_quoted(&printable_path(&arguments.name))
    );
    screen.fact("next", words);
    let mut shown = Reply::of(screen, String::new());
    let directory = &arguments.name;
    make_folder("", directory, &mut shown.outputs)?;
    for file in &package.files {
        let path = directory.join(file.path);
        make_folder("", path.parent().unwrap_or(directory), &mut shown.outputs)?;
        shown.write(Some(&path), file.what, |_| Ok(&file.text))?;
    }
    Ok(shown)
}

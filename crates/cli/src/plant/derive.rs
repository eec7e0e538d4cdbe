//! `gyrocal plant derive`: the program of a plant from its Python script.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_document::{Screen, Standing};
use gyrocal_plant::LoadedPlant;
use gyrocal_plant_codegen::{DerivedPlant, derive, settings_of_a_command};
use gyrocal_record::printable_path;
use gyrocal_words::counted;

use crate::outputs::refuse_overlap;
use crate::progress::Progress;
use crate::{Failure, Reply};

/// Derive the program file of a plant from its Python script; no Rust is needed.
///
/// CasADi is installed from hash-locked wheels when it is needed first; afterwards no network is used.
#[derive(Debug, Args)]
pub(super) struct DeriveArguments {
    /// The script, which declares a plant and ends with `plant.write()`.
    #[arg(value_name = "PLANT.py")]
    script: PathBuf,
    /// Write the program file here; by default beside the script.
    #[arg(long, value_name = "PLANT.json")]
    out: Option<PathBuf>,
}

/// The plant that a script declares, with its program.
pub(super) fn derived(script: &Path) -> Result<(LoadedPlant, DerivedPlant), Failure> {
    let _progress = Progress::waiting("deriving", 1);
    let derived = derive(script, settings_of_a_command())?;
    let plant = LoadedPlant::parse(&derived.program, &printable_path(script))?;
    Ok((plant, derived))
}

/// Runs the command; returns its answer.
pub(super) fn run(arguments: &DeriveArguments) -> Result<Reply, Failure> {
    let beside = arguments.script.with_extension("json");
    let out = arguments.out.as_deref().unwrap_or(&beside);
    refuse_overlap(&[&arguments.script], &[("--out", Some(out))])?;
    let (plant, derived) = derived(&arguments.script)?;
    let description = plant.description();
    let what = format!(
        "{} has {}, {}, {} and {} in its catalogue",
        description.name,
        counted(description.states.len(), "state"),
        counted(description.parameters.len(), "parameter"),
        counted(description.outputs.len(), "output"),
        counted(description.effects.len(), "effect"),
    );
    let mut screen = Screen::new(Standing::Good, "PROGRAM", what);
    screen.each("left out", derived.left_out);
    let mut shown = Reply::of(screen, String::new());
    let what = "the program, for `gyrocal plant diagnose`";
    shown.write(Some(out), what, |_| Ok(derived.program))?;
    Ok(shown)
}

//! `gyrocal plant extend`: what a diagnosis found, in the equations of a plant's script.

use std::path::PathBuf;

use clap::Args;
use gyrocal_diagnosis::prose::{Screen, Standing};
use gyrocal_plant::{Extension, LoadedPlant, WrittenDiagnosis};
use gyrocal_plant_codegen::{derive, settings_of_a_command};
use gyrocal_record::{Outputs, printable_path};
use miette::miette;

use crate::progress::Progress;
use crate::{Answer, Failure};

/// Write what a diagnosis found into the equations of the plant's Python script.
///
/// The terms are added before `plant.write()`, each with a parameter of its own that is fitted. Functions of
/// time are left out. The next build, or `gyrocal plant derive`, derives the extended plant.
#[derive(Debug, Args)]
pub(super) struct ExtendArguments {
    /// Result of the diagnosis, of its option --json.
    #[arg(value_name = "DIAGNOSIS.json")]
    diagnosis: PathBuf,
    /// The script of the plant, which is changed.
    #[arg(long, value_name = "PLANT.py", default_value = "plant.py")]
    script: PathBuf,
}

/// Runs the command; returns its answer.
pub(super) fn run(arguments: &ExtendArguments) -> Result<Answer, Failure> {
    let read = |path: &PathBuf| {
        std::fs::read_to_string(path).map_err(|reason| {
            Failure::Work(miette!(
                "{}: cannot be read: {reason}",
                printable_path(path)
            ))
        })
    };
    let (text, script) = (read(&arguments.diagnosis)?, read(&arguments.script)?);
    let diagnosis: WrittenDiagnosis = serde_json::from_str(&text).map_err(|reason| {
        Failure::Work(miette!(
            help = "give what `diagnose --json` of a plant wrote",
            "{}: is no diagnosis of a plant: {reason}",
            printable_path(&arguments.diagnosis)
        ))
    })?;
    let origin = printable_path(&arguments.script);
    let progress = Progress::waiting("deriving", 1);
    let derived = derive(&arguments.script, settings_of_a_command())?;
    drop(progress);
    let plant = LoadedPlant::parse(&derived.program, &origin)?;
    let extension = Extension::of(&plant, &diagnosis);
    let extended = extension.script(&script, &origin)?;
    let mut outputs = Outputs::new();
    outputs.stage(&arguments.script, extended.as_bytes())?;
    outputs.commit()?;
    Ok(answer(arguments, &extension))
}

fn answer(arguments: &ExtendArguments, extension: &Extension) -> Answer {
    let names: Vec<&str> = extension
        .terms
        .iter()
        .map(|term| term.effect.as_str())
        .collect();
    let (standing, verdict) = if names.is_empty() {
        (Standing::Bad, "NOT EXTENDED")
    } else {
        (Standing::Good, "EXTENDED")
    };
    let headline = match names.as_slice() {
        [] => "The diagnosis names no term of the equations.".to_owned(),
        names => format!("The plant has the terms {}.", names.join(", ")),
    };
    let mut screen = Screen::new(standing, verdict, headline);
    for one in &extension.left_out {
        screen.fact("left out", format!("{} {}", one.effect, one.why));
    }
    let mut answer = Answer::of(screen, String::new());
    answer.wrote(
        &arguments.script,
        "the equations; derive or build them again",
    );
    answer
}

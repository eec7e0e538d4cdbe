//! `gyrocal plant extend`: what a diagnosis found, in the equations of a plant's script.

use std::path::PathBuf;

use clap::Args;
use gyrocal_answer::{Answer, Subject, read_text};
use gyrocal_document::{Screen, Standing};
use gyrocal_plant::Extension;
use gyrocal_record::{Error, InputErrorKind, SourceText, printable_path};

use super::derive::derived;
use crate::{Failure, Reply};

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
pub(super) fn run(arguments: &ExtendArguments) -> Result<Reply, Failure> {
    let source = SourceText::read(&arguments.diagnosis)?;
    let answer = read_text(&source)?;
    let script = SourceText::read(&arguments.script)?;
    let (plant, _) = derived(&arguments.script)?;
    refuse_another(&source, &answer, &plant.description().name)?;
    let extension = Extension::of(&plant, &answer);
    let extended = extension.script(script.text(), &printable_path(&arguments.script))?;
    let mut shown = Reply::of(screen(&answer, &extension), String::new());
    let what = "the equations; derive or build them again";
    shown.write(Some(&arguments.script), what, |_| Ok(extended))?;
    Ok(shown)
}

/// Refuses the answer of anything but the plant of this name.
fn refuse_another(source: &SourceText, answer: &Answer, plant: &str) -> Result<(), Error> {
    let found = match &answer.subject {
        Subject::Plant(name) if name == plant => return Ok(()),
        Subject::Plant(name) => format!("the answer of the plant {name}"),
        Subject::Platform => "the answer of a platform".to_owned(),
        Subject::Strapdown => "the answer of a strapdown unit".to_owned(),
    };
    let place = source.text().find("\"subject\"").unwrap_or(0);
    Err(source.error(
        InputErrorKind::OutOfRange,
        place..place,
        found,
        format!("an answer of the plant {plant}, whose script is to be extended"),
        "give what `diagnose --json` of this plant wrote; a platform is extended by `gyrocal extend`",
    ))
}

fn screen(answer: &Answer, extension: &Extension) -> Screen {
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
    if !answer.is_settled() {
        screen.fact("not settled", gyrocal_words::plant::verdict(answer));
    }
    let left_out = extension.left_out.iter();
    let left_out = left_out.map(|(effect, why)| format!("{effect} {why}"));
    screen.each("left out", left_out);
    screen
}

//! Checks of the input and output files of a command, and the manifest.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock};

use gyrocal_answer::{Answer, write_text};
use gyrocal_record::{
    Bench, Error, Input, InputRole, Manifest, Outputs, file_behind, printable_path, shell_quoted,
};
use miette::miette;

use crate::Failure;
use crate::reply::{RESULT, Reply};

/// Origin of a result: program, command line, inputs.
pub(crate) fn manifest(model_hash: &str, seed: u64, inputs: &[&Path]) -> Result<Manifest, Error> {
    Ok(Manifest {
        program: "gyrocal".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        model_hash: model_hash.to_owned(),
        inputs: inputs
            .iter()
            .map(|path| Input::of(path))
            .collect::<Result<_, _>>()?,
        seed,
        command: command_line(),
    })
}

/// The same of inputs that the next command may read again; `benches` are those of the bench files, in their order.
pub(crate) fn manifest_of<'a>(
    model_hash: &str,
    seed: u64,
    inputs: &[(InputRole, &Path)],
    benches: impl IntoIterator<Item = &'a Bench>,
) -> Result<Manifest, Error> {
    let paths: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    let mut manifest = manifest(model_hash, seed, &paths)?;
    for (input, (role, _)) in manifest.inputs.iter_mut().zip(inputs) {
        input.role = Some(*role);
    }
    let files = manifest.inputs.iter_mut();
    let files = files.filter(|input| input.role == Some(InputRole::Bench));
    for (input, bench) in files.zip(benches) {
        input.identification.clone_from(&bench.identification);
    }
    Ok(manifest)
}

/// Stages an answer as JSON, if it is asked for; one with a number that is not finite is refused.
pub(crate) fn write_answer(
    path: Option<&Path>,
    answer: &Answer,
    reply: &mut Reply,
) -> Result<(), Failure> {
    reply.write(path, RESULT, |path| {
        write_text(answer).map_err(|error| Failure::of(path, error))
    })
}

/// Refuses an output that is also an input, and two outputs in one file.
pub(crate) fn refuse_overlap(
    inputs: &[&Path],
    outputs: &[(&str, Option<&Path>)],
) -> Result<(), Failure> {
    let read = inputs.iter().map(|path| {
        let name = format!("the input {}", printable_path(path));
        (name, file_behind(path))
    });
    let mut taken: Vec<(String, PathBuf)> = read.collect();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        let place = file_behind(path);
        // Devices and pipes take any number of outputs.
        let replaces = !place.exists() || place.is_file();
        if let Some((other, _)) = taken.iter().find(|(_, taken)| replaces && *taken == place) {
            return Err(Failure::Usage(format!(
                "{option} {} would overwrite {other}",
                printable_path(path)
            )));
        }
        taken.push((format!("{option} {}", printable_path(path)), place));
    }
    Ok(())
}

/// Refuses, before the computation, a result for programs that would be lost after it.
pub(crate) fn check(inputs: &[&Path], json: Option<&Path>) -> Result<(), Failure> {
    refuse_overlap(inputs, &[("--json", json)])?;
    refuse_unwritable(&[json], None)
}

/// Refuses outputs that cannot be written; `made` is the folder that the command creates for others.
pub(crate) fn refuse_unwritable(
    outputs: &[Option<&Path>],
    made: Option<&Path>,
) -> Result<(), Failure> {
    for path in outputs.iter().flatten() {
        if !made.is_some_and(|made| comes_with(path, made)) {
            // Staging without a commit writes nothing.
            Outputs::new().stage(path, b"")?;
        }
    }
    Ok(())
}

/// Has a folder for outputs, which `option` gives.
pub(crate) fn make_folder(
    option: &str,
    folder: &Path,
    outputs: &mut Outputs,
) -> Result<(), Failure> {
    outputs.folder(folder).map_err(|error| {
        let reason = match error {
            Error::Unwritable { reason, .. } => reason.to_string(),
            other => other.to_string(),
        };
        Failure::Work(miette!(
            help = "give a folder, or a name that is free",
            "{option}{}: cannot be made: {reason}",
            printable_path(folder)
        ))
    })
}

/// Whether the folder of a file does not exist yet, and is created with another folder.
fn comes_with(path: &Path, made: &Path) -> bool {
    let path = file_behind(path);
    let folder = path.parent().filter(|folder| !folder.exists());
    folder.is_some_and(|folder| file_behind(made).starts_with(folder))
}

/// Refuses a later record, which an option gives, that is one of the records.
pub(crate) fn refuse_itself(
    option: &str,
    later: Option<&Path>,
    records: &[PathBuf],
) -> Result<(), Failure> {
    match later {
        Some(later)
            if records
                .iter()
                .any(|one| file_behind(one) == file_behind(later)) =>
        {
            Err(Failure::Usage(format!(
                "{option} {} is the record itself: a later one has had no part in the models",
                printable_path(later)
            )))
        }
        _ => Ok(()),
    }
}

/// Name and arguments of the command that runs: the process may be another program's, whose own arguments
/// differ.
static ARGUMENTS: RwLock<Vec<OsString>> = RwLock::new(Vec::new());

/// Keeps the arguments of a command, the first of which is the path of the program, for its manifest; with
/// `name` in place of that path.
pub(crate) fn remember(name: OsString, arguments: &[OsString]) {
    let mut kept = ARGUMENTS.write().unwrap_or_else(PoisonError::into_inner);
    let further = arguments.get(1..).unwrap_or_default().iter().cloned();
    *kept = std::iter::once(name).chain(further).collect();
}

/// The command line as typed, with a name for the path of the program.
pub(crate) fn command_line() -> String {
    let arguments = ARGUMENTS.read().unwrap_or_else(PoisonError::into_inner);
    let arguments = arguments.iter();
    let arguments = arguments.map(|argument| shell_quoted(&argument.to_string_lossy()));
    arguments.collect::<Vec<_>>().join(" ")
}

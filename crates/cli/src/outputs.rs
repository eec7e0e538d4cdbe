//! Checks of the input and output files of a command, and the manifest.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{PoisonError, RwLock};

use gyrocal_answer::{Answer, write_text};
use gyrocal_record::{Error, Input, InputRole, Manifest, Outputs, printable_path, shell_quoted};
use miette::miette;

use crate::reply::{RESULT, Reply};
use crate::{Failure, pictures};

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

/// The same of inputs that the next command may read again.
pub(crate) fn manifest_of(
    model_hash: &str,
    seed: u64,
    inputs: &[(InputRole, &Path)],
) -> Result<Manifest, Error> {
    let paths: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    let mut manifest = manifest(model_hash, seed, &paths)?;
    for (input, (role, _)) in manifest.inputs.iter_mut().zip(inputs) {
        input.role = Some(*role);
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
        (name, identity(path))
    });
    let mut taken: Vec<(String, PathBuf)> = read.collect();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        let place = identity(path);
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

/// Refuses, before the computation, outputs that would be lost after it.
pub(crate) fn check(
    inputs: &[&Path],
    json: Option<&Path>,
    figures: Option<&Path>,
) -> Result<(), Failure> {
    refuse_overlap(inputs, &[("--figures", figures), ("--json", json)])?;
    if let (Some(json), Some(figures)) = (json, figures)
        && identity(json).parent() == Some(&identity(figures))
        && pictures::is_one(json)
    {
        return Err(Failure::Usage(format!(
            "--json {} is among the pictures of --figures {}",
            printable_path(json),
            printable_path(figures)
        )));
    }
    refuse_unwritable(&[json], figures)
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

/// Makes a folder of outputs, which `option` gives.
pub(crate) fn make_folder(option: &str, folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|reason| {
        Failure::Work(miette!(
            help = "give a folder, or a name that is free",
            "{option}{}: cannot be made: {reason}",
            printable_path(folder)
        ))
    })
}

/// Whether the folder of a file does not exist yet, and is created with another folder.
fn comes_with(path: &Path, made: &Path) -> bool {
    let path = identity(path);
    let folder = path.parent().filter(|folder| !folder.exists());
    folder.is_some_and(|folder| identity(made).starts_with(folder))
}

/// Refuses a later record, which an option gives, that is one of the records.
pub(crate) fn refuse_itself(
    option: &str,
    later: Option<&Path>,
    records: &[PathBuf],
) -> Result<(), Failure> {
    match later {
        Some(later) if records.iter().any(|one| identity(one) == identity(later)) => {
            Err(Failure::Usage(format!(
                "{option} {} is the record itself: a later one has had no part in the models",
                printable_path(later)
            )))
        }
        _ => Ok(()),
    }
}

/// The file behind a path, whether it or its folders exist or not.
fn identity(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match path.file_name() {
        Some(name) => identity(folder).join(name),
        None => path.to_owned(),
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

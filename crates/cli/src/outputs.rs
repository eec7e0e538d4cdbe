//! What commands have in common about the files that they name.

use std::path::{Path, PathBuf};

use gyrocal_record::{Error, Input, Manifest};

use crate::Failure;

/// Where a result comes from: this program, this command line, these inputs.
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

/// Refuses an output that is an input too, and two outputs in one file.
pub(crate) fn refuse_overlap(
    inputs: &[&Path],
    outputs: &[(&str, Option<&Path>)],
) -> Result<(), Failure> {
    let mut taken: Vec<(String, PathBuf)> = inputs
        .iter()
        .map(|path| (format!("the input {}", path.display()), identity(path)))
        .collect();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        let place = identity(path);
        // Devices and pipes take any number of outputs.
        let replaces = !place.exists() || place.is_file();
        if let Some((other, _)) = taken.iter().find(|(_, taken)| replaces && *taken == place) {
            return Err(Failure::Usage(format!(
                "{option} {} would overwrite {other}",
                path.display()
            )));
        }
        taken.push((format!("{option} {}", path.display()), place));
    }
    Ok(())
}

/// Whether two paths lead to one file.
pub(crate) fn same_file(a: &Path, b: &Path) -> bool {
    identity(a) == identity(b)
}

/// The file behind a path, whether it exists or not.
fn identity(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// The command line as one could type it, whatever the program's own path.
fn command_line() -> String {
    let arguments = std::env::args_os().skip(1).map(|argument| {
        let argument = argument.to_string_lossy();
        let plain = |letter: char| letter.is_alphanumeric() || "-_./=:,+@%".contains(letter);
        if !argument.is_empty() && argument.chars().all(plain) {
            argument.into_owned()
        } else {
            format!("'{}'", argument.replace('\'', r"'\''"))
        }
    });
    std::iter::once("gyrocal".to_owned())
        .chain(arguments)
        .collect::<Vec<_>>()
        .join(" ")
}

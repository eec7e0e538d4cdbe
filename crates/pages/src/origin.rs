//! Origin of an answer.

use gyrocal_document::{Origin, OriginFile};
use gyrocal_record::{Input, Manifest};
use gyrocal_words::counted;

/// Program, command and files of a manifest.
pub(crate) fn origin(manifest: &Manifest) -> Origin {
    Origin {
        program: format!("{} {}", manifest.program, manifest.version),
        model_hash: manifest.model_hash.clone(),
        seed: manifest.seed.to_string(),
        command: manifest.command.clone(),
        files: manifest
            .inputs
            .iter()
            .map(|input| OriginFile {
                path: input.path.clone(),
                sha256: input.sha256.clone(),
            })
            .collect(),
    }
}

/// Name of the file of an input, without its folders.
pub(crate) fn file_name(manifest: &Manifest, place: usize, otherwise: &str) -> String {
    let input = manifest.inputs.get(place);
    let name = input.and_then(|input| input.path.rsplit(['/', '\\']).next());
    name.unwrap_or(otherwise).to_owned()
}

/// Name of a record, the first file, or the number of several.
pub(crate) fn record_name(manifest: &Manifest, several: usize) -> String {
    match several {
        0 => file_name(manifest, 0, "record"),
        several => counted(several, "record"),
    }
}

/// Files by name: the first, and how many follow.
pub(crate) fn named(files: &[Input]) -> String {
    match files {
        [] => String::new(),
        [one] => one.path.clone(),
        [first, rest @ ..] => format!("{} and {} further logs", first.path, rest.len()),
    }
}

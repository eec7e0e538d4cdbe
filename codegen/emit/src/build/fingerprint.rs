//! The fingerprint of everything that generated code depends on.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::error::{Error, at};

/// One input: its name in the fingerprint and its text with line endings normalised.
pub(super) struct Input {
    name: String,
    text: String,
}

impl Input {
    pub(super) fn new(name: impl Into<String>, text: &str) -> Self {
        Self {
            name: name.into(),
            text: normalised(text),
        }
    }
}

/// The hash over names and texts, whatever order the inputs come in.
pub(super) fn fingerprint(mut inputs: Vec<Input>) -> String {
    inputs.sort_by(|a, b| a.name.cmp(&b.name));
    let mut hasher = Sha256::new();
    for input in &inputs {
        // Lengths keep one input's end from passing for the next one's beginning.
        for part in [&input.name, &input.text] {
            hasher.update((part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
    }
    hex(&hasher.finalize())
}

/// The hash of one text.
pub(super) fn sha256(text: &str) -> String {
    hex(&Sha256::digest(text.as_bytes()))
}

/// The text as it would be with Unix line endings: what version control may change.
pub(super) fn normalised(text: &str) -> String {
    text.replace("\r\n", "\n")
}

/// Every `*.py` below `directory`, sorted; byte code and hidden directories are left out.
pub(super) fn python_files(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    let mut pending = vec![directory.to_owned()];
    while let Some(directory) = pending.pop() {
        for entry in std::fs::read_dir(&directory).map_err(at("list", &directory))? {
            let path = entry.map_err(at("list", &directory))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if path.is_dir() {
                if name != "__pycache__" && !name.starts_with('.') {
                    pending.push(path);
                }
            } else if path.extension().is_some_and(|extension| extension == "py") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_endings_and_order_do_not_count_but_names_and_borders_do() {
        let of = |inputs: &[(&str, &str)]| {
            fingerprint(
                inputs
                    .iter()
                    .map(|(name, text)| Input::new(*name, text))
                    .collect(),
            )
        };
        let reference = of(&[("a", "one\ntwo\n"), ("b", "three")]);
        assert_eq!(reference, of(&[("b", "three"), ("a", "one\r\ntwo\r\n")]));
        assert_ne!(reference, of(&[("a", "one\ntwo\n"), ("c", "three")]));
        assert_ne!(reference, of(&[("a", "one\ntwo\nb"), ("", "three")]));
        assert_ne!(reference, of(&[("a", "one\ntwo\n"), ("b", "threE")]));
    }

    #[test]
    fn sha256_is_sha256() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(
            sha256("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}

//! Committed files: sealed, read back, compared, and written only if changed.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use super::error::{Error, at};
use super::fingerprint::{normalised, sha256};

/// Last line of a committed Rust file, before the hash of the lines above.
const SEAL: &str = "// sha256 of the lines above: ";

/// A committed file that cannot be used, with the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Stale {
    /// The file.
    pub path: PathBuf,
    /// Reason.
    pub reason: Reason,
}

/// Reason why a committed file cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// There is no such file.
    Missing,
    /// It was generated from other inputs: the derivation, the file of a variant or the emitter
    /// was edited.
    OtherInputs,
    /// Its text is not the one that was generated.
    Edited,
    /// It differs from what the derivation gives, first in this line.
    Differs {
        /// Line, from 1.
        line: usize,
    },
}

impl fmt::Display for Stale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` ", shown(&self.path).display())?;
        match self.reason {
            Reason::Missing => write!(f, "is missing"),
            Reason::OtherInputs => write!(f, "is stale: what it was derived from was edited"),
            Reason::Edited => write!(f, "is damaged: its text is not the one that was generated"),
            Reason::Differs { line } => {
                write!(
                    f,
                    "differs from what the derivation gives, first in line {line}"
                )
            }
        }
    }
}

/// The text with a last line by which later edits are detected.
pub(super) fn sealed(text: &str) -> String {
    let newline = if text.ends_with('\n') { "" } else { "\n" };
    let text = format!("{text}{newline}");
    format!("{text}{SEAL}{}\n", sha256(&text))
}

/// Whether the Rust file at `path` was generated from these inputs and not edited since:
/// nothing if so. Needs no Python.
pub(super) fn inspect(path: &Path, fingerprint: &str) -> Result<Option<Reason>, Error> {
    let Some(text) = read(path)? else {
        return Ok(Some(Reason::Missing));
    };
    let mut header = text.lines().take_while(|line| line.starts_with("//"));
    if !header.any(|line| line.contains(fingerprint)) {
        return Ok(Some(Reason::OtherInputs));
    }
    let intact = text
        .trim_end()
        .rsplit_once(SEAL)
        .is_some_and(|(body, hash)| sha256(body) == hash);
    Ok((!intact).then_some(Reason::Edited))
}

/// First difference of the file at `path` from `expected`, if there is one.
pub(super) fn compare(path: &Path, expected: &str) -> Result<Option<Reason>, Error> {
    let Some(text) = read(path)? else {
        return Ok(Some(Reason::Missing));
    };
    if text == expected {
        return Ok(None);
    }
    let same = text
        .lines()
        .zip(expected.lines())
        .take_while(|(a, b)| a == b)
        .count();
    Ok(Some(Reason::Differs { line: same + 1 }))
}

/// Writes `text` unless it is there already; the file is never seen half-written.
/// Returns whether it was written.
pub(super) fn write_if_changed(path: &Path, text: &str) -> Result<bool, Error> {
    if compare(path, text)?.is_none() {
        return Ok(false);
    }
    if let Some(directory) = path.parent() {
        fs::create_dir_all(directory).map_err(at("make", directory))?;
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(name);
    fs::write(&temporary, text).map_err(at("write", &temporary))?;
    if let Err(error) = fs::rename(&temporary, path) {
        let _ = fs::remove_file(&temporary);
        return Err(at("write", path)(error));
    }
    Ok(true)
}

/// The path as a person in the current directory would write it.
pub(super) fn shown(path: &Path) -> &Path {
    let here = std::env::current_dir().unwrap_or_default();
    path.strip_prefix(here).unwrap_or(path)
}

/// The text with line endings normalised (version control may have changed them).
fn read(path: &Path) -> Result<Option<String>, Error> {
    match fs::read(path) {
        // A file that is not UTF-8 was not generated; it must not stop the repair.
        Ok(bytes) => Ok(Some(normalised(&String::from_utf8_lossy(&bytes)))),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(at("read", path)(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seal_breaks_with_any_edit_but_not_with_line_endings() {
        let path = std::env::temp_dir().join(format!("gyrocal-seal-{}.rs", std::process::id()));
        let verdict = |text: &str, fingerprint: &str| {
            fs::write(&path, text).unwrap();
            inspect(&path, fingerprint).unwrap()
        };
        let good = sealed("// inputs: 0123\nfn f() {}\n");
        assert_eq!(verdict(&good, "0123"), None);
        assert_eq!(verdict(&good.replace('\n', "\r\n"), "0123"), None);
        assert_eq!(verdict(&good, "4567"), Some(Reason::OtherInputs));
        assert_eq!(
            verdict(&good.replace("f()", "g()"), "0123"),
            Some(Reason::Edited)
        );
        assert_eq!(
            verdict("// inputs: 0123\nfn f() {}\n", "0123"),
            Some(Reason::Edited)
        );
        assert_eq!(
            compare(&path, "// inputs: 0123\nfn g() {}\n").unwrap(),
            Some(Reason::Differs { line: 2 })
        );
        fs::remove_file(&path).unwrap();
        assert_eq!(inspect(&path, "0123").unwrap(), Some(Reason::Missing));
    }
}

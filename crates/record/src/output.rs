//! Output files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use tempfile::{Builder, NamedTempFile};

use crate::error::{Error, unwritable};

/// Some output files that appear together.
///
/// [`stage`](Self::stage) writes each beside its target under a temporary name;
/// [`commit`](Self::commit) renames them. Until then nothing that exists is touched, and a
/// failure or a drop leaves nothing behind.
#[derive(Debug, Default)]
pub struct Outputs {
    staged: Vec<Staged>,
}

#[derive(Debug)]
enum Staged {
    File {
        temporary: NamedTempFile,
        target: PathBuf,
    },
    /// A pipe or device, which cannot be replaced by renaming and must not be.
    Stream { content: Vec<u8>, target: PathBuf },
}

impl Outputs {
    /// No files yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Writes the content of one file under a temporary name beside it.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`] if that is not possible.
    pub fn stage(&mut self, path: &Path, content: &[u8]) -> Result<(), Error> {
        let staged = stage(path, content).map_err(unwritable(path))?;
        self.staged.push(staged);
        Ok(())
    }

    /// Gives all files their names.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`] if a file cannot be given its name; those after it do not appear.
    pub fn commit(self) -> Result<(), Error> {
        for staged in self.staged {
            match staged {
                Staged::File { temporary, target } => {
                    let persisted = temporary.persist(&target);
                    persisted.map_err(|error| unwritable(&target)(error.error))?;
                }
                Staged::Stream { content, target } => {
                    write_stream(&target, &content).map_err(unwritable(&target))?;
                }
            }
        }
        Ok(())
    }

    /// Stages a result as JSON with a line break at its end.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`] if that is not possible.
    pub fn stage_json<T: Serialize>(&mut self, path: &Path, value: &T) -> Result<(), Error> {
        self.stage(path, &json_bytes(path, value)?)
    }
}

/// Writes one file whole or not at all.
///
/// # Errors
///
/// [`Error::Unwritable`] if that is not possible.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), Error> {
    let mut outputs = Outputs::new();
    outputs.stage(path, content)?;
    outputs.commit()
}

/// Writes a result as JSON with a line break at its end, whole or not at all.
///
/// # Errors
///
/// [`Error::Unwritable`] if that is not possible.
pub fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), Error> {
    write_whole(path, &json_bytes(path, value)?)
}

fn json_bytes<T: Serialize>(path: &Path, value: &T) -> Result<Vec<u8>, Error> {
    let content = serde_json::to_vec_pretty(value);
    let mut content = content.map_err(|error| unwritable(path)(error.into()))?;
    content.push(b'\n');
    Ok(content)
}

fn stage(path: &Path, content: &[u8]) -> io::Result<Staged> {
    // A link is followed: what it points to is replaced, not the link.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if let Ok(metadata) = fs::metadata(&target) {
        if metadata.is_dir() {
            return Err(io::Error::from(io::ErrorKind::IsADirectory));
        }
        if !metadata.is_file() {
            let content = content.to_vec();
            return Ok(Staged::Stream { content, target });
        }
        // Renaming needs no right to write the file itself; ask for it all the same.
        File::options().append(true).open(&target)?;
    }
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    // The temporary name in tempfile's own message would only confuse.
    let mut temporary = new_temporary(folder).map_err(|error| io::Error::from(error.kind()))?;
    temporary.write_all(content)?;
    temporary.as_file().sync_all()?;
    Ok(Staged::File { temporary, target })
}

fn new_temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".gyrocal-").suffix(".tmp");
    // Temporary files are private by default; the result has the rights of any new file.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

fn write_stream(target: &Path, content: &[u8]) -> io::Result<()> {
    let mut stream = File::options().write(true).open(target)?;
    stream.write_all(content)?;
    stream.flush()
}

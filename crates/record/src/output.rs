//! Output files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use tempfile::NamedTempFile;

use crate::error::{Error, unwritable};
use crate::temporary::{TemporaryFolder, file_in, folder_in};

/// Some output files that appear together.
///
/// [`stage`](Self::stage) writes each beside its target under a temporary name;
/// [`commit`](Self::commit) renames them. Until then nothing that exists is touched, and a
/// failure or a drop leaves nothing behind. What a killed run left is removed by one that writes
/// there a day later. A file that is replaced keeps its rights.
#[derive(Debug, Default)]
pub struct Outputs {
    staged: Vec<Staged>,
    /// Files of an earlier run that this one does not write; of a link, the link.
    outdated: Vec<PathBuf>,
    folders: Vec<NewFolder>,
    /// Folders that were made around the new ones, from the outermost.
    around: Vec<PathBuf>,
}

/// A folder that appears with all that is in it.
#[derive(Debug)]
struct NewFolder {
    temporary: TemporaryFolder,
    target: PathBuf,
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
        let staged = self.staged(path, content).map_err(unwritable(path))?;
        self.staged.push(staged);
        Ok(())
    }

    /// Has a folder for files that are staged after it. If it does not exist, it appears with all of them.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`] if it cannot be made.
    pub fn folder(&mut self, path: &Path) -> Result<(), Error> {
        self.new_folder(path).map_err(unwritable(path))
    }

    /// Removes a file, if it is there, together with the appearance of the others: what an earlier run wrote, and
    /// this one has nothing for.
    pub fn remove(&mut self, path: &Path) {
        self.outdated.push(path.to_owned());
    }

    /// Gives all files their names.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`] if a file cannot be given its name; those after it do not appear.
    pub fn commit(mut self) -> Result<(), Error> {
        for staged in std::mem::take(&mut self.staged) {
            match staged {
                Staged::File { temporary, target } => {
                    let persisted = temporary.persist(self.place_of(&target));
                    persisted.map_err(|error| unwritable(&target)(error.error))?;
                }
                Staged::Stream { content, target } => {
                    write_stream(&target, &content).map_err(unwritable(&target))?;
                }
            }
        }
        for NewFolder { temporary, target } in std::mem::take(&mut self.folders) {
            place(temporary.folder.path(), &target).map_err(unwritable(&target))?;
        }
        for path in std::mem::take(&mut self.outdated) {
            if path.is_file() {
                fs::remove_file(&path).map_err(unwritable(&path))?;
            }
        }
        self.around.clear();
        Ok(())
    }

    fn new_folder(&mut self, path: &Path) -> io::Result<()> {
        let target = file_behind(path);
        if target.is_dir() || self.place_of(&target) != target {
            return Ok(());
        }
        if target.exists() {
            return Err(io::Error::from(io::ErrorKind::AlreadyExists));
        }
        let parent = parent(&target);
        let missing = parent.ancestors().take_while(|folder| !folder.exists());
        let missing: Vec<_> = missing.map(Path::to_owned).collect();
        fs::create_dir_all(parent)?;
        self.around.extend(missing.into_iter().rev());
        let temporary = folder_in(parent)?;
        self.folders.push(NewFolder { temporary, target });
        Ok(())
    }

    /// Where a file is until the commit: within a new folder, or at its own place.
    fn place_of(&self, target: &Path) -> PathBuf {
        let within = self.folders.iter().find_map(|folder| {
            let rest = target.strip_prefix(&folder.target).ok()?;
            Some(folder.temporary.folder.path().join(rest))
        });
        within.unwrap_or_else(|| target.to_owned())
    }

    fn staged(&self, path: &Path, content: &[u8]) -> io::Result<Staged> {
        // A link is followed: what it points to is replaced, not the link.
        let target = file_behind(path);
        let replaced = fs::metadata(&target).ok();
        if let Some(replaced) = &replaced {
            if replaced.is_dir() {
                return Err(io::Error::from(io::ErrorKind::IsADirectory));
            }
            if !replaced.is_file() {
                let content = content.to_vec();
                return Ok(Staged::Stream { content, target });
            }
            // Renaming needs no right to write the file itself; ask for it all the same.
            File::options().append(true).open(&target)?;
        }
        let place = self.place_of(&target);
        let folder = parent(&place);
        if place != target {
            fs::create_dir_all(folder)?;
        }
        // The temporary name in tempfile's own message would only confuse.
        let mut temporary =
            file_in(folder, replaced.as_ref()).map_err(|error| io::Error::from(error.kind()))?;
        temporary.write_all(content)?;
        temporary.as_file().sync_all()?;
        Ok(Staged::File { temporary, target })
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

impl Drop for Outputs {
    fn drop(&mut self) {
        self.staged.clear();
        self.folders.clear();
        for folder in self.around.iter().rev() {
            // One that others have put files into stays.
            let _ = fs::remove_dir(folder);
        }
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

/// The file behind a path, whether it or its folders exist or not: links are followed.
#[must_use]
pub fn file_behind(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    match path.file_name() {
        Some(name) => file_behind(parent(path)).join(name),
        None => path.to_owned(),
    }
}

/// Gives a folder its name; if another run has made one of that name meanwhile, gives it what is in this one.
fn place(folder: &Path, target: &Path) -> io::Result<()> {
    if !target.is_dir() {
        return fs::rename(folder, target);
    }
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        place(&entry.path(), &target.join(entry.file_name()))?;
    }
    Ok(())
}

fn parent(path: &Path) -> &Path {
    let parent = path.parent().filter(|folder| *folder != Path::new(""));
    parent.unwrap_or(Path::new("."))
}

fn write_stream(target: &Path, content: &[u8]) -> io::Result<()> {
    let mut stream = File::options().write(true).open(target)?;
    stream.write_all(content)?;
    stream.flush()
}

//! Temporary files and folders beside outputs. Each is locked while its run lives: a run removes those of killed
//! runs, which nobody locks and nobody has written to for a day. Another machine on the same folder may not see locks.

use std::collections::BTreeSet;
use std::fs::{self, File, Metadata, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile, TempDir};

const PREFIX: &str = ".gyrocal-";
const SUFFIX: &str = ".tmp";

/// Age from which on what nobody locks counts as left: no run writes for as long.
const OLD: Duration = Duration::from_secs(24 * 3600);

/// Folders in which this process has removed what killed runs left.
static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A folder that is removed with all in it when it is dropped.
#[derive(Debug)]
pub(crate) struct TemporaryFolder {
    /// The folder.
    pub(crate) folder: TempDir,
    /// Holds the lock; `None` where folders cannot be locked.
    _lock: Option<File>,
}

/// An empty file in a folder, with the rights of the file that it replaces or of any new one.
pub(crate) fn file_in(folder: &Path, replaced: Option<&Metadata>) -> io::Result<NamedTempFile> {
    sweep_once(folder);
    let make = || {
        let mut builder = builder();
        // Temporary files are private by default, and one that replaces another is until it has its group.
        #[cfg(unix)]
        builder.permissions(replaced.map_or_else(|| mode(0o666), |_| mode(0o600)));
        let made = builder.tempfile_in(folder)?;
        let held = hold(Some(made.as_file()), made.path());
        Ok((made, held))
    };
    let made = held_by(make)?;
    #[cfg(unix)]
    if let Some(replaced) = replaced {
        take_rights(made.as_file(), replaced)?;
    }
    Ok(made)
}

/// An empty folder in another.
pub(crate) fn folder_in(parent: &Path) -> io::Result<TemporaryFolder> {
    sweep_once(parent);
    held_by(|| {
        let mut builder = builder();
        #[cfg(unix)]
        builder.permissions(mode(0o777));
        let folder = builder.tempdir_in(parent)?;
        let lock = File::open(folder.path()).ok();
        let held = hold(lock.as_ref(), folder.path());
        let made = TemporaryFolder {
            folder,
            _lock: lock,
        };
        Ok((made, held))
    })
}

/// What is made, and made again if another run took it for abandoned before it was locked.
fn held_by<T>(make: impl Fn() -> io::Result<(T, bool)>) -> io::Result<T> {
    match make()? {
        (made, true) => Ok(made),
        _ => make().map(|(made, _)| made),
    }
}

/// Locks what was just made, where that is possible; false if another run removes it.
fn hold(file: Option<&File>, path: &Path) -> bool {
    let taken = file.map(File::try_lock);
    !matches!(taken, Some(Err(TryLockError::WouldBlock))) && path.exists()
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    builder
}

fn sweep_once(folder: &Path) {
    let mut swept = SWEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if swept.insert(folder.to_owned()) {
        sweep(folder);
    }
}

/// Removes what killed runs left in a folder: what can be locked and is old. Where locks do not work, all stays.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let Ok(kind) = entry.file_type() else {
            continue;
        };
        let is_ours = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if !is_ours || !is_old(&entry.path()) {
            continue;
        }
        let path = entry.path();
        let opened = match (kind.is_file(), kind.is_dir()) {
            (true, _) => File::options().append(true).open(&path),
            (_, true) => File::open(&path),
            _ => continue,
        };
        // The lock is held until the end, so that nobody takes up what is being removed.
        let Some(_lock) = opened.ok().filter(|file| file.try_lock().is_ok()) else {
            continue;
        };
        // What cannot be removed stays.
        let _ = match kind.is_dir() {
            true => fs::remove_dir_all(&path),
            false => fs::remove_file(&path),
        };
    }
}

fn is_old(path: &Path) -> bool {
    let modified = fs::symlink_metadata(path).and_then(|about| about.modified());
    let age = modified.ok().and_then(|at| at.elapsed().ok());
    age.is_some_and(|age| age > OLD)
}

#[cfg(unix)]
fn mode(mode: u32) -> fs::Permissions {
    std::os::unix::fs::PermissionsExt::from_mode(mode)
}

/// Gives a new file owner, group and mode of the one that it replaces; the rights of a group that it cannot have
/// are left out.
#[cfg(unix)]
fn take_rights(file: &File, replaced: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt as _, fchown};
    let own = file.metadata()?;
    let mut rights = replaced.mode() & 0o7777;
    if own.gid() != replaced.gid() && fchown(file, None, Some(replaced.gid())).is_err() {
        rights &= !0o7070;
    }
    // Only the administrator may give a file away.
    if own.uid() != replaced.uid() && fchown(file, Some(replaced.uid()), None).is_err() {
        rights &= 0o777;
    }
    match file.metadata()?.mode() & 0o7777 == rights {
        true => Ok(()),
        false => file.set_permissions(mode(rights)),
    }
}

#[cfg(test)]
mod tests {
    use std::fs::FileTimes;
    use std::time::SystemTime;

    use super::*;

    fn make_old(path: &Path) {
        let modified = SystemTime::now() - 2 * OLD;
        let times = FileTimes::new().set_modified(modified);
        File::open(path).unwrap().set_times(times).unwrap();
    }

    #[test]
    fn what_killed_runs_left_is_removed_and_what_lives_stays() {
        let folder = tempfile::tempdir().unwrap();
        let left = |name: &str| folder.path().join(name);
        let (file, pictures, other) = (
            left(".gyrocal-dead.tmp"),
            left(".gyrocal-gone.tmp"),
            left("other.tmp"),
        );
        fs::write(&file, "half").unwrap();
        fs::write(&other, "of others").unwrap();
        fs::create_dir_all(pictures.join("within")).unwrap();
        let young = left(".gyrocal-young.tmp");
        fs::write(&young, "of another machine").unwrap();
        [&file, &pictures]
            .into_iter()
            .for_each(|left| make_old(left));
        let living = file_in(folder.path(), None).unwrap();
        let living_folder = folder_in(folder.path()).unwrap();
        assert!(!file.exists() && !pictures.exists());
        assert!(other.exists() && young.exists());
        [living.path(), living_folder.folder.path()]
            .into_iter()
            .for_each(make_old);
        // A further run meets what lives.
        sweep(folder.path());
        assert!(living.path().exists() && living_folder.folder.path().exists());
        let path = living.path().to_owned();
        // As a killed run: the lock goes, the file stays.
        drop(living.keep().unwrap());
        assert!(path.exists());
        sweep(folder.path());
        assert!(!path.exists());
    }
}

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Makes `directory` anew, empty.
pub fn fresh_directory(directory: impl Into<PathBuf>) -> PathBuf {
    let directory = directory.into();
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// Replaces the one occurrence of `from` in a file.
pub fn edit(path: impl AsRef<Path>, from: &str, to: &str) {
    let path = path.as_ref();
    let text = fs::read_to_string(path).unwrap();
    let found = text.matches(from).count();
    assert_eq!(found, 1, "`{from}` in {}", path.display());
    fs::write(path, text.replace(from, to)).unwrap();
}

/// Every file below `directory` with its contents, to check that nothing was written.
pub fn snapshot(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut pending = vec![directory.to_owned()];
    while let Some(below) = pending.pop() {
        for entry in fs::read_dir(&below).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                pending.push(path);
            } else {
                let contents = fs::read(&path).unwrap();
                found.insert(path.strip_prefix(directory).unwrap().to_owned(), contents);
            }
        }
    }
    found
}

/// Writes an executable shell script.
pub fn executable(path: &Path, script: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, format!("#!/bin/sh\n{script}\n")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    }
}

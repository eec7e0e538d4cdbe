//! Directories and programs that tests make.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_testkit::{programs, run};

/// Makes `directory` anew, empty.
pub(crate) fn fresh_directory(directory: impl Into<PathBuf>) -> PathBuf {
    let directory = directory.into();
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// A directory for `PATH` that has cargo, the compiler and a linker, and no Python.
pub(crate) fn tools_only(directory: PathBuf) -> PathBuf {
    let directory = fresh_directory(directory);
    let sysroot = run(Command::new("rustc").args(["--print", "sysroot"]))
        .succeeded()
        .stdout;
    let sysroot = PathBuf::from(sysroot.trim());
    for name in ["cargo", "rustc"] {
        link(&sysroot.join("bin").join(name), &directory.join(name));
    }
    for name in ["cc", "ld"] {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let found = programs(name, &path);
        let first = found.first().unwrap_or_else(|| panic!("no `{name}`"));
        link(first, &directory.join(name));
    }
    directory
}

/// Writes an executable shell script.
pub(crate) fn executable(path: &Path, script: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, format!("#!/bin/sh\n{script}\n")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    }
}

fn link(original: &Path, link: &Path) {
    #[cfg(unix)]
    std::os::unix::fs::symlink(original, link).unwrap();
    #[cfg(not(unix))]
    std::fs::copy(original, link).unwrap();
}

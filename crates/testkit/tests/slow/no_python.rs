//! A machine that lacks Python.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_testkit::{fresh_directory, programs, run};

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

fn link(original: &Path, link: &Path) {
    #[cfg(unix)]
    std::os::unix::fs::symlink(original, link).unwrap();
    #[cfg(not(unix))]
    std::fs::copy(original, link).unwrap();
}

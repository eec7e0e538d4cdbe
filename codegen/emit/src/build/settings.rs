//! Environment variables of a derivation.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The interpreter to use instead of one from `PATH`.
pub const PYTHON_VARIABLE: &str = "GYROCAL_PYTHON";
/// `1` or `true`: never use the network.
pub const OFFLINE_VARIABLE: &str = "GYROCAL_OFFLINE";
/// Directory that holds the private environments, for caches of continuous integration.
pub const ENVIRONMENTS_VARIABLE: &str = "GYROCAL_CODEGEN_ENV_DIR";
/// `1` or `true`: a build writes the committed copy of a [`Variant`](super::Variant) anew if it
/// is stale.
pub const WRITE_VARIABLE: &str = "GYROCAL_CODEGEN_WRITE";
/// Cargo's own way of saying that the network must not be used.
pub const CARGO_OFFLINE_VARIABLE: &str = "CARGO_NET_OFFLINE";

/// Every variable that [`Settings::from_env`] reads.
pub(super) const VARIABLES: [&str; 4] = [
    PYTHON_VARIABLE,
    OFFLINE_VARIABLE,
    ENVIRONMENTS_VARIABLE,
    CARGO_OFFLINE_VARIABLE,
];

/// Source of Python and use of the network.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Settings {
    /// The interpreter to use (`GYROCAL_PYTHON`); otherwise `PATH` is searched.
    pub python: Option<OsString>,
    /// The network must not be used (`GYROCAL_OFFLINE` or `CARGO_NET_OFFLINE`).
    pub offline: bool,
    /// Directory of the private environments (`GYROCAL_CODEGEN_ENV_DIR`); otherwise
    /// `gyrocal-codegen` in the target directory.
    pub environments: Option<PathBuf>,
    /// A build writes stale committed copies of variants anew (`GYROCAL_CODEGEN_WRITE`).
    pub write: bool,
}

impl Settings {
    /// The settings that the variables of this process give.
    #[must_use]
    pub fn from_env() -> Self {
        let value = |name| std::env::var_os(name).filter(|value| !value.is_empty());
        let yes = |name| value(name).is_some_and(|value| value == "1" || value == "true");
        Self {
            python: value(PYTHON_VARIABLE),
            offline: yes(OFFLINE_VARIABLE) || yes(CARGO_OFFLINE_VARIABLE),
            environments: value(ENVIRONMENTS_VARIABLE).map(PathBuf::from),
            write: yes(WRITE_VARIABLE),
        }
    }
}

/// The target directory that `inside` (an `OUT_DIR`, a built program) belongs to.
///
/// Cargo marks it with `CACHEDIR.TAG`. With `--target` and with `build.build-dir` there
/// are such marks further in, so the outermost counts.
#[must_use]
pub fn target_directory(inside: &Path) -> Option<PathBuf> {
    inside
        .ancestors()
        .filter(|directory| directory.join("CACHEDIR.TAG").is_file())
        .last()
        .map(Path::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outermost_mark_counts() {
        let root = std::env::temp_dir().join(format!("gyrocal-codegen-tag-{}", std::process::id()));
        let out_dir = root.join("target/x86_64-unknown-linux-gnu/debug/build/it-0/out");
        std::fs::create_dir_all(&out_dir).unwrap();
        let before = target_directory(&out_dir);
        for marked in ["target/x86_64-unknown-linux-gnu", "target"] {
            std::fs::write(root.join(marked).join("CACHEDIR.TAG"), "").unwrap();
        }
        let after = target_directory(&out_dir);
        std::fs::remove_dir_all(&root).unwrap();
        assert_eq!(before, None);
        assert_eq!(after, Some(root.join("target")));
    }
}

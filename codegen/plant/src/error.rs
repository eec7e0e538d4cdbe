//! Failures.

use std::path::PathBuf;

/// A script from which no plant can be derived, or a file that cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read or written.
    #[error("{}: cannot be {action}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// `read` or `written`.
        action: &'static str,
        /// The reason.
        reason: std::io::Error,
    },
    /// The derivation failed.
    #[error(transparent)]
    Derivation(#[from] gyrocal_codegen::build::Error),
    /// The program cannot become Rust.
    #[error(transparent)]
    Program(#[from] gyrocal_codegen::Error),
    /// A package that cannot be made.
    #[error("{0}")]
    Package(String),
}

/// Adds path and action to an error.
pub(crate) fn at<'a>(
    action: &'static str,
    path: &'a std::path::Path,
) -> impl FnOnce(std::io::Error) -> Error + 'a {
    move |reason| Error::File {
        path: path.to_owned(),
        action,
        reason,
    }
}

use std::path::{Path, PathBuf};

use super::committed::Stale;

/// Everything that can go wrong when a derivation is run, written or checked.
///
/// Each message is made for a person who sees nothing else: what happened, then what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// `derivation.toml` or the lock file is not what it should be.
    #[error("{}: {reason}", path.display())]
    Declaration {
        /// The file.
        path: PathBuf,
        /// Values found and expected.
        reason: String,
    },

    /// Cargo does not pass the derivation of a dependency to a build script that asks for it.
    #[error(
        "`{variable}` is not set: found no dependency that tells where its derivation is\n\
         To fix it, add the package with `links = \"{links}\"` to [dependencies] of this package \
         (not only to [build-dependencies]) and call this from build.rs"
    )]
    NoDependency {
        /// The variable that cargo would set.
        variable: String,
        /// The key `links` of the dependency.
        links: String,
    },

    /// A file or directory could not be read or written.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io {
        /// Attempted action.
        action: &'static str,
        /// The file or directory.
        path: PathBuf,
        /// Reason given by the system.
        source: std::io::Error,
    },

    /// No interpreter will do.
    #[error(
        "no suitable Python: {}; expected 3.{minimum} to 3.{newest}\n\
         To fix it, either install one (on Debian and Ubuntu):\n    \
         sudo apt-get install python3 python3-venv\n\
         or name one:\n    \
         export GYROCAL_PYTHON=/path/to/python3",
        list(found)
    )]
    Python {
        /// Each candidate with the reason why it will not do.
        found: Vec<String>,
        /// Oldest minor version that will do.
        minimum: u32,
        /// Newest minor version that will do.
        newest: u32,
    },

    /// The interpreter cannot make virtual environments.
    #[error(
        "`{python}` cannot make a virtual environment: found no module `venv` with `ensurepip`\n\
         To fix it, either install it (on Debian and Ubuntu):\n    \
         sudo apt-get install python3-venv\n\
         or name another interpreter:\n    \
         export GYROCAL_PYTHON=/path/to/python3"
    )]
    NoVenv {
        /// The interpreter.
        python: String,
    },

    /// An environment has to be made, and the network must not be used.
    #[error(
        "CasADi {casadi} is needed and the network must not be used (GYROCAL_OFFLINE or \
         CARGO_NET_OFFLINE)\n\
         To fix it, either make the environment once with the network:\n    \
         env -u GYROCAL_OFFLINE CARGO_NET_OFFLINE=false {retry}\n\
         or name an interpreter (3.{minimum} or newer) that has CasADi {casadi}:\n    \
         export GYROCAL_PYTHON=/path/to/python3"
    )]
    Offline {
        /// The pinned version.
        casadi: String,
        /// Command that makes the environment.
        retry: String,
        /// Oldest minor version that will do.
        minimum: u32,
    },

    /// The virtual environment could not be made or filled.
    #[error(
        "{step} failed in `{}`; its last lines:\n{output}\n\
         To fix it, look for a missing network or proxy (PIP_PROXY, PIP_INDEX_URL and PIP_CERT \
         are passed on) and try again, or name an interpreter that has CasADi {casadi}:\n    \
         export GYROCAL_PYTHON=/path/to/python3",
        environment.display()
    )]
    Environment {
        /// Failed operation.
        step: &'static str,
        /// The environment.
        environment: PathBuf,
        /// Last lines of the output.
        output: String,
        /// The pinned version.
        casadi: String,
    },

    /// The derivation script raised an exception.
    #[error(
        "the derivation `{source_name}` failed{}\n{output}\n\
         To fix it, correct the Python there and build again",
        place.as_ref().map_or_else(String::new, |place| format!(" at {place}"))
    )]
    Derivation {
        /// The derivation.
        source_name: String,
        /// File and line, when the traceback has one in the derivation.
        place: Option<String>,
        /// Last lines of the traceback.
        output: String,
    },

    /// The derivation asks for something that a program cannot hold.
    #[error("the derivation `{source_name}` was refused: {reason}")]
    Refused {
        /// The derivation.
        source_name: String,
        /// Advice.
        reason: String,
    },

    /// The derivation did not write a file that `derivation.toml` names.
    #[error(
        "the derivation `{source_name}` wrote no `{file}`, which its derivation.toml names\n\
         To fix it, write the file in `derive(output)` of main.py or take it out of \
         derivation.toml"
    )]
    NoOutput {
        /// The derivation.
        source_name: String,
        /// The file.
        file: String,
    },

    /// A program could not become Rust.
    #[error(transparent)]
    Emission(#[from] crate::Error),

    /// The committed source is stale and deriving it anew failed.
    #[error("{}, and deriving the model anew failed:\n{cause}", reasons(stale))]
    Rederivation {
        /// The committed files that cannot be used, and why.
        stale: Vec<Stale>,
        /// Failed operation.
        cause: Box<Error>,
    },

    /// Committed files are not what the derivation gives.
    #[error("{}\nTo fix it:\n    {command}", reasons(stale))]
    Stale {
        /// The files, and why.
        stale: Vec<Stale>,
        /// The command that rewrites them.
        command: String,
    },
}

/// Makes an I/O error of what was tried with which path.
pub(super) fn at(
    action: &'static str,
    path: &Path,
) -> impl FnOnce(std::io::Error) -> Error + use<> {
    let path = path.to_owned();
    move |source| Error::Io {
        action,
        path,
        source,
    }
}

/// The last lines of a tool's output, indented.
pub(super) fn tail(output: &[u8], lines: usize) -> String {
    let text = String::from_utf8_lossy(output);
    let all = text.lines().filter(|line| !line.trim().is_empty());
    let all: Vec<String> = all.map(|line| format!("    {line}")).collect();
    all[all.len().saturating_sub(lines)..].join("\n")
}

fn list(found: &[String]) -> String {
    if found.is_empty() {
        "found none in PATH".into()
    } else {
        format!("found {}", found.join(", "))
    }
}

fn reasons(stale: &[Stale]) -> String {
    let lines: Vec<String> = stale.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

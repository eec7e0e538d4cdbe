//! Child processes that see nothing of the caller's Python.

use std::ffi::OsStr;
use std::process::Command;

/// Variables of pip that say how files travel and not what is installed or where. The
/// lock file's hashes decide what is installed, so a mirror, a proxy, a certificate or a
/// directory of wheels is the caller's business.
const TRANSPORT: [&str; 13] = [
    "PIP_CACHE_DIR",
    "PIP_CERT",
    "PIP_CLIENT_CERT",
    "PIP_CONFIG_FILE",
    "PIP_DEFAULT_TIMEOUT",
    "PIP_EXTRA_INDEX_URL",
    "PIP_FIND_LINKS",
    "PIP_INDEX_URL",
    "PIP_NO_CACHE_DIR",
    "PIP_NO_INDEX",
    "PIP_PROXY",
    "PIP_RETRIES",
    "PIP_TRUSTED_HOST",
];

/// `program` with the variables of Python and pip removed, those of transport aside.
///
/// `python -I` ignores `PYTHON*` for itself alone, pip reads `PIP_*` whatever the flags,
/// and both start further processes.
pub(super) fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    for (name, _) in std::env::vars_os() {
        if name.to_str().is_some_and(leaks) {
            command.env_remove(name);
        }
    }
    command.stdin(std::process::Stdio::null());
    command
}

/// An interpreter that ignores its surroundings and writes no byte code.
pub(super) fn python(interpreter: impl AsRef<OsStr>) -> Command {
    let mut command = command(interpreter);
    command.args(["-I", "-B"]);
    command
}

fn leaks(name: &str) -> bool {
    // The launcher's variable makes a macOS Python take another one's place.
    let of_python = name.starts_with("PYTHON") || name == "__PYVENV_LAUNCHER__";
    of_python || (name.starts_with("PIP_") && !TRANSPORT.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transport_passes_and_everything_else_does_not() {
        for name in [
            "PYTHONPATH",
            "PYTHONHOME",
            "PIP_TARGET",
            "PIP_USER",
            "PIP_REQUIRE_VIRTUALENV",
        ] {
            assert!(leaks(name), "{name}");
        }
        for name in [
            "PIP_INDEX_URL",
            "PIP_CERT",
            "PATH",
            "PYENV_VERSION",
            "HTTPS_PROXY",
        ] {
            assert!(!leaks(name), "{name}");
        }
    }
}

//! The private virtual environment: made once for a lock file and a Python version.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::declaration::{Declaration, Lock};
use super::error::{Error, at, tail};
use super::fingerprint::sha256;
use super::process::python;
use super::python::{Python, casadi_version, find};
use super::settings::Settings;

/// Written last: an environment without it is half-made.
const MARKER: &str = "complete";

/// An interpreter that imports the pinned CasADi.
#[derive(Debug, Clone)]
pub(super) struct Environment {
    pub(super) interpreter: PathBuf,
    /// It was made by this call.
    pub(super) created: bool,
}

/// Finds or makes the environment, below the directory `environments`.
///
/// An interpreter named by the settings that has the pinned CasADi is used as it is; so
/// is one of `PATH` when there is no environment yet.
pub(super) fn obtain(
    declaration: &Declaration,
    lock: &Lock,
    settings: &Settings,
    environments: &Path,
) -> Result<Environment, Error> {
    let existing = |interpreter| {
        Ok(Environment {
            interpreter,
            created: false,
        })
    };
    let base = find(&declaration.python, settings)?;
    if settings.python.is_some() && base.has_casadi(&lock.casadi) {
        return existing(base.executable);
    }
    let name = format!("python-{}-{}", base.version, &sha256(&lock.text)[..12]);
    let directory = environments.join(&name);
    if is_complete(&directory) {
        return existing(interpreter_of(&directory));
    }
    if settings.python.is_none() && base.has_casadi(&lock.casadi) {
        return existing(base.executable);
    }
    require_means(declaration, lock, settings, &base)?;

    fs::create_dir_all(environments).map_err(at("make", environments))?;
    let guard_path = environments.join(format!("{name}.lock"));
    let guard = File::create(&guard_path).map_err(at("write", &guard_path))?;
    // Released when `guard` is dropped, and by the system when the process dies.
    guard.lock().map_err(at("lock", &guard_path))?;
    if is_complete(&directory) {
        return existing(interpreter_of(&directory));
    }
    make(&base, lock, &directory)?;
    Ok(Environment {
        interpreter: interpreter_of(&directory),
        created: true,
    })
}

/// Refuses what cannot end well, before anything is written.
fn require_means(
    declaration: &Declaration,
    lock: &Lock,
    settings: &Settings,
    base: &Python,
) -> Result<(), Error> {
    if base.minor > declaration.python.newest {
        return Err(Error::Python {
            found: vec![format!(
                "`{}` ({}, without CasADi {} and newer than the wheels of the lock file)",
                base.executable.display(),
                base.version,
                lock.casadi
            )],
            minimum: declaration.python.minimum.0,
            newest: declaration.python.newest.0,
        });
    }
    if !base.makes_environments {
        return Err(Error::NoVenv {
            python: base.executable.display().to_string(),
        });
    }
    // Without an index, pip installs from PIP_FIND_LINKS and needs no network.
    let needs_network = std::env::var_os("PIP_NO_INDEX").is_none();
    if settings.offline && needs_network {
        return Err(Error::Offline {
            casadi: lock.casadi.clone(),
            retry: declaration.write_command.clone(),
            minimum: declaration.python.minimum.0,
        });
    }
    Ok(())
}

/// A link to an interpreter that has gone does not count.
fn is_complete(directory: &Path) -> bool {
    directory.join(MARKER).is_file() && interpreter_of(directory).is_file()
}

fn interpreter_of(directory: &Path) -> PathBuf {
    directory.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    })
}

/// Makes the environment in place (it could not be moved), the marker last.
fn make(base: &Python, lock: &Lock, directory: &Path) -> Result<(), Error> {
    if directory.exists() {
        fs::remove_dir_all(directory).map_err(at("remove", directory))?;
    }
    let run = |step: &'static str, command: &mut Command| {
        let output = command
            .output()
            .map_err(at("start Python for", directory))?;
        if output.status.success() {
            return Ok(());
        }
        let _ = fs::remove_dir_all(directory);
        Err(failed(
            step,
            directory,
            lock,
            tail(&[output.stdout, output.stderr].concat(), 12),
        ))
    };
    run(
        "python -m venv",
        python(&base.executable).args(["-m", "venv"]).arg(directory),
    )?;
    let requirements = directory.join("requirements.lock");
    fs::write(&requirements, &lock.text).map_err(at("write", &requirements))?;
    run(
        "pip install",
        python(interpreter_of(directory))
            .args([
                "-m",
                "pip",
                "install",
                "--require-hashes",
                "--only-binary",
                ":all:",
            ])
            .args(["--no-input", "--disable-pip-version-check", "--quiet", "-r"])
            .arg(&requirements),
    )?;
    // A configuration file of pip may have sent the packages elsewhere.
    match casadi_version(interpreter_of(directory).as_os_str()) {
        Ok(found) if found == lock.casadi => {}
        Ok(found) => {
            let output = format!("    found CasADi {found}");
            return Err(failed("import casadi", directory, lock, output));
        }
        Err(output) => return Err(failed("import casadi", directory, lock, output)),
    }
    let marker = directory.join(MARKER);
    fs::write(&marker, "").map_err(at("write", &marker))
}

fn failed(step: &'static str, directory: &Path, lock: &Lock, output: String) -> Error {
    Error::Environment {
        step,
        environment: directory.to_owned(),
        output,
        casadi: lock.casadi.clone(),
    }
}

//! Finding an interpreter.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use super::declaration::{Minor, PythonDeclaration};
use super::error::{Error, tail};
use super::process::python;
use super::settings::{PYTHON_VARIABLE, Settings};

/// Prints version, whether environments can be made, and the interpreter's own path (a
/// name in `PATH` may be a shim of a version manager).
const PROBE: &str = "\
import sys
print('%d.%d.%d' % tuple(sys.version_info[:3]))
import importlib.util
print(all(importlib.util.find_spec(name) for name in ('venv', 'ensurepip')))
print(sys.executable)
";

/// An interpreter that answered.
#[derive(Debug, Clone)]
pub(super) struct Python {
    pub(super) executable: PathBuf,
    pub(super) version: String,
    pub(super) minor: Minor,
    pub(super) makes_environments: bool,
}

impl Python {
    /// Whether CasADi can be imported in exactly this version.
    pub(super) fn has_casadi(&self, version: &str) -> bool {
        casadi_version(self.executable.as_os_str()).is_ok_and(|found| found == version)
    }
}

/// The version of CasADi that `interpreter` imports, or why it does not.
pub(super) fn casadi_version(interpreter: &OsStr) -> Result<String, String> {
    let output = python(interpreter)
        .args(["-c", "import casadi; print(casadi.__version__)"])
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    } else {
        Err(tail(&output.stderr, 3))
    }
}

/// The interpreter that the settings name, or the first of `PATH` that will do: newest
/// name first, one that can make environments before one that cannot.
pub(super) fn find(declared: &PythonDeclaration, settings: &Settings) -> Result<Python, Error> {
    let mut found = Vec::new();
    let mut second_best = None;
    for name in candidates(declared, settings) {
        let reason = match probe(&name) {
            Ok(None) => continue,
            Ok(Some(python)) if python.minor < declared.minimum => {
                format!("{}, which is too old", python.version)
            }
            // An interpreter that was named may be newer: it may have its own CasADi.
            Ok(Some(python)) if python.minor > declared.newest && settings.python.is_none() => {
                format!("{}, for which the lock file has no wheels", python.version)
            }
            Ok(Some(python)) if python.makes_environments || settings.python.is_some() => {
                return Ok(python);
            }
            Ok(Some(python)) => {
                second_best.get_or_insert(python);
                continue;
            }
            Err(reason) => reason,
        };
        found.push(format!("`{}` ({reason})", name.display()));
    }
    if let (Some(name), true) = (&settings.python, found.is_empty()) {
        found.push(format!(
            "no `{}`, which {PYTHON_VARIABLE} names",
            name.display()
        ));
    }
    second_best.ok_or(Error::Python {
        found,
        minimum: declared.minimum.0,
        newest: declared.newest.0,
    })
}

fn candidates(declared: &PythonDeclaration, settings: &Settings) -> Vec<OsString> {
    if let Some(named) = &settings.python {
        return vec![named.clone()];
    }
    let versions = (declared.minimum.0..=declared.newest.0).rev();
    versions
        .map(|minor| format!("python3.{minor}"))
        .chain(["python3".to_owned(), "python".to_owned()])
        .map(OsString::from)
        .collect()
}

/// Nothing when there is no such program; a reason when it does not answer like Python 3.
fn probe(name: &OsStr) -> Result<Option<Python>, String> {
    let output = match python(name).args(["-c", PROBE]).output() {
        Ok(output) => output,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(format!("does not start: {error}")),
    };
    let answer = String::from_utf8_lossy(&output.stdout);
    let mut lines = answer.lines();
    let version = lines.next().unwrap_or_default().to_owned();
    let mut numbers = version.split('.').map(str::parse::<u32>);
    let (Some(Ok(major)), Some(Ok(minor))) = (numbers.next(), numbers.next()) else {
        return Err(format!("does not run: {}", tail(&output.stderr, 1).trim()));
    };
    if major != 3 {
        return Err(format!("{version}, which is not Python 3"));
    }
    Ok(Some(Python {
        version,
        minor: Minor(minor),
        makes_environments: lines.next() == Some("True"),
        executable: lines
            .next()
            .filter(|path| !path.is_empty())
            .map_or_else(|| name.into(), PathBuf::from),
    }))
}

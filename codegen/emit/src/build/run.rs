//! One full derivation: environment, CasADi, emission. Nothing is committed here.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use super::committed::sealed;
use super::derivation::Derivation;
use super::environment::obtain;
use super::error::{Error, at, tail};
use super::fingerprint::normalised;
use super::process::python;
use super::sources::write_exporter;
use crate::{Header, Options, Program, emit_module_with};

/// Exit code with which `run.py` refuses a derivation that no program can hold.
const REFUSED: i32 = 3;

/// Results of a derivation, in memory.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Derived {
    /// The modules, in the order of the declaration.
    pub modules: Vec<DerivedModule>,
    /// Texts of the files of evaluated numbers, in the order of the declaration.
    pub numbers: Vec<String>,
    /// Durations of the stages.
    pub timings: Timings,
}

/// One program and the Rust it becomes.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct DerivedModule {
    /// Name of the program.
    pub program: String,
    /// The program, JSON.
    pub json: String,
    /// The Rust file.
    pub rust: String,
}

/// Durations of the stages of a derivation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Timings {
    /// Finding or making the environment.
    pub environment: Duration,
    /// The environment was made, not found.
    pub environment_created: bool,
    /// Running the derivation with CasADi.
    pub derivation: Duration,
    /// Turning the programs into Rust.
    pub emission: Duration,
}

/// Derives everything; temporary files live below `environments` and are removed.
pub(super) fn derive(derivation: &Derivation, environments: &Path) -> Result<Derived, Error> {
    let start = Instant::now();
    let environment = obtain(
        &derivation.declaration,
        &derivation.lock,
        &derivation.settings,
        environments,
    )?;
    let environment_time = start.elapsed();

    let start = Instant::now();
    let work = WorkDirectory::make(environments)?;
    let output = run_script(derivation, &environment.interpreter, &work.0)?;
    let read = |file: &str| match fs::read_to_string(output.join(file)) {
        Ok(text) => Ok(normalised(&text)),
        Err(_) => Err(Error::NoOutput {
            source_name: derivation.declaration.source.clone(),
            file: file.to_owned(),
        }),
    };
    let declared = &derivation.declaration;
    let programs = declared
        .modules
        .iter()
        .map(|module| Ok((&module.program, read(&format!("{}.json", module.program))?)))
        .collect::<Result<Vec<_>, Error>>()?;
    let numbers = declared
        .numbers
        .iter()
        .map(|numbers| read(&numbers.file))
        .collect::<Result<_, _>>()?;
    let derivation_time = start.elapsed();

    let start = Instant::now();
    let modules = programs
        .into_iter()
        .map(|(name, json)| {
            let program = Program::from_json(&json, &format!("{name}.json"))?;
            let rust = emit_module_with(&program, &header(derivation), &options(derivation))?;
            let rust = sealed(&rust);
            Ok(DerivedModule {
                program: name.clone(),
                json,
                rust,
            })
        })
        .collect::<Result<_, Error>>()?;
    let timings = Timings {
        environment: environment_time,
        environment_created: environment.created,
        derivation: derivation_time,
        emission: start.elapsed(),
    };
    Ok(Derived {
        modules,
        numbers,
        timings,
    })
}

fn header(derivation: &Derivation) -> Header {
    Header {
        rebuild_command: derivation.declaration.write_command.clone(),
        source: derivation.declaration.source.clone(),
        fingerprint: derivation.fingerprint.clone(),
    }
}

fn options(derivation: &Derivation) -> Options {
    let declaration = &derivation.declaration;
    let mut options = Options {
        fused_multiply_add: declaration.fused_multiply_add,
        ..Options::default()
    };
    if derivation.request.is_some()
        && let Some(path) = &declaration.variants.scalar_crate
    {
        options.scalar_crate = path.clone();
    }
    options
}

/// Runs `run.py` and returns the directory that holds what the derivation wrote.
fn run_script(derivation: &Derivation, interpreter: &Path, work: &Path) -> Result<PathBuf, Error> {
    write_exporter(work)?;
    let output = work.join("output");
    let mut command = python(interpreter);
    command.arg(work.join("run.py"));
    command.arg(&derivation.directory).arg(&output);
    if let Some(request) = &derivation.request {
        command.arg(&request.file).arg(&request.program);
    }
    let result = command.output().map_err(at("start", interpreter))?;
    let source_name = derivation.declaration.source.clone();
    if result.status.success() {
        return Ok(output);
    }
    if result.status.code() == Some(REFUSED) {
        let message = String::from_utf8_lossy(&result.stderr);
        let message = message.trim();
        let reason = message
            .split_once("derivation refused: ")
            .map_or(message, |(_, why)| why);
        return Err(Error::Refused {
            source_name,
            reason: reason.to_owned(),
        });
    }
    Err(Error::Derivation {
        source_name,
        place: place(
            &String::from_utf8_lossy(&result.stderr),
            &derivation.directory,
        ),
        output: tail(&result.stderr, 12),
    })
}

/// The innermost file and line of a traceback that lie in the derivation.
fn place(traceback: &str, directory: &Path) -> Option<String> {
    traceback.lines().rev().find_map(|line| {
        let (path, rest) = line
            .trim()
            .strip_prefix("File \"")?
            .split_once("\", line ")?;
        let file = Path::new(path).strip_prefix(directory).ok()?;
        let number: String = rest.chars().take_while(char::is_ascii_digit).collect();
        Some(format!("{}, line {number}", file.display()))
    })
}

/// A directory of this call's own, removed at the end.
struct WorkDirectory(PathBuf);

impl WorkDirectory {
    fn make(parent: &Path) -> Result<Self, Error> {
        static CALLS: AtomicU32 = AtomicU32::new(0);
        let call = CALLS.fetch_add(1, Ordering::Relaxed);
        let path = parent.join(format!("run-{}-{call}.tmp", std::process::id()));
        fs::create_dir_all(&path).map_err(at("make", &path))?;
        Ok(Self(path))
    }
}

impl Drop for WorkDirectory {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_of_an_exception_is_in_the_derivation() {
        let traceback = "Traceback (most recent call last):\n  \
            File \"/x/run.py\", line 22, in main\n  \
            File \"/d/drift.py\", line 17, in drift_rate\n    return bias + alng\n  \
            File \"/v/casadi/casadi.py\", line 3, in f\nNameError: name 'alng'";
        assert_eq!(
            place(traceback, Path::new("/d")).as_deref(),
            Some("drift.py, line 17")
        );
        assert_eq!(place(traceback, Path::new("/elsewhere")), None);
    }
}

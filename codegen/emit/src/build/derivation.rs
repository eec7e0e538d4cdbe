use std::path::{Path, PathBuf};

use super::committed::{Reason, Stale, compare, inspect, write_if_changed};
use super::declaration::{DECLARATION_FILE, Declaration, Lock};
use super::error::{Error, at};
use super::fingerprint::{Input, fingerprint, python_files};
use super::outcome::Outcome;
use super::run::{Derived, Timings, derive};
use super::settings::{Settings, target_directory};
use super::sources;
use super::variant::Request;

/// A derivation directory: a script that writes programs, and what it declares.
#[derive(Debug, Clone)]
pub struct Derivation {
    pub(super) directory: PathBuf,
    pub(super) declaration: Declaration,
    pub(super) lock: Lock,
    pub(super) fingerprint: String,
    pub(super) settings: Settings,
    /// Variant defined by a file of another package, instead of all programs.
    pub(super) request: Option<Request>,
}

/// Result of [`Derivation::write`].
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Written {
    /// The files that were written; the others were as they should be.
    pub paths: Vec<PathBuf>,
    /// Durations of the stages.
    pub timings: Timings,
}

impl Derivation {
    /// Reads the declaration and hashes all inputs; the settings are those of the
    /// process's environment.
    ///
    /// # Errors
    ///
    /// A file cannot be read, or `derivation.toml` or the lock file is not as expected.
    pub fn open(directory: impl AsRef<Path>) -> Result<Self, Error> {
        let directory = directory.as_ref();
        let directory = directory.canonicalize().map_err(at("find", directory))?;
        let declaration = Declaration::read(&directory)?;
        let mut inputs: Vec<Input> = sources::inputs().collect();
        let mut files = python_files(&directory)?;
        files.push(directory.join(DECLARATION_FILE));
        let lock = match &declaration.python.requirements {
            Some(requirements) => {
                let path = directory.join(requirements);
                let lock = Lock::read(&path)?;
                files.push(path);
                lock
            }
            None => {
                let lock = Lock::of_this_crate()?;
                inputs.push(Input::new("emit/exporter/requirements.lock", &lock.text));
                lock
            }
        };
        for path in files {
            let text = std::fs::read_to_string(&path).map_err(at("read", &path))?;
            let name = path.strip_prefix(&directory).unwrap_or(&path);
            let name = name.to_string_lossy().replace('\\', "/");
            inputs.push(Input::new(format!("derivation/{name}"), &text));
        }
        Ok(Self {
            fingerprint: fingerprint(inputs),
            settings: Settings::from_env(),
            request: None,
            directory,
            declaration,
            lock,
        })
    }

    /// The same derivation with other settings.
    #[must_use]
    pub fn with_settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// SHA-256 over everything that generated code depends on, in hexadecimal.
    #[must_use]
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }

    /// The command that rewrites the committed files, as declared.
    #[must_use]
    pub fn write_command(&self) -> &str {
        &self.declaration.write_command
    }

    /// The committed Rust files that cannot be used, found without Python.
    ///
    /// # Errors
    ///
    /// A committed file exists and cannot be read.
    pub fn stale(&self) -> Result<Vec<Stale>, Error> {
        Self::collect(self.declaration.modules.iter().map(|module| {
            let path = self.resolve(&module.rust);
            let reason = inspect(&path, &self.fingerprint)?;
            Ok((path, reason))
        }))
    }

    /// For a build script: nothing to do when the committed files are fresh; otherwise
    /// derives the model and writes `PROGRAM.rs` and `PROGRAM.json` into `out_dir`.
    ///
    /// # Errors
    ///
    /// The committed files are stale and the derivation failed; `out_dir` is then as it was.
    pub fn build(&self, out_dir: impl AsRef<Path>) -> Result<Outcome, Error> {
        let stale = self.stale()?;
        if stale.is_empty() {
            return Ok(Outcome::new(self, stale, None));
        }
        let out_dir = out_dir.as_ref();
        let mut derived_before = true;
        for module in &self.declaration.modules {
            let path = out_dir.join(&module.program);
            let rust = inspect(&path.with_extension("rs"), &self.fingerprint)?;
            derived_before &= rust.is_none() && path.with_extension("json").exists();
        }
        let timings = if derived_before {
            None
        } else {
            let environments = self.environments(out_dir);
            let derived = derive(self, &environments).map_err(|cause| Error::Rederivation {
                stale: stale.clone(),
                cause: Box::new(cause),
            })?;
            for module in &derived.modules {
                let path = out_dir.join(&module.program);
                write_if_changed(&path.with_extension("json"), &module.json)?;
                write_if_changed(&path.with_extension("rs"), &module.rust)?;
            }
            Some(derived.timings)
        };
        Ok(Outcome::new(self, stale, timings))
    }

    /// Runs the whole derivation, whatever is committed, and writes nothing but the
    /// private environment if there is none.
    ///
    /// # Errors
    ///
    /// No suitable Python, no environment, or a derivation that does not give programs.
    pub fn derive(&self) -> Result<Derived, Error> {
        derive(self, &self.environments(&self.command_directory()))
    }

    /// Derives everything and rewrites the committed files that differ.
    ///
    /// # Errors
    ///
    /// As [`derive`](Self::derive) (no file is touched), or a file cannot be written.
    pub fn write(&self) -> Result<Written, Error> {
        let derived = self.derive()?;
        let mut paths = Vec::new();
        for (path, text) in self.committed(&derived) {
            if write_if_changed(&path, text)? {
                paths.push(path);
            }
        }
        for (path, text) in self.committed_numbers().zip(&derived.numbers) {
            // Elsewhere the last bits may differ: a change of the model is the reason to write.
            if (!paths.is_empty() || !path.exists()) && write_if_changed(&path, text)? {
                paths.push(path);
            }
        }
        Ok(Written {
            paths,
            timings: derived.timings,
        })
    }

    /// Derives everything, whatever the fingerprints say, and compares programs and Rust
    /// with the committed files byte by byte (line endings aside).
    ///
    /// # Errors
    ///
    /// [`Error::Stale`] with every file that differs; otherwise as [`derive`](Self::derive).
    pub fn check(&self) -> Result<Timings, Error> {
        let derived = self.derive()?;
        let mut stale = Self::collect(self.committed(&derived).map(|(path, text)| {
            let reason = compare(&path, text)?;
            Ok((path, reason))
        }))?;
        stale.extend(
            self.committed_numbers()
                .filter(|path| !path.exists())
                .map(|path| Stale {
                    path,
                    reason: Reason::Missing,
                }),
        );
        if stale.is_empty() {
            return Ok(derived.timings);
        }
        Err(Error::Stale {
            stale,
            command: self.declaration.write_command.clone(),
        })
    }

    /// Committed Rust files.
    pub(super) fn committed_rust(&self) -> impl Iterator<Item = PathBuf> {
        self.declaration
            .modules
            .iter()
            .map(|module| self.resolve(&module.rust))
    }

    fn committed_numbers(&self) -> impl Iterator<Item = PathBuf> {
        self.declaration
            .numbers
            .iter()
            .map(|numbers| self.resolve(&numbers.committed))
    }

    /// Committed files with the texts they should have.
    fn committed<'a>(&'a self, derived: &'a Derived) -> impl Iterator<Item = (PathBuf, &'a str)> {
        self.declaration
            .modules
            .iter()
            .zip(&derived.modules)
            .flat_map(|(declared, derived)| {
                let json = declared.json.as_ref();
                let json = json.map(|json| (self.resolve(json), derived.json.as_str()));
                std::iter::once((self.resolve(&declared.rust), derived.rust.as_str())).chain(json)
            })
    }

    fn collect(
        files: impl Iterator<Item = Result<(PathBuf, Option<Reason>), Error>>,
    ) -> Result<Vec<Stale>, Error> {
        files
            .filter_map(|file| match file {
                Ok((_, None)) => None,
                Ok((path, Some(reason))) => Some(Ok(Stale { path, reason })),
                Err(error) => Some(Err(error)),
            })
            .collect()
    }

    /// Directory of the private environments of a build in `inside`.
    fn environments(&self, inside: &Path) -> PathBuf {
        if let Some(directory) = &self.settings.environments {
            return directory.clone();
        }
        target_directory(inside)
            .unwrap_or_else(|| inside.to_owned())
            .join("gyrocal-codegen")
    }

    /// Base directory of the environments of a command: the target directory in which it was built
    /// or, if it was installed, that of the workspace around the derivation.
    fn command_directory(&self) -> PathBuf {
        let program = std::env::current_exe().unwrap_or_default();
        if let Some(directory) = target_directory(&program) {
            return directory;
        }
        if let Some(directory) = std::env::var_os("CARGO_TARGET_DIR") {
            return PathBuf::from(directory);
        }
        let mut above = self.directory.ancestors();
        above
            .find(|path| path.join("Cargo.lock").is_file())
            .unwrap_or(Path::new(""))
            .join("target")
    }

    /// A declared path, with `..` taken away where it follows a name.
    fn resolve(&self, declared: &str) -> PathBuf {
        if Path::new(declared).is_absolute() {
            return PathBuf::from(declared);
        }
        let mut path = self.directory.clone();
        for part in declared.split('/') {
            match part {
                ".." => {
                    path.pop();
                }
                "." | "" => {}
                name => path.push(name),
            }
        }
        path
    }
}

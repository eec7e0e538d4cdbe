use std::path::{Path, PathBuf};

use super::committed::{Stale, write_if_changed};
use super::declaration::ModuleDeclaration;
use super::derivation::{Derivation, Written};
use super::error::{Error, at};
use super::fingerprint::{Input, fingerprint};
use super::outcome::Outcome;
use super::run::Timings;
use super::settings::{Settings, WRITE_VARIABLE};
use crate::program::is_snake_case;

/// One program that a file of another package asks of a derivation.
///
/// A derivation whose `main.py` has a function `derive_from(file, name, output)` can serve
/// packages that depend on its own: they hold a file that says what they want, and their build
/// scripts derive it with the symbols of the version that they link. The program is called as
/// the file is up to its first dot: `extended.model.toml` gives `extended.rs`.
///
/// The module is in `OUT_DIR` after [`Self::build`], whatever had to be done for it. With a
/// committed copy nothing has to be derived, and no Python is needed, as long as neither the
/// file nor the derivation nor the emitter is edited.
#[derive(Debug, Clone)]
pub struct Variant {
    derivation: Derivation,
    file: PathBuf,
    program: String,
    committed: Option<PathBuf>,
}

/// The file of a variant, as it is passed to the derivation script.
#[derive(Debug, Clone)]
pub(super) struct Request {
    pub(super) file: PathBuf,
    pub(super) program: String,
}

impl Variant {
    /// For a build script: the variant that `file` defines, of the derivation of a dependency. That
    /// has `links = "NAME"` in its manifest, and its build script prints
    /// `cargo::metadata=derive=DIRECTORY`.
    ///
    /// # Errors
    ///
    /// [`Error::NoDependency`] if cargo passes on no such dependency; as [`Self::open`].
    pub fn of_dependency(links: &str, file: impl AsRef<Path>) -> Result<Self, Error> {
        let variable = format!("DEP_{}_DERIVE", links.to_uppercase().replace('-', "_"));
        let directory = std::env::var_os(&variable).ok_or_else(|| Error::NoDependency {
            variable,
            links: links.to_owned(),
        })?;
        Self::open(directory, file)
    }

    /// Variant defined by `file`, of the derivation in `directory`.
    ///
    /// # Errors
    ///
    /// As [`Derivation::open`]; the file cannot be read, or its name gives no name of a module.
    pub fn open(directory: impl AsRef<Path>, file: impl AsRef<Path>) -> Result<Self, Error> {
        let file = file.as_ref();
        let file = file.canonicalize().map_err(at("find", file))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let program = name.split('.').next().unwrap_or_default().to_owned();
        if !is_snake_case(&program) {
            return Err(Error::Declaration {
                reason: format!(
                    "found the module name `{program}`, expected lower-case words joined by `_` \
                     before the first dot that are no Rust keyword; give the file another name, \
                     such as `extended.model.toml`"
                ),
                path: file,
            });
        }
        let mut derivation = Derivation::open(directory)?;
        let text = std::fs::read_to_string(&file).map_err(at("read", &file))?;
        derivation.fingerprint = fingerprint(vec![
            Input::new("derivation", &derivation.fingerprint),
            Input::new(format!("file/{name}"), &text),
        ]);
        derivation.declaration.source = format!("{}, {name}", derivation.declaration.source);
        derivation.declaration.write_command = format!("{WRITE_VARIABLE}=1 cargo build");
        derivation.declaration.numbers.clear();
        derivation.declaration.modules.clear();
        derivation.request = Some(Request {
            file: file.clone(),
            program: program.clone(),
        });
        Ok(Self {
            derivation,
            file,
            program,
            committed: None,
        })
    }

    /// With a copy of the module in this directory, which version control keeps.
    #[must_use]
    pub fn committed(mut self, directory: impl AsRef<Path>) -> Self {
        let directory = directory.as_ref();
        // Absolute, or it would be taken relative to the derivation.
        let directory = std::path::absolute(directory).unwrap_or_else(|_| directory.to_owned());
        let copy = directory.join(format!("{}.rs", self.program));
        self.derivation.declaration.modules = vec![self.module(&copy)];
        self.committed = Some(copy);
        self
    }

    /// The same variant with other settings.
    #[must_use]
    pub fn with_settings(mut self, settings: Settings) -> Self {
        self.derivation = self.derivation.with_settings(settings);
        self
    }

    /// SHA-256 over everything that the module depends on, in hexadecimal.
    #[must_use]
    pub fn fingerprint(&self) -> &str {
        self.derivation.fingerprint()
    }

    /// The committed copy if it cannot be used, found without Python.
    ///
    /// # Errors
    ///
    /// It exists and cannot be read.
    pub fn stale(&self) -> Result<Vec<Stale>, Error> {
        self.derivation.stale()
    }

    /// For a build script: puts the module into `out_dir`, from the committed copy if that is
    /// fresh, otherwise from a derivation. With [`WRITE_VARIABLE`] a stale copy is written anew.
    ///
    /// # Errors
    ///
    /// The derivation was necessary and failed; `out_dir` is then as it was.
    pub fn build(&self, out_dir: impl AsRef<Path>) -> Result<Outcome, Error> {
        let module = out_dir.as_ref().join(format!("{}.rs", self.program));
        let Some(copy) = &self.committed else {
            let mut derivation = self.derivation.clone();
            derivation.declaration.modules = vec![self.module(&module)];
            let timings = match derivation.stale()?.is_empty() {
                true => None,
                false => Some(derivation.write()?.timings),
            };
            let outcome = Outcome::new(&self.derivation, Vec::new(), timings);
            return Ok(outcome.watching(&self.file));
        };
        if self.derivation.settings.write && !self.stale()?.is_empty() {
            self.derivation.write()?;
        }
        let outcome = self.derivation.build(out_dir)?.watching(&self.file);
        if outcome.is_fresh() {
            let text = std::fs::read_to_string(copy).map_err(at("read", copy))?;
            write_if_changed(&module, &text)?;
        }
        Ok(outcome)
    }

    /// Derives the module and rewrites the committed copy if it differs.
    ///
    /// # Errors
    ///
    /// As [`Derivation::write`].
    pub fn write(&self) -> Result<Written, Error> {
        self.derivation.write()
    }

    /// Derives the module and compares it with the committed copy byte by byte.
    ///
    /// # Errors
    ///
    /// As [`Derivation::check`].
    pub fn check(&self) -> Result<Timings, Error> {
        self.derivation.check()
    }

    fn module(&self, rust: &Path) -> ModuleDeclaration {
        ModuleDeclaration {
            program: self.program.clone(),
            rust: rust.to_string_lossy().into_owned(),
            json: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_the_dependency_the_error_says_what_to_add() {
        let error = Variant::of_dependency("no-such", "x.toml").unwrap_err();
        let said = error.to_string();
        assert!(said.contains("DEP_NO_SUCH_DERIVE"), "{said}");
        assert!(said.contains("links = \"no-such\""), "{said}");
    }

    #[test]
    fn a_file_that_names_no_module_is_refused() {
        let folder = std::env::temp_dir().join(format!("gyrocal-names-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let refused = ["2-wrong", "fn", "a b;c", "a__b", ""].map(|name| {
            let path = folder.join(format!("{name}.model.toml"));
            std::fs::write(&path, "").unwrap();
            (name, Variant::open("nowhere", &path).unwrap_err())
        });
        std::fs::remove_dir_all(&folder).unwrap();
        for (name, error) in refused {
            let found = format!("found the module name `{name}`");
            assert!(error.to_string().contains(&found), "{error}");
        }
    }
}

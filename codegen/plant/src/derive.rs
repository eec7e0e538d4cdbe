//! The derivation of one script, in a directory of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use gyrocal_codegen::Program;
use gyrocal_codegen::build::{Derivation, Settings, target_directory};

use crate::error::{Error, at};

/// The Python package of plants, and the script that runs a user's.
const PYTHON: [(&str, &str); 6] = [
    ("main.py", include_str!("../derive/main.py")),
    (
        "gyrocal_plant/__init__.py",
        include_str!("../gyrocal_plant/__init__.py"),
    ),
    (
        "gyrocal_plant/declaration.py",
        include_str!("../gyrocal_plant/declaration.py"),
    ),
    (
        "gyrocal_plant/dependence.py",
        include_str!("../gyrocal_plant/dependence.py"),
    ),
    (
        "gyrocal_plant/grammar.py",
        include_str!("../gyrocal_plant/grammar.py"),
    ),
    (
        "gyrocal_plant/units.py",
        include_str!("../gyrocal_plant/units.py"),
    ),
];

/// A derived plant.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DerivedPlant {
    /// The program (JSON), which `gyrocal-plant` interprets.
    pub program: String,
    /// Generated Rust of the same functions.
    pub rust: String,
    /// Type of the model in that Rust.
    pub model: String,
    /// Terms that the catalogue leaves out, a line each, with the reason.
    pub left_out: Vec<String>,
}

/// Derives the plant of a script. A private environment with the pinned CasADi is made where there is none.
///
/// # Errors
/// [`Error::File`]; [`Error::Derivation`] if there is no suitable Python, or with the words of the script's
/// refusal and its line.
pub fn derive(script: &Path, settings: Settings) -> Result<DerivedPlant, Error> {
    let work = Work::make()?;
    let derivation = open(script, &work.0)?.with_settings(settings);
    let derived = derivation.derive()?;
    let [module] = <[_; 1]>::try_from(derived.modules)
        .map_err(|_| Error::Package("the derivation gave no program".to_owned()))?;
    let left_out = derived.numbers.first();
    Ok(DerivedPlant {
        model: model(&module.json)?,
        program: module.json,
        rust: module.rust,
        left_out: left_out.map_or_else(Vec::new, |text| text.lines().map(str::to_owned).collect()),
    })
}

/// Settings of a command: those of the environment variables; private environments are kept in the user's
/// cache unless the command is one of a target directory.
#[must_use]
pub fn settings_of_a_command() -> Settings {
    let mut settings = Settings::from_env();
    let own = std::env::current_exe().unwrap_or_default();
    if settings.environments.is_none() && target_directory(&own).is_none() {
        settings.environments = cache().map(|cache| cache.join("gyrocal"));
    }
    settings
}

fn cache() -> Option<PathBuf> {
    let of = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    let given = of("XDG_CACHE_HOME").or_else(|| of("LOCALAPPDATA"));
    let home = of("HOME").map(|home| PathBuf::from(home).join(".cache"));
    given.map(PathBuf::from).or(home)
}

/// Writes the derivation of a script into a directory and opens it. What the program depends on is part of
/// its fingerprint, the place of the script is not.
pub(crate) fn open(script: &Path, directory: &Path) -> Result<Derivation, Error> {
    let text = fs::read_to_string(script).map_err(at("read", script))?;
    let script = script.canonicalize().map_err(at("read", script))?;
    let name = script.file_name().unwrap_or_default().to_string_lossy();
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
    let name: String = name.chars().filter(|letter| plain(*letter)).collect();
    let declaration = format!(
        "source = \"{name}\"\nwrite_command = \"GYROCAL_CODEGEN_WRITE=1 cargo build\"\n\n[[module]]\n\
         program = \"plant\"\nrust = \"plant.rs\"\n\n[[numbers]]\nfile = \"left_out.txt\"\n\
         committed = \"left_out.txt\"\n"
    );
    let place = script.to_string_lossy();
    let files = PYTHON.iter().copied().chain([
        ("derivation.toml", declaration.as_str()),
        ("script.txt", &*place),
        ("script.py", text.as_str()),
    ]);
    for (file, text) in files {
        let path = directory.join(file);
        let folder = path.parent().unwrap_or(directory);
        fs::create_dir_all(folder).map_err(at("written", folder))?;
        fs::write(&path, text).map_err(at("written", &path))?;
    }
    Ok(Derivation::open(directory)?)
}

/// Type of the model of a program.
pub(crate) fn model(program: &str) -> Result<String, Error> {
    let program = Program::from_json(program, "plant.json")?;
    let model = program.model.map(|model| model.name);
    model.ok_or_else(|| Error::Package("the program has no model".to_owned()))
}

/// A directory of this call's own, removed at the end.
struct Work(PathBuf);

impl Work {
    fn make() -> Result<Self, Error> {
        static CALLS: AtomicU32 = AtomicU32::new(0);
        let call = CALLS.fetch_add(1, Ordering::Relaxed);
        let name = format!("gyrocal-plant-{}-{call}", std::process::id());
        let path = std::env::temp_dir().join(name);
        // A name that is taken is someone else's directory.
        fs::create_dir(&path).map_err(at("written", &path))?;
        Ok(Self(path))
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

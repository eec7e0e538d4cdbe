//! The hash of the sources that can move a result: files of packages, of all packages that they depend on by path,
//! and single files. Equal sources give equal hashes on every machine.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use gyrocal_testkit::workspace;
use serde::Deserialize;
use sha2::{Digest as _, Sha256};
use toml::{Table, Value};

use crate::error::Error;

/// Digits of a hash that are printed.
const DIGITS: usize = 12;

/// Parts of a package that its dependants do not compile.
const OWN: [&str; 3] = ["tests", "benches", "examples"];

/// Packages of the platform's filter, of its calibration and diagnosis, of plants, and of all commands, each with
/// all that it depends on.
pub(crate) const FILTER: &[&str] = &["", "crates/testkit"];
pub(crate) const CALIBRATION: &[&str] =
    &["crates/calibration", "crates/truth", "crates/evaluation"];
pub(crate) const DIAGNOSIS: &[&str] = &[
    "crates/diagnosis",
    "crates/design",
    "crates/truth",
    "crates/evaluation",
];
pub(crate) const INSTRUMENTS: &[&str] = &["crates/instruments", "crates/diagnosis", "crates/truth"];
pub(crate) const PLANTS: &[&str] = &[
    "crates/plant",
    "crates/truth",
    "codegen/plant",
    "crates/evaluation",
];
pub(crate) const COMMAND: &[&str] = &["crates/cli"];

/// What measures and judges the small version of every part: this harness, what parts share, and the pages.
pub(crate) const JUDGING: Sources = of(
    &[],
    &[
        "crates/figures/src/cost.rs",
        "crates/figures/src/figure.rs",
        "crates/figures/src/harness",
        "crates/figures/src/harness.rs",
        "crates/figures/src/page.rs",
        "crates/figures/src/values.rs",
        "docs/figures",
    ],
);

/// Groups of packages by the names that tables give them.
const GROUPS: [(&str, &[&str]); 6] = [
    ("filter", FILTER),
    ("calibration", CALIBRATION),
    ("diagnosis", DIAGNOSIS),
    ("instruments", INSTRUMENTS),
    ("plants", PLANTS),
    ("command", COMMAND),
];

/// Entries of a table of topics or of slow sections.
#[derive(Deserialize)]
pub(crate) struct Listed<T> {
    #[serde(alias = "topic", alias = "section")]
    pub(crate) all: Vec<T>,
}

/// Sources in an entry: a group or packages, and files.
#[derive(Deserialize)]
struct ListedSources {
    group: Option<String>,
    #[serde(default)]
    packages: Vec<String>,
    files: Vec<String>,
}

/// What a result depends on, from the root of the workspace.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "ListedSources")]
pub(crate) struct Sources {
    /// Folders of packages: all of their files, and those that they depend on by path.
    pub(crate) packages: &'static [&'static str],
    /// Further files and folders.
    pub(crate) files: &'static [&'static str],
}

/// Packages and files.
pub(crate) const fn of(
    packages: &'static [&'static str],
    files: &'static [&'static str],
) -> Sources {
    Sources { packages, files }
}

impl TryFrom<ListedSources> for Sources {
    type Error = String;

    fn try_from(listed: ListedSources) -> Result<Self, String> {
        // Tables are there as long as the program.
        let kept = |all: Vec<String>| -> &'static [&'static str] {
            let all = all.into_iter().map(|one| &*one.leak());
            all.collect::<Vec<&'static str>>().leak()
        };
        let packages = match listed.group {
            Some(group) => {
                let own = GROUPS.iter().find(|(name, _)| *name == group);
                own.ok_or_else(|| format!("found no group `{group}`"))?.1
            }
            None => kept(listed.packages),
        };
        Ok(of(packages, kept(listed.files)))
    }
}

impl Sources {
    /// The hash, computed once in a process.
    pub(crate) fn hash(&self) -> Result<String, Error> {
        static KNOWN: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
        let key = format!("{self:?}");
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known.get(&key) {
            return Ok(hash.clone());
        }
        let root = workspace();
        let hash = self.hash_with(&root, |file| Ok(std::fs::read(root.join(file))?))?;
        known.insert(key, hash.clone());
        Ok(hash)
    }

    /// The hash of the contents that `read` gives for each file.
    pub(crate) fn hash_with(
        &self,
        root: &Path,
        read: impl Fn(&Path) -> Result<Vec<u8>, Error>,
    ) -> Result<String, Error> {
        let mut hasher = Sha256::new();
        for file in self.all_files(root)? {
            hasher.update(file.to_string_lossy().as_bytes());
            let content = read(&file)?;
            hasher.update((content.len() as u64).to_le_bytes());
            hasher.update(content);
        }
        let digest = hasher.finalize();
        let text: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(text[..DIGITS].to_owned())
    }

    /// All files, sorted, without those that version control ignores.
    pub(crate) fn all_files(&self, root: &Path) -> Result<Vec<PathBuf>, Error> {
        let files = self.files.iter().chain(&["Cargo.toml", "Cargo.lock"]);
        let mut paths: BTreeSet<String> = files.map(|file| (*file).to_owned()).collect();
        for (package, is_named) in closure(root, self.packages)? {
            let folder = package.to_string_lossy().into_owned();
            // The root package is a workspace, too: of its folder the parts that it is compiled from.
            if folder.is_empty() {
                paths.extend(["src", "build.rs", "codegen/derive"].map(str::to_owned));
                continue;
            }
            if !is_named {
                paths.extend(OWN.map(|part| format!(":(exclude){folder}/{part}")));
            }
            paths.insert(folder);
        }
        let list = "ls-files --cached --others --exclude-standard -z --";
        let mut git = Command::new("git");
        git.arg("-C").arg(root).args(list.split(' ')).args(&paths);
        let output = git.output()?;
        if !output.status.success() {
            let why = String::from_utf8_lossy(&output.stderr);
            return Err(format!("git does not list the sources: {why}").into());
        }
        let names = String::from_utf8_lossy(&output.stdout);
        let names = names.split('\0').filter(|name| !name.is_empty());
        let files: BTreeSet<PathBuf> = names.map(PathBuf::from).collect();
        let there = files.into_iter().filter(|file| root.join(file).is_file());
        Ok(there.collect())
    }
}

/// Folders of packages and of all that they depend on by path; `true` for those that are named.
fn closure(root: &Path, named: &[&str]) -> Result<BTreeMap<PathBuf, bool>, Error> {
    let shared = manifest(root, Path::new(""))?;
    let shared = shared.get("workspace");
    let shared = shared.and_then(|all| all.get("dependencies"));
    let mut found: BTreeMap<PathBuf, bool> = BTreeMap::new();
    let mut waiting: Vec<PathBuf> = named.iter().map(PathBuf::from).collect();
    while let Some(folder) = waiting.pop() {
        if found.contains_key(&folder) {
            continue;
        }
        let is_named = named.iter().any(|one| folder == Path::new(one));
        let manifest = manifest(root, &folder)?;
        let kinds: &[&str] = match is_named {
            true => &["dependencies", "build-dependencies", "dev-dependencies"],
            false => &["dependencies", "build-dependencies"],
        };
        let tables = kinds
            .iter()
            .filter_map(|kind| manifest.get(*kind)?.as_table());
        for (name, dependency) in tables.flatten() {
            let of_all = || shared?.get(name)?.get("path")?.as_str();
            let own = dependency.get("path").and_then(Value::as_str);
            let path = match dependency.get("workspace") {
                Some(_) if own.is_none() => of_all().map(PathBuf::from),
                _ => own.map(|path| folder.join(path)),
            };
            waiting.extend(path.map(|path| plain(&path)));
        }
        found.insert(folder, is_named);
    }
    Ok(found)
}

fn manifest(root: &Path, folder: &Path) -> Result<Table, Error> {
    let path = root.join(folder).join("Cargo.toml");
    let text =
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(toml::from_str(&text)?)
}

/// The path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.iter().filter_map(|part| part.to_str()) {
        match part {
            ".." => drop(parts.pop()),
            "." => {}
            part => parts.push(part),
        }
    }
    parts.iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WATCH: Sources = Sources {
        packages: &["crates/watch"],
        files: &["LICENSE-MIT"],
    };

    #[test]
    fn a_change_of_any_file_is_seen() {
        let root = workspace();
        let plain = WATCH.hash_with(&root, |_| Ok(Vec::new())).unwrap();
        for changed in WATCH.all_files(&root).unwrap() {
            let read = |file: &Path| Ok(vec![b'x'; usize::from(file == changed)]);
            let hash = WATCH.hash_with(&root, read).unwrap();
            assert_ne!(hash, plain, "{}", changed.display());
        }
    }

    #[test]
    fn dependencies_by_path_are_sources_but_not_their_tests() {
        let files = WATCH.all_files(&workspace()).unwrap();
        let has = |file: &str| files.iter().any(|one| one == Path::new(file));
        assert!(has("crates/watch/src/lib.rs") && has("crates/watch/tests/dense.rs"));
        assert!(has("LICENSE-MIT") && has("crates/scalar/src/lib.rs") && has("Cargo.lock"));
        assert!(!has("crates/scalar/tests/single_precision.rs"));
        assert!(!has("crates/diagnosis/src/lib.rs"));
    }

    #[test]
    fn a_named_package_has_its_tests_where_another_depends_on_it() {
        let both = of(&["crates/scalar", "crates/watch"], &[]);
        let files = both.all_files(&workspace()).unwrap();
        let test = Path::new("crates/scalar/tests/single_precision.rs");
        assert!(files.iter().any(|file| file == test));
    }
}

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use crate::files::edit;

/// The workspace that these tests belong to.
pub fn workspace() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

/// A copy of the workspace as version control would hold it.
pub struct WorkspaceCopy {
    /// The copy's root.
    pub root: PathBuf,
}

impl WorkspaceCopy {
    /// Makes `NAME/workspace` below `scratch` equal to the workspace. Files that are equal keep
    /// their times and others get new ones, so that cargo rebuilds only what has changed.
    pub fn make(scratch: &str, name: &str) -> Self {
        let root = Path::new(scratch).join(name).join("workspace");
        synchronise(&workspace(), &root);
        Self { root }
    }

    /// The derivation of the copy.
    pub fn derivation(&self) -> PathBuf {
        self.root.join("codegen/derive")
    }

    /// Replaces the one occurrence of `from` in a file of the copy.
    pub fn edit(&self, file: &str, from: &str, to: &str) {
        edit(self.root.join(file), from, to);
    }
}

fn synchronise(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    let mut wanted = BTreeSet::<OsString>::new();
    for entry in fs::read_dir(from).unwrap() {
        let source = entry.unwrap().path();
        let name = source.file_name().unwrap();
        let text = name.to_string_lossy();
        if ["target", ".git", "__pycache__"].contains(&&*text) || text.ends_with(".tmp") {
            continue;
        }
        wanted.insert(name.to_owned());
        let target = to.join(name);
        if source.is_dir() {
            synchronise(&source, &target);
        } else {
            let contents = fs::read(&source).unwrap();
            if fs::read(&target).ok().as_ref() != Some(&contents) {
                fs::write(&target, contents).unwrap();
            }
        }
    }
    for entry in fs::read_dir(to).unwrap() {
        let path = entry.unwrap().path();
        if wanted.contains(path.file_name().unwrap()) {
            continue;
        }
        if path.is_dir() {
            fs::remove_dir_all(path).unwrap();
        } else {
            fs::remove_file(path).unwrap();
        }
    }
}

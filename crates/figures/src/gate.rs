//! Slow sections of continuous integration: what each depends on, and its stamp.
//!
//! A stamp, `.ci/stamps/NAME`, is the hash of the sources of a section when it passed last. `.ci/run` runs a section
//! if its stamp is of other sources, and the section writes its stamp itself.

use serde::Deserialize;

use crate::harness::stamp::Stamp;
use crate::harness::{Error, Listed, Sources};

/// A slow section.
#[derive(Deserialize)]
struct SlowSection {
    /// Its name, that of its script in `.ci/slow` and of its stamp.
    name: String,
    #[serde(flatten)]
    sources: Sources,
}

/// All of them, in the order in which they are run.
fn sections() -> Result<Vec<SlowSection>, Error> {
    let sections: Listed<SlowSection> = toml::from_str(include_str!("gate.toml"))?;
    Ok(sections.all)
}

impl SlowSection {
    fn stamp(&self) -> Result<Stamp, Error> {
        Stamp::new(&self.name, &[&self.sources])
    }
}

/// What is asked of slow sections.
#[derive(clap::Args, Debug)]
#[group(required = true, multiple = false)]
pub(crate) struct Section {
    /// List those whose stamp is of other sources than these.
    #[arg(long)]
    stale: bool,
    /// List all.
    #[arg(long)]
    all: bool,
    /// Write the stamp of a section that has passed; its script does this.
    #[arg(long, value_name = "NAME")]
    passed: Option<String>,
}

impl Section {
    /// Prints names, a line each, or writes a stamp.
    pub(crate) fn run(&self) -> Result<(), Error> {
        if let Some(name) = &self.passed {
            let mut sections = sections()?.into_iter();
            let section = sections.find(|section| section.name == *name);
            let section = section.ok_or_else(|| format!("no slow section is called `{name}`"))?;
            return section.stamp()?.write();
        }
        for section in sections()? {
            if self.all || section.stamp()?.is_stale() {
                println!("{}", section.name);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use gyrocal_testkit::workspace;

    use super::*;

    #[test]
    fn a_change_of_one_file_of_each_list_makes_a_section_stale() {
        let root = workspace();
        for section in sections().unwrap() {
            let hash = |changed: &Path| {
                let read = |file: &Path| Ok(vec![u8::from(file == changed)]);
                section.sources.hash_with(&root, read).unwrap()
            };
            let files = section.sources.all_files(&root).unwrap();
            let (name, before) = (&section.name, hash(Path::new("")));
            let lists = section.sources.packages.iter();
            for list in lists.chain(section.sources.files) {
                // Of the root package the library.
                let list = if list.is_empty() { "src" } else { list };
                let changed = files.iter().find(|file| file.starts_with(list));
                let changed = changed.unwrap_or_else(|| panic!("{name}: no file in {list}"));
                assert_ne!(hash(changed), before, "{name}: {}", changed.display());
            }
        }
    }

    #[test]
    fn each_section_has_a_script() {
        let folder = workspace().join(".ci/slow");
        let scripts = std::fs::read_dir(&folder).unwrap();
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
        let mut scripts: Vec<String> = scripts
            .map(|entry| name(entry).into_string().unwrap())
            .collect();
        let all = sections().unwrap();
        for section in &all {
            let script = format!(".ci/slow/{}", section.name);
            assert!(section.sources.files.contains(&&*script), "{script}");
        }
        scripts.sort();
        let mut names: Vec<&str> = all.iter().map(|section| &*section.name).collect();
        names.sort_unstable();
        assert_eq!(scripts, names);
    }
}

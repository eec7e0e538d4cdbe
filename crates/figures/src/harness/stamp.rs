//! Stamps: of which sources something passed last.

use std::path::PathBuf;

use gyrocal_testkit::workspace;

use super::sources::Sources;
use crate::error::Error;

/// The stamp of a section of the gate or of the small version of a part: `.ci/stamps/NAME`, committed, and written
/// by what passed, never by hand.
pub(crate) struct Stamp {
    path: PathBuf,
    /// What it is to say.
    sources: String,
}

impl Stamp {
    /// The stamp of this name, for something that depends on all of these sources.
    pub(crate) fn new(name: &str, sources: &[&Sources]) -> Result<Self, Error> {
        let hashes: Result<Vec<String>, Error> = sources.iter().map(|one| one.hash()).collect();
        Ok(Self {
            path: workspace().join(".ci/stamps").join(name),
            sources: format!("{}\n", hashes?.join(" ")),
        })
    }

    /// Whether it is of other sources than these.
    pub(crate) fn is_stale(&self) -> bool {
        std::fs::read_to_string(&self.path).map_or(true, |stamp| stamp != self.sources)
    }

    /// Writes it.
    pub(crate) fn write(&self) -> Result<(), Error> {
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(gyrocal_record::write_whole(
            &self.path,
            self.sources.as_bytes(),
        )?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_stale_until_it_is_written_and_after_a_change() {
        let folder = tempfile::tempdir().unwrap();
        let of = |sources: &str| Stamp {
            path: folder.path().join("figures/part"),
            sources: sources.to_owned(),
        };
        assert!(of("one").is_stale());
        of("one").write().unwrap();
        assert!(!of("one").is_stale());
        assert!(of("other").is_stale());
    }
}

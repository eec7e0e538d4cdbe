//! What may change at which step: `moves.toml`.

use std::path::Path;

use serde::Deserialize;

use crate::harness::Error;

const FILE: &str = "moves.toml";

/// Keys of records that may differ from what they were. In names and paths `*` stands for any letters.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Move {
    step: String,
    records: Vec<String>,
    keys: Vec<String>,
    /// For people, who must give one.
    #[serde(rename = "reason")]
    _reason: String,
    #[serde(skip)]
    is_needed: bool,
}

/// All of them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Moves {
    #[serde(default, rename = "move")]
    all: Vec<Move>,
}

impl Moves {
    pub(crate) fn read(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(FILE);
        let moves = toml::from_str(&std::fs::read_to_string(&path)?);
        moves.map_err(|error| format!("{}: {error}", path.display()).into())
    }

    /// Whether a key of a record may differ. The entry that allows it is needed.
    pub(crate) fn allow(&mut self, record: &str, path: &str) -> bool {
        let any = |patterns: &[String], text| patterns.iter().any(|one| matches(one, text));
        let mut all = self.all.iter_mut();
        all.find(|one| any(&one.records, record) && any(&one.keys, path))
            .map(|one| one.is_needed = true)
            .is_some()
    }

    /// Steps of the entries that allowed nothing.
    pub(crate) fn unneeded(&self) -> Vec<&str> {
        let unneeded = self.all.iter().filter(|one| !one.is_needed);
        unneeded.map(|one| &*one.step).collect()
    }
}

/// Leaves of the file what stands above the first entry.
pub(crate) fn empty(folder: &Path) -> Result<(), Error> {
    let path = folder.join(FILE);
    let text = std::fs::read_to_string(&path)?;
    let above = text.split("\n[[move]]").next().unwrap_or_default();
    let text = format!("{}\n", above.trim_end());
    Ok(gyrocal_record::write_whole(&path, text.as_bytes())?)
}

/// Whether a text is what a pattern says, in which `*` stands for any letters.
pub(crate) fn matches(pattern: &str, text: &str) -> bool {
    let Some((head, rest)) = pattern.split_once('*') else {
        return pattern == text;
    };
    text.strip_prefix(head).is_some_and(|left| {
        let mut ends = left.char_indices().map(|(at, _)| &left[at..]).chain([""]);
        ends.any(|end| matches(rest, end))
    })
}

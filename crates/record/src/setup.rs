//! Gross errors of a set-up, as results tell them.

use crate::printable::printable_line;
use serde::{Deserialize, Serialize};

/// A gross error of the set-up: a wrong description or a wrong use of the instrument, which is no
/// effect of the catalogue.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetupProblem {
    /// Its kind: `clock`, `missing`, `missing-coded`, `unit`, `stuck`, `clipped`, `repeated`,
    /// `duplicated`, `scale`, `jump`, `still`, `handedness`, `axes`, `angles`, `latitude`,
    /// `attitude` or `gravity`.
    pub kind: String,
    /// The problem in words, with what to do.
    pub description: String,
    /// The numbers that show it.
    pub evidence: String,
    /// First and last row that it concerns, counted from 1; `None` if it concerns all.
    #[serde(default)]
    pub rows: Option<[usize; 2]>,
    /// Whether nothing sound is left, so that nothing was estimated.
    #[serde(default)]
    pub stops: bool,
    /// Other errors that the record cannot tell from it.
    #[serde(default)]
    pub equivalents: Vec<String>,
    /// The record that has it, as its path was given; `None` of a record without a file.
    #[serde(default)]
    pub file: Option<String>,
    /// First and last line of the file that it concerns, counted from 1; `None` if it concerns all.
    #[serde(default)]
    pub lines: Option<[usize; 2]>,
}

impl SetupProblem {
    /// The problem with its place, its equivalents and its evidence, as one paragraph.
    #[must_use]
    pub fn text(&self) -> String {
        let equivalents = match &self.equivalents[..] {
            [] => String::new(),
            some => format!(" The record cannot tell it from: {}.", some.join("; ")),
        };
        let Self {
            description,
            evidence,
            ..
        } = self;
        format!("{}{description}{equivalents} ({evidence})", self.place())
    }

    /// The problem with its place, as one sentence or two.
    #[must_use]
    pub fn placed(&self) -> String {
        format!("{}{}", self.place(), self.description)
    }

    /// File and lines, as the beginning of a sentence.
    fn place(&self) -> String {
        match (&self.file, self.lines) {
            (None, _) => String::new(),
            (Some(file), None) => format!("{}: ", printable_line(file)),
            (Some(file), Some([first, last])) if first == last => {
                format!("{}:{first}: ", printable_line(file))
            }
            (Some(file), Some([first, last])) => {
                format!("{}:{first}-{last}: ", printable_line(file))
            }
        }
    }
}

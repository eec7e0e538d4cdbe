//! Errors of a program, with its file.

use std::collections::BTreeSet;
use std::fmt::Display;

use super::names::is_snake_case;
use crate::Error;

/// Advice for a program that the exporter cannot have written.
pub(super) const DERIVE_AGAIN: &str = "derive the program again, and do not edit it by hand";

/// Makes errors that know their file.
pub(super) struct Context<'a> {
    pub(super) origin: &'a str,
}

impl Context<'_> {
    pub(super) fn error(
        &self,
        place: &str,
        found: impl Display,
        expected: impl Display,
        remedy: impl Display,
    ) -> Error {
        Error::Program {
            origin: self.origin.to_owned(),
            place: place.to_owned(),
            found: found.to_string(),
            expected: expected.to_string(),
            remedy: remedy.to_string(),
        }
    }

    pub(super) fn name(&self, place: &str, name: &str, expected: &str) -> Error {
        Error::Name {
            origin: self.origin.to_owned(),
            place: place.to_owned(),
            name: name.to_owned(),
            expected: expected.to_owned(),
        }
    }

    /// Names that are fit for Rust and differ.
    pub(super) fn names<'n>(
        &self,
        place: &str,
        names: impl Iterator<Item = &'n str>,
    ) -> Result<(), Error> {
        let mut seen = BTreeSet::new();
        for name in names {
            if !is_snake_case(name) {
                return Err(self.name(
                    place,
                    name,
                    "lower-case words joined by `_` that are no Rust keyword, such as `rate_x`",
                ));
            }
            if !seen.insert(name) {
                return Err(self.name(place, name, "each name once"));
            }
        }
        Ok(())
    }
}

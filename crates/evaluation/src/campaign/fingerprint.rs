//! Identity of a campaign: results are only reused by the campaign that made them.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use serde::{Deserialize, Serialize};

/// Everything but the seeds that results depend on: only a campaign with an equal fingerprint may
/// resume from them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint(Vec<(String, String)>);

impl Fingerprint {
    /// Fingerprint of a job of this name, in this version of the program.
    #[must_use]
    pub fn new(job: &str) -> Self {
        Self(Vec::new())
            .with("job", job)
            .with("version", env!("CARGO_PKG_VERSION"))
    }

    /// Adds a value that the results depend on, under a name fit for an error message.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl ToString) -> Self {
        self.0.push((name.to_owned(), value.to_string()));
        self
    }

    /// First difference to the fingerprint in a file, in words; `None` if they are equal.
    pub(crate) fn difference(&self, found: &Self) -> Option<String> {
        for (index, (name, expected)) in self.0.iter().enumerate() {
            let Some((found_name, found)) = found.0.get(index) else {
                return Some(format!("without a {name}, expected {}", quoted(expected)));
            };
            if found_name != name {
                return Some(format!("with a {found_name}, expected a {name}"));
            }
            if found != expected {
                let (found, expected) = first_difference(found, expected);
                let (found, expected) = (quoted(found), quoted(expected));
                return Some(format!("of {name} {found}, expected {expected}"));
            }
        }
        let (name, _) = found.0.get(self.0.len())?;
        Some(format!("with a {name}, expected none"))
    }
}

/// A hash of the running program, to distinguish results of different builds where they depend on
/// all of the code. `unknown` if the program cannot read itself.
#[must_use]
pub fn program() -> String {
    let Ok(bytes) = std::env::current_exe().and_then(std::fs::read) else {
        return "unknown".to_owned();
    };
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

fn quoted(value: &str) -> String {
    format!("`{}`", value.trim())
}

/// The first lines in which two texts differ.
fn first_difference<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let mut lines = (one.lines(), other.lines());
    loop {
        match (lines.0.next(), lines.1.next()) {
            (Some(one), Some(other)) if one == other => (),
            (None, None) => return (one, other),
            (one, other) => return (one.unwrap_or(""), other.unwrap_or("")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_reported() {
        let base = Fingerprint::new("j").with("scenario", "a: 1\nb: 2,\nc: 3");
        let said = |other: &Fingerprint| base.difference(other);
        assert_eq!(said(&base.clone()), None);
        let other = Fingerprint::new("k").with("scenario", "a: 1\nb: 2,\nc: 3");
        assert_eq!(said(&other).as_deref(), Some("of job `k`, expected `j`"));
        let other = Fingerprint::new("j").with("scenario", "a: 1\n  b: 5,\nc: 4");
        assert_eq!(
            said(&other).as_deref(),
            Some("of scenario `b: 5,`, expected `b: 2,`")
        );
        let other = Fingerprint::new("j");
        assert!(said(&other).is_some_and(|text| text.starts_with("without a scenario")));
        let other = base.clone().with("more", 1);
        assert_eq!(said(&other).as_deref(), Some("with a more, expected none"));
        let other = Fingerprint::new("j").with("options", "a");
        assert_eq!(
            said(&other).as_deref(),
            Some("with a options, expected a scenario")
        );
    }

    #[test]
    fn a_program_is_itself() {
        assert_eq!(program(), program());
        // Sixteen hexadecimal digits: it could be read.
        assert_eq!(program().len(), 16);
    }
}

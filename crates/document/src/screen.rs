//! The first screen of an answer.

use serde::Serialize;

use crate::Table;

/// The first screen of an answer: the verdict, how large and how sure it is, what else it might be,
/// what it does to the coefficients, and what to do next. It fits a terminal of 80 columns and 24
/// lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Screen {
    /// How good the news is.
    pub standing: Standing,
    /// The verdict in a few capital words.
    pub verdict: String,
    /// The thing that the verdict is on.
    pub what: String,
    /// Facts, the most important first.
    pub facts: Vec<Fact>,
    /// A table, if the answer is one.
    pub table: Option<Table>,
    /// Commands to run next.
    pub next: Vec<NextStep>,
}

/// How good the news of a verdict is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// Work that was done; no judgement.
    #[default]
    Neutral,
    /// As it should be.
    Good,
    /// To be looked at.
    Doubtful,
    /// Wrong.
    Bad,
}

/// A fact with its label.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fact {
    /// The question that it answers, in one to three words.
    pub label: String,
    /// The answer.
    pub words: String,
}

/// A command to run next.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NextStep {
    /// The whole command line, as a shell reads it.
    pub command: String,
    /// What it tells.
    pub why: String,
}

impl Screen {
    /// A screen with a verdict and nothing else.
    #[must_use]
    pub fn new(standing: Standing, verdict: &str, what: impl Into<String>) -> Self {
        Self {
            standing,
            verdict: verdict.to_owned(),
            what: what.into(),
            ..Self::default()
        }
    }

    /// The verdict, and the thing that it is on.
    #[must_use]
    pub fn headline(&self) -> String {
        match self.what.is_empty() {
            true => self.verdict.clone(),
            false => format!("{}: {}", self.verdict, self.what),
        }
    }

    /// Adds a fact, unless there is nothing to say.
    pub fn fact(&mut self, label: &str, words: impl Into<String>) {
        let words = words.into();
        if !words.is_empty() {
            self.facts.push(Fact {
                label: label.to_owned(),
                words,
            });
        }
    }

    /// Adds a fact of the same label for each of these words.
    pub fn each(&mut self, label: &str, words: impl IntoIterator<Item = impl Into<String>>) {
        words.into_iter().for_each(|words| self.fact(label, words));
    }

    /// Adds a command to run next.
    pub fn then(&mut self, command: impl Into<String>, why: &str) {
        self.next.push(NextStep {
            command: command.into(),
            why: why.to_owned(),
        });
    }
}

//! The first screen of an answer, as plain data.

use gyrocal_record::{Input, InputRole, shell_quoted};
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

    /// Adds a command to run next.
    pub fn then(&mut self, command: impl Into<String>, why: &str) {
        self.next.push(NextStep {
            command: command.into(),
            why: why.to_owned(),
        });
    }
}

/// `RECORD --bench BENCH` of the first two inputs of a result, as a shell reads them.
#[must_use]
pub fn record_and_bench(inputs: &[Input]) -> String {
    let path = |place: usize, otherwise: &str| {
        inputs
            .get(place)
            .map_or_else(|| otherwise.to_owned(), |input| shell_quoted(&input.path))
    };
    format!(
        "{} --bench {}",
        path(0, "RECORD.csv"),
        path(1, "BENCH.toml")
    )
}

/// Records, bench files, axes of strapdown units and the map of columns as arguments of a command, as a shell
/// reads them. A bench file of all records is named once.
#[must_use]
pub fn command_files<'a>(inputs: impl Iterator<Item = (InputRole, &'a str)> + Clone) -> String {
    let of = |role: InputRole| -> Vec<String> {
        let own = inputs.clone().filter(|(other, _)| *other == role);
        own.map(|(_, path)| shell_quoted(path)).collect()
    };
    let mut benches = of(InputRole::Bench);
    if benches.windows(2).all(|pair| pair[0] == pair[1]) {
        benches.truncate(1);
    }
    let options = [
        ("bench", benches),
        ("gyro-axes", of(InputRole::GyroAxes)),
        ("columns", of(InputRole::Columns)),
    ];
    let mut command = of(InputRole::Record).join(" ");
    for (option, paths) in options {
        for path in paths {
            command = format!("{command} --{option} {path}");
        }
    }
    command
}

/// The files of a result as those of [`command_files`]; `None` of a result that does not say what its files
/// are.
#[must_use]
pub fn input_files(inputs: &[Input]) -> Option<String> {
    let known = inputs
        .iter()
        .filter_map(|input| Some((input.role?, input.path.as_str())));
    let has_record = known.clone().any(|(role, _)| role == InputRole::Record);
    has_record.then(|| command_files(known))
}

/// The same of the first record alone.
#[must_use]
pub fn first_input_files(inputs: &[Input]) -> Option<String> {
    let mut seen: Vec<InputRole> = Vec::new();
    let first: Vec<Input> = inputs
        .iter()
        .filter(|input| {
            let role = input.role.filter(|role| !seen.contains(role));
            seen.extend(role);
            role.is_some()
        })
        .cloned()
        .collect();
    input_files(&first)
}

/// The first few of several names, and how many more there are.
#[must_use]
pub fn few(names: &[&str], shown: usize) -> String {
    let first = names[..names.len().min(shown)].join(", ");
    match names.len().saturating_sub(shown) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

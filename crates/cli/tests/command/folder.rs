//! A folder to run the command in.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use gyrocal_truth::Scenario;
use serde::de::DeserializeOwned;
use tempfile::TempDir;

use crate::contract::assert_conforms;

/// Arguments of the command: a text with spaces between them, or one by one.
pub(crate) trait CommandLine {
    fn words(&self) -> Vec<&str>;
}

impl CommandLine for str {
    fn words(&self) -> Vec<&str> {
        self.split_whitespace().collect()
    }
}

impl CommandLine for String {
    fn words(&self) -> Vec<&str> {
        self.as_str().words()
    }
}

impl CommandLine for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<const COUNT: usize> CommandLine for [&str; COUNT] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl CommandLine for Vec<&str> {
    fn words(&self) -> Vec<&str> {
        self.clone()
    }
}

impl<T: CommandLine + ?Sized> CommandLine for &T {
    fn words(&self) -> Vec<&str> {
        (**self).words()
    }
}

/// Temporary folder of one test, in which the command runs.
pub(crate) struct Folder {
    folder: TempDir,
}

impl Folder {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { folder }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn put(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Copies an example of the repository's.
    pub(crate) fn put_example(&self, name: &str) {
        self.put(name, example(name));
    }

    /// Checks that the files equal those of the examples, made from a scenario.
    pub(crate) fn assert_examples(&self, names: &[&str]) {
        for name in names {
            assert!(
                self.text(name) == example(name),
                "{name} differs: run the command in the head of the scenario again"
            );
        }
    }

    /// Takes the initial attitude out of a bench file.
    pub(crate) fn forget_attitude(&self, bench: &str) {
        let text = self.text(bench);
        let lines = text.lines();
        let rest: Vec<&str> = lines
            .filter(|line| !line.starts_with("initial_angles"))
            .collect();
        self.put(bench, rest.join("\n"));
    }

    /// Simulates a scenario: `r.csv` and `b.toml`.
    pub(crate) fn simulate(&self, scenario: &str) {
        self.put("s.toml", scenario);
        self.succeed("simulate s.toml --out r.csv --bench-out b.toml");
    }

    /// Simulates a record `NAME.csv` with its bench file `NAME.bench.toml`.
    pub(crate) fn put_record(&self, name: &str, scenario: &Scenario) {
        let made = gyrocal_truth::simulate(scenario).unwrap();
        made.record
            .write(&self.path(&format!("{name}.csv")))
            .unwrap();
        made.bench
            .write(&self.path(&format!("{name}.bench.toml")))
            .unwrap();
    }

    /// A written result.
    pub(crate) fn json<T: DeserializeOwned>(&self, name: &str) -> T {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The names of the files there, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn command(&self, arguments: impl CommandLine) -> Command {
        let mut command = Command::cargo_bin("gyrocal").unwrap();
        command
            .current_dir(self.folder.path())
            .args(arguments.words());
        command
    }

    pub(crate) fn run(&self, arguments: impl CommandLine) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command with a file in a pipe to its standard input.
    pub(crate) fn run_with_stdin(&self, arguments: impl CommandLine, name: &str) -> Output {
        let mut command = self.command(arguments);
        command.write_stdin(self.text(name)).output().unwrap()
    }

    /// Runs a command as on a terminal of 80 columns.
    pub(crate) fn run_on_a_terminal(&self, arguments: impl CommandLine) -> Output {
        let mut command = self.command(arguments);
        command.env("COLUMNS", "80").output().unwrap()
    }

    /// Runs a command that must succeed with all details; returns stdout.
    pub(crate) fn succeed(&self, arguments: impl CommandLine) -> String {
        let mut detailed = arguments.words();
        detailed.push("--verbose");
        self.succeed_as_is(&detailed)
    }

    /// Runs a command that must succeed; returns stdout. A result for programs has to conform to its schema.
    pub(crate) fn succeed_as_is(&self, arguments: impl CommandLine) -> String {
        let output = self.run(&arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{errors}");
        assert_conforms(self, &arguments.words());
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a command that must fail with exit code 1, without output on stdout, changed files or a
    /// panic; returns stderr.
    pub(crate) fn fail(&self, arguments: impl CommandLine) -> String {
        self.fail_writing(arguments, &[])
    }

    /// The same of a command that writes these files.
    pub(crate) fn fail_writing(&self, arguments: impl CommandLine, written: &[&str]) -> String {
        let mut before = self.names();
        before.extend(written.iter().map(|name| (*name).to_owned()));
        before.sort();
        before.dedup();
        let output = self.run(arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{errors}");
        assert_eq!(self.names(), before, "{errors}");
        assert!(output.stdout.is_empty());
        assert!(!errors.contains("panicked"), "{errors}");
        // One message.
        assert_eq!(errors.matches('×').count(), 1, "{errors}");
        errors
    }
}

#[track_caller]
pub(crate) fn assert_says(said: &str, words: &str) {
    assert!(said.contains(words), "{words}\nis not in\n{said}");
}

/// The example with a hidden fault.
pub(crate) const RECORD: &str = "hidden_fault.csv";
pub(crate) const BENCH: &str = "hidden_fault.bench.toml";

/// A folder with that record and its bench description.
pub(crate) fn hidden_fault() -> Folder {
    let folder = Folder::new();
    for name in [RECORD, BENCH] {
        folder.put_example(name);
    }
    folder
}

/// The repository's own files.
pub(crate) fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

/// The same as an argument of the command.
pub(crate) fn repository_argument(path: &str) -> String {
    repository(path).display().to_string()
}

/// An example that ships.
pub(crate) fn example(name: &str) -> String {
    fs::read_to_string(repository("examples/data").join(name)).unwrap()
}

//! The answer of a command: a first screen, details, files that were written, and an exit code.

use std::fmt::Write as _;
use std::path::Path;

use gyrocal_answer::Answer;
use gyrocal_document::{Part, Screen};
use gyrocal_pages::{of_result, read_sections};
use gyrocal_record::{Outputs, printable, printable_path};
use serde::Serialize;

use crate::{Failure, layout, terminal};

/// What the file of `--json` holds.
pub(crate) const RESULT: &str = "the result for programs";

/// Result of a command: what it says, and the files that it writes.
#[derive(Debug, Default)]
pub(crate) struct Reply {
    /// What a person reads first; `None` of a command whose answer is its text.
    pub(crate) screen: Option<Screen>,
    /// The details, or the whole answer without a screen.
    pub(crate) text: String,
    /// Files that are written, each with what it holds.
    pub(crate) written: Vec<(String, String)>,
    /// Their content, until [`Reply::committed`] writes it.
    pub(crate) outputs: Outputs,
    /// 0 unless `--exit-code` asks for another one.
    pub(crate) exit_code: u8,
}

impl From<String> for Reply {
    fn from(text: String) -> Self {
        Self {
            text,
            ..Self::default()
        }
    }
}

impl Reply {
    /// An answer with a first screen.
    pub(crate) fn of(screen: Screen, text: String) -> Self {
        Self {
            screen: Some(screen),
            text,
            ..Self::default()
        }
    }

    /// What a diagnosis tells.
    pub(crate) fn of_answer(answer: &Answer) -> Self {
        Self::of_part(&of_result(answer))
    }

    /// What a page shows: its first screen, and its sections as details.
    pub(crate) fn of_part(part: &Part) -> Self {
        let details = layout::layout(&read_sections(&part.sections));
        Self::of(part.first.clone(), details)
    }

    /// Stages a file, if it is asked for, and tells of it.
    pub(crate) fn write<C: AsRef<[u8]>>(
        &mut self,
        path: Option<&Path>,
        what: &str,
        content: impl FnOnce(&Path) -> Result<C, Failure>,
    ) -> Result<(), Failure> {
        if let Some(path) = path {
            self.outputs.stage(path, content(path)?.as_ref())?;
            self.wrote(path, what);
        }
        Ok(())
    }

    /// Stages the result for programs, if it is asked for, and tells of it.
    pub(crate) fn write_json(
        &mut self,
        path: Option<&Path>,
        result: &impl Serialize,
    ) -> Result<(), Failure> {
        if let Some(path) = path {
            self.outputs.stage_json(path, result)?;
            self.wrote(path, RESULT);
        }
        Ok(())
    }

    /// Has nothing for a file that is asked for: tells it, and removes what an earlier run wrote there.
    pub(crate) fn leave_out(&mut self, path: &Path, why: &str) {
        let removed = match path.is_file() {
            true => "; the earlier file is removed",
            false => "",
        };
        self.outputs.remove(path);
        self.wrote(path, &format!("not written, {why}{removed}"));
    }

    /// Writes the staged files, each of them whole.
    pub(crate) fn committed(mut self) -> Result<Self, Failure> {
        std::mem::take(&mut self.outputs).commit()?;
        Ok(self)
    }

    /// Tells of a file that is written.
    pub(crate) fn wrote(&mut self, path: &Path, what: &str) {
        self.written.push((printable_path(path), what.to_owned()));
    }

    /// The answer as text with styles: the first screen, files, and with `verbose` the details.
    pub(crate) fn shown(&self, columns: Option<usize>, verbose: bool) -> String {
        let mut out = String::new();
        if let Some(screen) = &self.screen {
            out.push_str(&terminal::laid_out(screen, columns));
        }
        let details = self.screen.is_none() || verbose;
        if details && !self.text.is_empty() {
            let space = if self.screen.is_some() { "\n" } else { "" };
            let _ = write!(out, "{space}{}", terminal::fitted(&self.text, columns));
        } else if self.screen.is_some() && !self.text.is_empty() {
            let _ = writeln!(out, "{}", terminal::note("all tables and tests: --verbose"));
        }
        if details && !self.text.is_empty() && !self.written.is_empty() {
            out.push('\n');
        }
        for (path, what) in &self.written {
            let _ = writeln!(out, "{path}: {}", printable(what));
        }
        out
    }
}

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::committed::Stale;
use super::derivation::Derivation;
use super::run::Timings;
use super::settings::{VARIABLES, WRITE_VARIABLE};

/// Result of [`Derivation::build`](super::Derivation::build).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Outcome {
    /// The committed files that could not be used; empty when all are fresh.
    pub stale: Vec<Stale>,
    /// Durations of the stages; `None` if nothing was derived, as the committed files are fresh or
    /// the same inputs had been derived into the directory before.
    pub timings: Option<Timings>,
    write_command: String,
    inputs: Vec<PathBuf>,
}

impl Outcome {
    /// With the files that could not be used, and what was derived.
    pub(super) fn new(
        derivation: &Derivation,
        stale: Vec<Stale>,
        timings: Option<Timings>,
    ) -> Self {
        // The directory stands for all its files, those to come too. A path that does
        // not exist would run the build script every time.
        let mut inputs = vec![derivation.directory.clone()];
        for path in derivation.committed_rust() {
            inputs.extend(path.ancestors().find(|path| path.exists()).map(Into::into));
        }
        inputs.dedup();
        Self {
            stale,
            timings,
            write_command: derivation.write_command().to_owned(),
            inputs,
        }
    }

    pub(super) fn watching(mut self, file: &Path) -> Self {
        self.inputs.push(file.to_owned());
        self
    }

    /// The committed files are used.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.stale.is_empty()
    }

    /// The lines for cargo that a build script prints: what to watch, and, when the model
    /// was derived anew, the configuration `cfg` and a warning for each stale file.
    #[must_use]
    pub fn cargo_instructions(&self, cfg: &str) -> String {
        let mut lines = format!("cargo::rustc-check-cfg=cfg({cfg})\n");
        if !self.is_fresh() {
            let _ = writeln!(lines, "cargo::rustc-cfg={cfg}");
        }
        lines + &self.lines()
    }

    /// The lines for cargo where the module is in `OUT_DIR` in any case, as that of a
    /// [`Variant`](super::Variant) is: what to watch, and a warning for each stale file.
    #[must_use]
    pub fn cargo_lines(&self) -> String {
        format!("cargo::rerun-if-env-changed={WRITE_VARIABLE}\n") + &self.lines()
    }

    fn lines(&self) -> String {
        let mut lines = String::new();
        for path in &self.inputs {
            let _ = writeln!(lines, "cargo::rerun-if-changed={}", path.display());
        }
        if self.is_fresh() {
            return lines;
        }
        for name in VARIABLES {
            let _ = writeln!(lines, "cargo::rerun-if-env-changed={name}");
        }
        for stale in &self.stale {
            let _ = writeln!(
                lines,
                "cargo::warning={stale}; this build uses the model derived anew, commit it with \
                 `{}`",
                self.write_command
            );
        }
        lines
    }
}

//! A progress bar for work that takes long enough to wonder.

use std::io::IsTerminal as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How long the work must take before the bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that appears after a second if stderr is a terminal, and goes when it is dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    label: &'static str,
    wanted: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(label: &'static str, total: usize) -> Self {
        Self {
            started: Instant::now(),
            total,
            label,
            wanted: std::io::stderr().is_terminal(),
            bar: None,
        }
    }

    /// Tells how much is done.
    pub(crate) fn reach(&mut self, done: usize) {
        // The clock is asked now and then only: rows take a microsecond each.
        if !self.wanted || !done.is_multiple_of(256) {
            return;
        }
        if self.bar.is_none() && self.started.elapsed() >= PATIENCE {
            self.bar = Some(self.visible());
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        }
    }

    fn visible(&self) -> ProgressBar {
        let bar = ProgressBar::new(self.total as u64).with_message(self.label);
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent}% {eta} left");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

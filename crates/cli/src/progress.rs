//! A progress bar for work that takes long enough to wonder.

use std::io::IsTerminal as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How long the work must take before the bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Rows that take a second or two.
const MANY_ROWS: usize = 20_000;

/// How often the time that has passed is renewed.
const TICK: Duration = Duration::from_millis(200);

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

    /// Of work on so many rows that does not tell how far it is: shows the time that has passed,
    /// from the start if the rows are many.
    pub(crate) fn waiting(label: &'static str, rows: usize) -> Self {
        let mut progress = Self::new(label, rows);
        if progress.wanted && rows >= MANY_ROWS {
            let style = ProgressStyle::with_template("{msg} {spinner} {elapsed}");
            let bar = ProgressBar::new_spinner()
                .with_message(format!("{label} {rows} rows"))
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            bar.enable_steady_tick(TICK);
            progress.bar = Some(bar);
        }
        progress
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

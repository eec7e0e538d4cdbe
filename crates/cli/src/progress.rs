//! Progress bar of long computations.

use std::time::{Duration, Instant};

use gyrocal_diagnosis::Stage;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use crate::terminal;

/// Delay before the bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Number of rows that take a second or two.
const MANY_ROWS: usize = 20_000;

/// Interval at which the elapsed time is updated.
const TICK: Duration = Duration::from_millis(200);

/// A bar that appears after a second if stderr is a terminal, and disappears when dropped.
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
            wanted: terminal::shows_progress(),
            bar: None,
        }
    }

    /// For work without progress reports: shows the elapsed time, from the start if there are many
    /// rows.
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

    /// Reports the number of rows done.
    pub(crate) fn reach(&mut self, done: usize) {
        // The clock is read every 256 rows only: a row takes a microsecond.
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

    /// Reports that a stage of a diagnosis begins.
    pub(crate) fn at(&mut self, stage: Stage) {
        self.stage(stage.name(), stage.share_before());
    }

    /// Reports that a stage begins when this share of the time has passed; shows the time left from then
    /// on, if the work takes more than a second.
    pub(crate) fn stage(&mut self, name: &str, share: f64) {
        let elapsed = self.started.elapsed();
        if !self.wanted || (self.bar.is_none() && elapsed < PATIENCE) {
            return;
        }
        let label = self.label;
        let bar = self.bar.get_or_insert_with(ProgressBar::new_spinner);
        let left = match share {
            share if share > 0.0 => {
                let left = elapsed.mul_f64((1.0 - share) / share);
                format!(", about {} left", HumanDuration(left))
            }
            _ => String::new(),
        };
        bar.set_message(format!("{label}: {name}{left}"));
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

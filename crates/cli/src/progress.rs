//! Progress bar of long computations.

use std::fmt::Write;
use std::time::{Duration, Instant};

use gyrocal_diagnosis::Stage;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::terminal;

/// Delay before the bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Interval at which the elapsed time is updated.
const TICK: Duration = Duration::from_millis(200);

/// A bar that appears after a second if stderr is a terminal, and disappears when dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    started: Instant,
    total: usize,
    label: &'static str,
    wanted: bool,
    /// Whether stages are reported and not rows.
    of_stages: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(label: &'static str, total: usize) -> Self {
        Self {
            started: Instant::now(),
            total,
            label,
            wanted: terminal::shows_progress(),
            of_stages: false,
            bar: None,
        }
    }

    /// For work without reports of rows: shows the elapsed time, if the work takes more than a second.
    pub(crate) fn waiting(label: &'static str, rows: usize) -> Self {
        let mut progress = Self::new(label, rows);
        progress.of_stages = true;
        if progress.wanted {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden())
                .with_message(label)
                .with_style(style("{msg} {spinner} {elapsed}"));
            let later = bar.downgrade();
            std::thread::spawn(move || {
                std::thread::sleep(PATIENCE);
                if let Some(bar) = later.upgrade().filter(|bar| !bar.is_finished()) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(TICK);
                }
            });
            progress.bar = Some(bar);
        }
        progress
    }

    /// Reports the number of rows done.
    pub(crate) fn reach(&mut self, done: usize) {
        // The clock is read every 256 rows only: a row takes a microsecond.
        if !self.wanted || self.of_stages || !done.is_multiple_of(256) {
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
        tracing::info!("{}", stage.name());
        self.stage(stage.name(), stage.share_before());
    }

    /// Reports that a stage begins when this share of the time has passed; shows the time left from then
    /// on, if the work takes more than a second.
    pub(crate) fn stage(&mut self, name: &str, share: f64) {
        let elapsed = self.started.elapsed();
        if !self.wanted || (self.bar.is_none() && elapsed < PATIENCE) {
            return;
        }
        let bar = self.bar.get_or_insert_with(ProgressBar::new_spinner);
        bar.set_message(format!("{}: {name}", self.label));
        if share > 0.0 {
            let end = Instant::now() + elapsed.mul_f64((1.0 - share) / share);
            let left = move |_: &ProgressState, out: &mut dyn Write| {
                let left = end.saturating_duration_since(Instant::now());
                let _ = match left.is_zero() {
                    true => write!(out, "nearly done"),
                    false => write!(out, "about {} left", HumanDuration(left)),
                };
            };
            bar.set_style(style("{msg} {spinner} {left}").with_key("left", left));
        }
        bar.enable_steady_tick(TICK);
    }

    fn visible(&self) -> ProgressBar {
        let bar = ProgressBar::new(self.total as u64).with_message(self.label);
        bar.with_style(style("{msg} {wide_bar} {percent}% {eta} left"))
    }
}

/// The style of a template, which is part of the program.
pub(crate) fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

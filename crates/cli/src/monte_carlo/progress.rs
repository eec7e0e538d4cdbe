//! The progress bar of a campaign.

use std::time::Duration;

use gyrocal_evaluation::Progress;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget};

use crate::progress::style;
use crate::terminal;

/// A bar with the time left, if stderr is a terminal; it goes when it is dropped.
#[derive(Debug)]
pub(crate) struct SeedProgress {
    bar: ProgressBar,
    /// Name of the part that is run, if a command has several.
    of: String,
}

impl SeedProgress {
    pub(crate) fn new() -> Self {
        Self::named("")
    }

    pub(crate) fn named(name: &str) -> Self {
        let bar = if terminal::shows_progress() {
            ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
        } else {
            ProgressBar::hidden()
        };
        let bar = bar.with_style(style("{pos} of {len} runs {wide_bar} {msg}"));
        let of = match name {
            "" => String::new(),
            name => format!("{name}, "),
        };
        Self { bar, of }
    }

    pub(crate) fn reach(&mut self, state: Progress) {
        self.bar.set_length(state.total);
        self.bar.set_position(state.done);
        self.bar
            .set_message(format!("{}{}", self.of, message(state)));
    }
}

impl Drop for SeedProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn message(state: Progress) -> String {
    let failed = match state.failed {
        0 => String::new(),
        failed => format!("{failed} failed, "),
    };
    let left = state.left.map_or_else(
        || "estimating time left".to_owned(),
        // Whole seconds, so that the bar does not flicker.
        |left| {
            format!(
                "{} left",
                HumanDuration(Duration::from_secs(left.as_secs()))
            )
        },
    );
    failed + &left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_and_failures_are_shown() {
        let state = Progress {
            done: 4,
            total: 10,
            resumed: 3,
            failed: 0,
            left: None,
        };
        assert_eq!(message(state), "estimating time left");
        let left = Some(Duration::from_millis(125_700));
        let state = Progress {
            failed: 2,
            left,
            ..state
        };
        assert_eq!(message(state), "2 failed, 2 minutes left");
    }
}

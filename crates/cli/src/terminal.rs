//! The terminal: what is shown on it, how wide, in which colours; and the one place where text reaches
//! it, without characters that would steer it.

mod screen;
mod stream;

use std::ffi::OsString;
use std::io::IsTerminal as _;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, ValueEnum};

pub(crate) use screen::{fitted, laid_out, note};
pub(crate) use stream::{Messages, print, warn};

/// Options of what is shown.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Output on the terminal")]
pub(crate) struct Shown {
    /// Print all tables and tests below the first screen; -vv also reports the work on stderr, -vvv and
    /// -vvvv in more detail.
    #[arg(short, long, action = clap::ArgAction::Count, global = true, conflicts_with = "quiet")]
    pub(crate) verbose: u8,
    /// Print nothing but errors: files and exit code tell the result.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    /// Colours: on a terminal unless NO_COLOR is set, always, or never.
    #[arg(long, value_name = "WHEN", default_value = "auto", global = true)]
    pub(crate) color: Color,
}

/// Value of `--color`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    Auto,
    Always,
    Never,
}

static QUIET: AtomicBool = AtomicBool::new(false);

impl Color {
    /// The choice of a command line that is not parsed yet, for the messages of its parser.
    pub(crate) fn of_arguments(arguments: &[OsString]) -> Self {
        let arguments: Vec<String> = arguments
            .iter()
            .map(|argument| argument.to_string_lossy().into_owned())
            .collect();
        let value = |(place, argument): (usize, &String)| match argument.strip_prefix("--color") {
            Some("") => arguments.get(place + 1).cloned(),
            Some(rest) => rest.strip_prefix('=').map(str::to_owned),
            None => None,
        };
        let given = arguments.iter().enumerate().find_map(value);
        given
            .and_then(|given| Self::from_str(&given, false).ok())
            .unwrap_or(Self::Auto)
    }

    /// Makes it the choice of all streams.
    pub(crate) fn choose(self) {
        let choice = match self {
            Self::Auto => anstream::ColorChoice::Auto,
            Self::Always => anstream::ColorChoice::Always,
            Self::Never => anstream::ColorChoice::Never,
        };
        choice.write_global();
    }

    /// The choice for clap.
    pub(crate) fn of_clap(self) -> clap::ColorChoice {
        match self {
            Self::Auto => clap::ColorChoice::Auto,
            Self::Always => clap::ColorChoice::Always,
            Self::Never => clap::ColorChoice::Never,
        }
    }
}

impl Shown {
    /// Makes these the settings of the program.
    pub(crate) fn apply(&self) {
        self.color.choose();
        QUIET.store(self.quiet, Ordering::Relaxed);
    }
}

/// Whether progress is shown: on a terminal, unless nothing but errors is wanted.
pub(crate) fn shows_progress() -> bool {
    std::io::stderr().is_terminal() && !QUIET.load(Ordering::Relaxed)
}

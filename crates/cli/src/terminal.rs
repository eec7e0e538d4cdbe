//! The terminal: what is shown on it, how wide, in which colours; and the one place where text reaches
//! it, without characters that would steer it.

mod screen;
mod stream;

use std::ffi::OsString;
use std::io::IsTerminal as _;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, ColorChoice, ValueEnum as _};

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
    pub(crate) color: ColorChoice,
}

static QUIET: AtomicBool = AtomicBool::new(false);

/// The choice of a command line that is not parsed yet, for the messages of its parser.
pub(crate) fn color_of(arguments: &[OsString]) -> ColorChoice {
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
        .and_then(|given| ColorChoice::from_str(&given, false).ok())
        .unwrap_or_default()
}

impl Shown {
    /// Makes these the settings of the program.
    pub(crate) fn apply(&self) {
        let choice = match self.color {
            ColorChoice::Auto => anstream::ColorChoice::Auto,
            ColorChoice::Always => anstream::ColorChoice::Always,
            ColorChoice::Never => anstream::ColorChoice::Never,
        };
        choice.write_global();
        QUIET.store(self.quiet, Ordering::Relaxed);
    }
}

/// Whether progress is shown: on a terminal, unless nothing but errors is wanted.
pub(crate) fn shows_progress() -> bool {
    std::io::stderr().is_terminal() && !QUIET.load(Ordering::Relaxed)
}

//! The width of stdout.

use std::io::IsTerminal as _;

use terminal_size::{Width, terminal_size_of};

/// Columns of a terminal that does not tell.
const COLUMNS: usize = 80;

/// Columns of stdout: those of the terminal or of the variable COLUMNS; `None` for a pipe, in which
/// lines are as long as they need.
pub(crate) fn columns() -> Option<usize> {
    match terminal_size_of(std::io::stdout()) {
        Some((Width(columns), _)) => Some(columns.into()),
        None if std::io::stdout().is_terminal() => Some(COLUMNS),
        None => std::env::var("COLUMNS").ok()?.parse().ok(),
    }
}

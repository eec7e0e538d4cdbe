//! Text on its way to stdout and stderr.

use std::io::{self, Write};

use anstyle::{AnsiColor, Style};
use gyrocal_record::printable;

const YELLOW: Style = AnsiColor::Yellow.on_default().bold();

/// Writes text with styles of this program to stdout.
///
/// # Errors
/// Those of the stream.
pub(crate) fn print(text: &str) -> io::Result<()> {
    let mut stdout = anstream::stdout();
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}

/// Writes a warning to stderr.
pub(crate) fn warn(text: &str) {
    let text = printable(text);
    let _ = writeln!(anstream::stderr(), "{YELLOW}warning:{YELLOW:#} {text}");
}

/// stderr for messages on the work, each of which is written at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Messages;

impl Write for Messages {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        io::stderr().write_all(printable(&text).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}

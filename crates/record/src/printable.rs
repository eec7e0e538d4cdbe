//! Text of users in messages: without characters that steer a terminal or reorder its letters.

use std::borrow::Cow;
use std::path::Path;

/// Characters of a message that quote one piece of a file.
const LONGEST_CHARS: usize = 400;

/// Whether a terminal shows no letter for a character, but obeys it or reorders others: control
/// characters, marks of direction, and characters without width.
fn steers(letter: char) -> bool {
    letter.is_control()
        || matches!(
            letter,
            '\u{ad}'
                | '\u{61c}'
                | '\u{180e}'
                | '\u{200b}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
                | '\u{e0000}'..='\u{e007f}'
        )
}

/// A text of several lines that is safe to print: control characters and marks of direction are
/// written as `\u{1b}`; line feeds and tabulators stay.
///
/// ```
/// assert_eq!(gyrocal_record::printable("a\u{1b}[2J\nb"), "a\\u{1b}[2J\nb");
/// ```
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| steers(letter) && !"\n\t".contains(letter))
}

/// A name or a value that is safe to print within a line: as [`printable`], with line feeds and
/// tabulators written as `\n` and `\t`.
#[must_use]
pub fn printable_line(text: &str) -> Cow<'_, str> {
    escaped(text, steers)
}

/// A path that is safe to print within a line. Bytes that are not UTF-8 are replaced.
#[must_use]
pub fn printable_path(path: &Path) -> String {
    printable_line(&path.to_string_lossy()).into_owned()
}

/// An argument of a command line as a shell reads it back; quoted if it has to be.
///
/// ```
/// assert_eq!(gyrocal_record::shell_quoted("my record.csv"), "'my record.csv'");
/// ```
#[must_use]
pub fn shell_quoted(argument: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./=:,+@%".contains(letter);
    if !argument.is_empty() && argument.chars().all(plain) {
        argument.to_owned()
    } else if argument.chars().any(steers) {
        let inner = argument.replace('\\', r"\\").replace('\'', r"\'");
        let inner = escaped(&inner, steers).replace("\\u{", "\\U{");
        format!("$'{}'", without_braces(&inner))
    } else {
        format!("'{}'", argument.replace('\'', r"'\''"))
    }
}

/// A piece of a message, cut in its middle if it is long.
pub(crate) fn bounded(text: String) -> String {
    // A letter has a byte at least.
    if text.len() <= LONGEST_CHARS || text.chars().count() <= LONGEST_CHARS {
        return text;
    }
    let half = LONGEST_CHARS / 2;
    let head: String = text.chars().take(half).collect();
    let mut tail: Vec<char> = text.chars().rev().take(half).collect();
    tail.reverse();
    format!("{head} … {}", tail.into_iter().collect::<String>())
}

fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        match letter {
            '\n' | '\t' | '\r' if is_escaped(letter) => escaped.extend(letter.escape_default()),
            letter if is_escaped(letter) => escaped.extend(letter.escape_unicode()),
            letter => escaped.push(letter),
        }
    }
    Cow::Owned(escaped)
}

/// Escapes `\U{1b}` in the form of a shell, `\U0000001b`.
fn without_braces(text: &str) -> String {
    let mut parts = text.split("\\U{");
    let mut shell = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (digits, rest) = part.split_once('}').unwrap_or((part, ""));
        shell.push_str(&format!("\\U{digits:0>8}{rest}"));
    }
    shell
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_escaped() {
        for code in (0..0x20).chain(0x7f..0xa0) {
            let letter = char::from(code);
            let text = printable_line(&letter.to_string()).into_owned();
            assert!(text.starts_with('\\') && text.len() > 1, "{code:x}: {text}");
        }
        for letter in [
            '\u{200e}', '\u{200f}', '\u{202e}', '\u{2066}', '\u{2069}', '\u{feff}',
        ] {
            assert_eq!(
                printable(&letter.to_string()),
                format!("\\u{{{:x}}}", u32::from(letter))
            );
        }
        assert_eq!(printable("a\tb\nc\r"), "a\tb\nc\\r");
        assert_eq!(printable_line("a\tb\nc\r"), "a\\tb\\nc\\r");
        assert!(matches!(printable("µg, 3 °C, é, 日本"), Cow::Borrowed(_)));
    }

    #[test]
    fn a_long_piece_is_cut_in_its_middle() {
        assert_eq!(bounded("é".repeat(400)), "é".repeat(400));
        let cut = bounded(format!("a{}z", "é".repeat(1000)));
        assert_eq!(cut.chars().count(), LONGEST_CHARS + 3);
        assert!(cut.starts_with('a') && cut.ends_with('z'), "{cut}");
    }

    #[test]
    fn a_shell_reads_an_argument_back() {
        for (argument, quoted) in [
            ("r.csv", "r.csv"),
            ("", "''"),
            ("my record.csv", "'my record.csv'"),
            ("it's", r"'it'\''s'"),
            ("a\u{1b}[b", "$'a\\U0000001b[b'"),
            ("a\n\\'", r"$'a\n\\\''"),
        ] {
            assert_eq!(shell_quoted(argument), quoted);
        }
    }
}

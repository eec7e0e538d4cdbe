//! Pages of the documentation: templates filled with measurements and compared with committed pages.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::Error;
use crate::values::{Values, length_of_number, parsed};

/// The template with every `{{name}}` replaced.
pub(crate) fn fill(template: &str, values: &Values) -> Result<String, Error> {
    let mut unused: Vec<&str> = values.names().collect();
    let (mut page, mut rest) = (String::new(), template);
    while let Some((before, after)) = rest.split_once("{{") {
        let place = after.split_once("}}");
        let (name, after) = place.ok_or("a place of a template that does not end")?;
        let value = values.get(name);
        page += before;
        page += value.ok_or_else(|| format!("nothing is measured for the place {{{{{name}}}}}"))?;
        unused.retain(|other| *other != name);
        rest = after;
    }
    match unused.is_empty() {
        true => Ok(page + rest),
        false => Err(format!("the template has no place for: {}", unused.join(", ")).into()),
    }
}

/// Fills the template of a page of the documentation and holds it against the committed one, or renews that.
pub(crate) fn filled(
    file: &str,
    template: &str,
    values: &Values,
    topic: &str,
    write: bool,
) -> Result<bool, Error> {
    renewed(&docs().join(file), &fill(template, values)?, topic, write)
}

/// Renews a committed file with leave to `write`. Otherwise `true` if it equals the measurement, numbers within
/// their last printed digit; if not, the first difference is printed with the command that renews the file.
pub(crate) fn renewed(
    path: &Path,
    measured: &str,
    topic: &str,
    write: bool,
) -> Result<bool, Error> {
    if write {
        gyrocal_record::write_whole(path, measured.as_bytes())?;
        return Ok(true);
    }
    let committed = std::fs::read_to_string(path)
        .map_err(|error| format!("{}: {error}; write it with --write", path.display()))?;
    let difference = difference(&committed, measured);
    if let Some((line, found)) = &difference {
        eprintln!(
            "{}, line {line}: measured is `{found}`; renew the page with `cargo figures \
             {topic} --write`",
            path.display()
        );
    }
    Ok(difference.is_none())
}

/// The folder of the documentation.
pub(crate) fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// The first line in which two texts differ by more than the last printed digit of a number:
/// its number, and the line of the second text.
fn difference(committed: &str, measured: &str) -> Option<(usize, String)> {
    let (mut ours, mut theirs) = (committed.lines(), measured.lines());
    for line in 1.. {
        match (ours.next(), theirs.next()) {
            (None, None) => return None,
            (Some(a), Some(b)) if same_line(a, b) => {}
            (_, other) => return Some((line, other.unwrap_or_default().to_owned())),
        }
    }
    None
}

fn same_line(a: &str, b: &str) -> bool {
    let (a, b) = (pieces(a), pieces(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a == b || a.is_close(b))
}

#[derive(Debug, PartialEq)]
enum Piece<'a> {
    Word(&'a str),
    /// A value, and that of one unit in its last printed digit.
    Number(f64, f64),
}

impl Piece<'_> {
    fn is_close(&self, other: &Self) -> bool {
        let (Self::Number(one, digit), Self::Number(to, as_fine)) = (self, other) else {
            return false;
        };
        // A little more than one, for sums of rounded numbers.
        digit.max(*as_fine) * 1.001 >= (one - to).abs()
    }
}

/// Words and numbers of a line. A digit after a letter belongs to the
/// word, and so does a sign.
fn pieces(line: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let (mut word, mut at) = (0, 0);
    while at < line.len() {
        let after_word = line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let rest = &line[at..];
        let length = match after_word || rest.starts_with('+') {
            true => 0,
            false => length_of_number(rest),
        };
        let Some((value, last)) = parsed(&rest[..length]) else {
            at += rest.chars().next().map_or(1, char::len_utf8);
            continue;
        };
        let digit = 10_f64.powi(last.unwrap_or(0));
        pieces.push(Piece::Word(&line[word..at]));
        pieces.push(Piece::Number(value, digit));
        at += length;
        word = at;
    }
    pieces.push(Piece::Word(&line[word..]));
    pieces
}

/// The commit of a workspace, as far as `git` tells it; `-dirty` if files differ from it but for the pages of
/// figures, which one part after the other writes.
pub(crate) fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        let output = command.arg("-C").arg(root).args(arguments).output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        output.status.success().then_some(text)
    };
    let Some(commit) = git(&["describe", "--always", "--exclude=*"]) else {
        return "unknown".to_owned();
    };
    let tracked = ["status", "--porcelain", "--untracked-files=no"];
    let but_pages = ["--", ":/", ":(top,exclude)docs/figures"];
    match git(&[tracked.as_slice(), &but_pages].concat()) {
        Some(changes) if changes.is_empty() => commit,
        _ => format!("{commit}-dirty"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_may_differ() {
        for (a, b) in [
            ("NIS 3.01 and 185.5", "NIS 3.02 and 185.6"),
            ("| -0.01 | 9.4e-5 |", "| 0.00 | 9.5e-5 |"),
            ("x1 = 9.9e-5", "x1 = 1.0e-4"),
            ("<a b=\"12\"/>", "<a b=\"13\"/>"),
        ] {
            assert_eq!(difference(a, b), None, "{a} {b}");
        }
    }

    #[test]
    fn anything_else_may_not() {
        for (a, b) in [
            ("NIS 3.01", "NIS 3.03"),
            ("NIS 3.01", "NIS of 3.01"),
            ("| 0.01 |", "| -0.01 |"),
            ("`gyro_1`, 2", "`gyro_2`, 2"),
            ("9.4e-5", "9.4e-4"),
            ("one\ntwo", "one"),
        ] {
            assert!(difference(a, b).is_some(), "{a} {b}");
        }
    }

    /// The measurement takes a while; this test only finds edits of a page in place of its template, and
    /// pages that were not renewed.
    #[test]
    fn the_committed_pages_are_their_templates_filled() {
        for (name, template) in [
            ("paper.md", crate::paper::TEMPLATE),
            ("measured-data.md", crate::measured::TEMPLATE),
            ("real-plants.md", crate::real_plants::TEMPLATE),
            ("catalogue.md", crate::catalogue::TEMPLATE),
        ] {
            let page = std::fs::read_to_string(docs().join(name)).expect("the page is committed");
            let parts = template.split("{{");
            let mut texts = parts.map(|part| part.split_once("}}").map_or(part, |(_, text)| text));
            let first = texts.next().and_then(|first| page.strip_prefix(first));
            let mut rest = first.expect("the page begins as its template does");
            let texts: Vec<&str> = texts.collect();
            for text in &texts {
                let place = rest.find(text);
                let place = place.unwrap_or_else(|| panic!("{name} lacks: {text}"));
                rest = &rest[place + text.len()..];
            }
            // What is filled in may stand last.
            let last = texts.last().is_some_and(|text| text.trim().is_empty());
            assert!(last || rest.is_empty(), "{name} ends as its template does");
        }
    }

    #[test]
    fn a_place_without_a_value_is_an_error() {
        assert!(fill("{{something}}", &Values::default()).is_err());
        assert!(fill("a place that {{does not end", &Values::default()).is_err());
    }
}

//! Layout of a first screen.

use anstyle::{AnsiColor, Style};
use gyrocal_diagnosis::prose::{Fact, Screen, Standing};
use gyrocal_record::{printable, printable_line};

use crate::layout::drawn;
use crate::text;

const BOLD: Style = Style::new().bold();
const DIM: Style = Style::new().dimmed();

/// Widest column of labels.
const LABEL: usize = 20;

/// A screen as text, its lines broken to these columns if there are any.
pub(crate) fn laid_out(screen: &Screen, columns: Option<usize>) -> String {
    let style = colour(screen.standing);
    let verdict = &screen.verdict;
    let indent = verdict.chars().count() + 2;
    let mut what = wrapped(&screen.what, indent, columns);
    if !what.is_empty() {
        let first = what.remove(0);
        what.insert(0, format!("  {BOLD}{}{BOLD:#}", &first));
    }
    let mut out = format!("{style}{verdict}{style:#}{}\n", what.join("\n"));
    let longest = |facts: &[Fact]| facts.iter().map(|fact| fact.label.chars().count()).max();
    let width = longest(&screen.facts).unwrap_or(0).clamp(4, LABEL);
    for fact in &screen.facts {
        labelled(
            &mut out,
            &printable(&fact.label),
            &fact.words,
            width,
            columns,
        );
    }
    if let Some(table) = &screen.table {
        out.push_str(&format!("{}\n", printable(&drawn(table))));
    }
    for step in &screen.next {
        // A command line is never broken: it is there to be copied.
        let command = printable(&step.command);
        out.push_str(&format!("{DIM}{:width$}{DIM:#}  {command}\n", "next"));
        let why = printable(&step.why);
        let used = width + 2 + command.chars().count();
        let room = columns.is_none_or(|columns| used + why.chars().count() + 5 <= columns);
        if room {
            out.truncate(out.len() - 1);
            out.push_str(&format!("   {DIM}# {why}{DIM:#}\n"));
        } else {
            out.push_str(&format!("{:width$}  {DIM}# {why}{DIM:#}\n", ""));
        }
    }
    out
}

/// A remark of little weight.
pub(crate) fn note(words: &str) -> String {
    format!("{DIM}{words}{DIM:#}")
}

/// A fact behind its label.
fn labelled(out: &mut String, label: &str, words: &str, width: usize, columns: Option<usize>) {
    let lines = wrapped(words, width + 2, columns);
    out.push_str(&format!(
        "{DIM}{label:width$}{DIM:#}  {}\n",
        lines.join("\n")
    ));
}

/// Lines of a text, all but the first behind an indent.
fn wrapped(words: &str, indent: usize, columns: Option<usize>) -> Vec<String> {
    let words = printable_line(words);
    let Some(columns) = columns else {
        return vec![words.into_owned()];
    };
    let broken = text::wrapped(columns.saturating_sub(indent).max(20), &words);
    let lines = broken.lines().enumerate();
    lines
        .map(|(index, line)| match index {
            0 => line.to_owned(),
            _ => format!("{:indent$}{line}", ""),
        })
        .collect()
}

fn colour(standing: Standing) -> Style {
    match standing {
        Standing::Good => AnsiColor::Green.on_default().bold(),
        Standing::Bad => AnsiColor::Red.on_default().bold(),
        Standing::Doubtful => AnsiColor::Yellow.on_default().bold(),
        Standing::Neutral => BOLD,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screen() -> Screen {
        let mut screen = Screen::new(Standing::Bad, "FAULT", "gyro_y.g_z, a long name of it");
        screen.fact(
            "how large",
            "0.0013 ± 0.0001 deg/h/g, ".repeat(5).trim_end(),
        );
        screen.fact("record", "a\u{1b}[2Jb.csv");
        screen.then("gyrocal plan r.csv --bench b.toml", "the next run");
        screen
    }

    fn plain(text: &str) -> String {
        anstream::adapter::strip_str(text).to_string()
    }

    #[test]
    fn lines_are_broken_on_a_terminal_only() {
        let narrow = plain(&laid_out(&screen(), Some(40)));
        assert!(narrow.starts_with("FAULT  gyro_y.g_z, a long name of it\n"));
        assert!(
            narrow.lines().all(|line| line.chars().count() <= 46),
            "{narrow}"
        );
        assert!(narrow.contains("\n           deg/h/g"), "{narrow}");
        let pipe = plain(&laid_out(&screen(), None));
        assert_eq!(pipe.lines().count(), 4, "{pipe}");
        assert!(pipe.contains("\nnext       gyrocal plan r.csv --bench b.toml   # the next run\n"));
    }

    #[test]
    fn nothing_of_a_file_steers_the_terminal() {
        let text = plain(&laid_out(&screen(), None));
        assert!(text.contains("a\\u{1b}[2Jb.csv"), "{text}");
        assert!(!text.contains('\u{1b}'));
    }
}

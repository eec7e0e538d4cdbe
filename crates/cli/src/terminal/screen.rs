//! Layout of a first screen.

use std::fmt::Write as _;

use anstyle::{AnsiColor, Style};
use gyrocal_document::{Fact, NextStep, Screen, Standing};
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
    let what = wrapped(&screen.what, indent, columns);
    let (first, others) = what.split_at(what.find('\n').unwrap_or(what.len()));
    let mut out = format!("{style}{verdict}{style:#}  {BOLD}{first}{BOLD:#}{others}\n");
    let longest = |facts: &[Fact]| facts.iter().map(|fact| fact.label.chars().count()).max();
    let width = longest(&screen.facts).unwrap_or(0).clamp(4, LABEL);
    for fact in &screen.facts {
        let label = printable(&fact.label);
        let words = wrapped(&fact.words, width + 2, columns);
        out.push_str(&format!("{DIM}{label:width$}{DIM:#}  {words}\n"));
    }
    if let Some(table) = &screen.table {
        out.push_str(&format!("{}\n", printable(&drawn(table))));
    }
    for step in &screen.next {
        next_step(&mut out, step, width, columns);
    }
    out
}

/// A command to run next. Where it is too long it goes on in another line, as a shell reads it.
fn next_step(out: &mut String, step: &NextStep, width: usize, columns: Option<usize>) {
    let (command, why) = (printable_line(&step.command), printable_line(&step.why));
    let indent = width + 2;
    let mut lines = vec![command.clone().into_owned()];
    if let Some(columns) = columns {
        // Two columns for ` \`.
        let room = columns.saturating_sub(indent + 2).max(20);
        let words = options_together(&command);
        lines = vec![String::new()];
        for word in words {
            let line = lines.last_mut().map_or(0, |line| line.chars().count());
            if line > 0 && line + 1 + word.chars().count() > room {
                lines.push(format!("  {word}"));
            } else if let Some(line) = lines.last_mut() {
                let space = if line.is_empty() { "" } else { " " };
                line.push_str(space);
                line.push_str(&word);
            }
        }
    }
    let end = lines.last().map_or(0, |line| line.chars().count());
    let command = lines.join(&format!(" \\\n{:indent$}", ""));
    let _ = write!(out, "{DIM}{:width$}{DIM:#}  {command}", "next");
    let fits = columns.is_none_or(|columns| indent + end + 5 + why.chars().count() <= columns);
    let gap = match fits {
        true => "   ".to_owned(),
        false => format!("\n{:indent$}", ""),
    };
    let _ = writeln!(out, "{gap}{DIM}# {why}{DIM:#}");
}

/// The words of a command line, an option with its value as one.
fn options_together(command: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in command.split(' ') {
        match words.last_mut() {
            Some(option) if option.starts_with("--") && !option.contains(' ') => {
                option.push(' ');
                option.push_str(word);
            }
            Some(program) if program == "gyrocal" => {
                program.push(' ');
                program.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Lines of a text that are wider than the terminal broken, behind their own indent. Tables fit already.
pub(crate) fn fitted(text: &str, columns: Option<usize>) -> String {
    let text = printable(text);
    let Some(columns) = columns else {
        return text.into_owned();
    };
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        if line.chars().count() <= columns {
            out.push_str(line);
        } else {
            let indent = line.len() - line.trim_start().len();
            let (blanks, words) = line.split_at(indent);
            out.push_str(blanks);
            out.push_str(&behind(indent, words, columns));
        }
        out.push('\n');
    }
    out
}

/// A remark of little weight.
pub(crate) fn note(words: &str) -> String {
    format!("{DIM}{words}{DIM:#}")
}

/// A text broken to these columns, all lines but the first behind an indent.
fn wrapped(words: &str, indent: usize, columns: Option<usize>) -> String {
    let words = printable_line(words);
    match columns {
        Some(columns) => behind(indent, &words, columns),
        None => words.into_owned(),
    }
}

/// Lines of at most these columns, of which the indent of all but the first is a part.
fn behind(indent: usize, words: &str, columns: usize) -> String {
    let broken = text::wrapped(columns.saturating_sub(indent).max(20), words);
    broken.replace('\n', &format!("\n{:indent$}", ""))
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
        assert!(narrow.contains("\n           0.0013 ±"), "{narrow}");
        let command = "gyrocal plan r.csv \\\n             --bench b.toml\n";
        assert!(narrow.contains(command), "{narrow}");
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

//! Pages of figures, `docs/figures/TOPIC.md`: a section for each part, written by the night of figures and compared
//! with by the small version.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_statistics::Proportion;
use gyrocal_testkit::{timing, workspace};

use super::topic::Part;
use crate::error::Error;
use crate::figure::Figure;

/// Confidence of the intervals of a share, here and on the page, that must overlap: a hundred rows are
/// compared at once, and none is to differ by chance.
const CONFIDENCE: f64 = 0.999;

/// First words of the header of a table of figures.
const HEADER: [&str; 3] = ["figure", "target", "measured"];

/// Path of the page of a topic.
pub(crate) fn path(topic: &str) -> PathBuf {
    let page = workspace().join("docs/figures").join(topic);
    page.with_extension("md")
}

/// The section of a part: how it was measured, and its table.
pub(crate) fn section(part: &Part, command: &str, table: &str) -> Result<String, Error> {
    let (commit, sources) = (commit(&workspace()), part.sources.hash()?);
    let processor = timing::processor();
    let about = part.about;
    Ok(format!(
        "{about}\n\nPrinted by `{command}` of commit {commit}, sources {sources}, on {processor}. Times and \
         ratios of times are those of that machine, and instruction counts those of its compiler. All else \
         differs by rounding at most: where the target fuses multiplication and addition, last bits differ.\n\n\
         {table}\n"
    ))
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

/// Renews the section of a part in the page of its topic. The other sections keep what they are: each says
/// which commit it was measured at. Sections stand in the order of `parts`.
///
/// # Errors
/// If the file cannot be read or written.
pub(crate) fn write_section(
    topic: &str,
    part: &str,
    parts: &[&str],
    body: &str,
) -> Result<(), Error> {
    let path = path(topic);
    let page = match std::fs::read_to_string(&path) {
        Ok(page) => page,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
        Err(error) => return Err(format!("{}: {error}", path.display()).into()),
    };
    let page = with_section(&page, topic, part, parts, body);
    gyrocal_record::write_whole(&path, page.as_bytes())?;
    Ok(())
}

/// A page with the section of a part replaced or added.
fn with_section(page: &str, topic: &str, part: &str, parts: &[&str], body: &str) -> String {
    let sections = page.split("\n## ").skip(1);
    let sections: Vec<(&str, &str)> = sections
        .filter_map(|section| section.split_once("\n\n"))
        .collect();
    let mut renewed = format!("# Figures: {topic}\n");
    for name in parts {
        let kept = sections.iter().find(|(heading, _)| heading == name);
        let body = match kept {
            _ if *name == part => body,
            Some((_, body)) => body.trim_end(),
            None => continue,
        };
        renewed = format!("{renewed}\n## {name}\n\n{}\n", body.trim_end());
    }
    renewed
}

/// Comparison of the figures of a small run with the committed page of the topic: each share of this run
/// must be consistent with that of the page. Rows that the page lacks are told as a note.
pub(crate) fn compared(topic: &str, figures: &[Figure]) -> Vec<Figure> {
    let name = format!("docs/figures/{topic}.md");
    let renewed_by = &format!("cargo figures night --topic {topic}");
    match std::fs::read_to_string(path(topic)) {
        Ok(text) => compared_with(&name, renewed_by, &rows(&text), figures),
        Err(_) => vec![Figure::note(
            &format!("{name}: the page"),
            format!("there is none: measure it with `{renewed_by}`"),
        )],
    }
}

fn compared_with(page: &str, renewed_by: &str, rows: &[Row], figures: &[Figure]) -> Vec<Figure> {
    let mut lacking: Vec<&str> = Vec::new();
    let mut differing = Vec::new();
    let mut agreeing = 0;
    for figure in figures {
        let Some(row) = rows.iter().find(|row| row.name == figure.name) else {
            lacking.push(&figure.name);
            continue;
        };
        let (Some(here), Some(there)) = (figure.share, row.share()) else {
            continue;
        };
        if are_consistent(here, there) {
            agreeing += 1;
        } else {
            differing.push(format!(
                "`{}` is {:.3} of {} on the page and {:.3} of {} here",
                figure.name,
                there.share(),
                there.trials,
                here.share(),
                here.trials
            ));
        }
    }
    let mut result = Vec::new();
    let compared = agreeing + differing.len();
    if compared > 0 {
        let measured = match differing.as_slice() {
            [] => format!("{agreeing} of {compared}"),
            rows => format!("{agreeing} of {compared}: {}", rows.join("; ")),
        };
        let mut figure = Figure::note(&format!("{page}: shares of this run agree"), measured);
        figure.target = format!("{compared} of {compared}");
        figure.holds = Some(differing.is_empty());
        result.push(figure.over(compared, "rows"));
    }
    if let Some(first) = lacking.first() {
        let what = match lacking.len() {
            1 => format!("page lacks this row: `{first}`"),
            count => format!("page lacks {count} rows, the first `{first}`"),
        };
        let measured = format!("{what}: measure it again with `{renewed_by}`");
        result.push(Figure::note(&format!("{page}: its rows"), measured));
    }
    result
}

/// `true` if the exact intervals of both shares overlap.
fn are_consistent(one: Proportion, other: Proportion) -> bool {
    let ([low, high], [least, most]) = (one.interval(CONFIDENCE), other.interval(CONFIDENCE));
    low <= most && least <= high
}

/// A row of a committed table.
#[derive(Debug)]
struct Row {
    name: String,
    measured: String,
    runs: u64,
}

impl Row {
    /// The share that begins its measured value; `None` if it begins with none.
    fn share(&self) -> Option<Proportion> {
        let first = self.measured.split([' ', ',']).next()?;
        let number: f64 = first.parse().ok()?;
        let unit = if self.name.contains(": % of ") {
            100.0
        } else {
            1.0
        };
        let share = number / unit;
        let is_share = (0.0..=1.0).contains(&share) && first.contains('.');
        is_share.then(|| Proportion {
            hits: (share * self.runs as f64).round() as u64,
            trials: self.runs,
        })
    }
}

/// The rows of the tables of figures of a page; other tables are passed over.
fn rows(page: &str) -> Vec<Row> {
    let cells = |line: &str| -> Vec<String> {
        let line = line.trim().trim_matches('|');
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let mut rows = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        let cells = cells(line);
        let is_header = cells.iter().zip(HEADER).all(|(cell, word)| cell == word);
        inside = (inside || (is_header && cells.len() > HEADER.len())) && line.starts_with('|');
        if let [name, _, measured, runs, ..] = cells.as_slice()
            && inside
            && let Ok(runs) = runs.parse()
        {
            rows.push(Row {
                name: name.clone(),
                measured: measured.clone(),
                runs,
            });
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::table_of;

    fn share(name: &str, hits: u64, trials: u64) -> Figure {
        Figure::note_share(name, Proportion { hits, trials }, "0..9")
    }

    fn page() -> Vec<Row> {
        let figures = [
            share("detected", 975, 1000),
            share("missed", 0, 1000),
            Figure::within("time", [0.0, 2.0], 1.0),
        ];
        rows(&format!(
            "# Figures\n\n| a | b |\n|---|---|\n| 1 | 2 |\n\n{}\n",
            table_of(&figures)
        ))
    }

    fn judged(figures: &[Figure]) -> Vec<Figure> {
        compared_with(
            "docs/figures/x.md",
            "cargo figures x --write",
            &page(),
            figures,
        )
    }

    #[test]
    fn shares_that_chance_explains_agree() {
        let time = Figure::within("time", [0.0, 2.0], 1.9);
        let result = judged(&[share("detected", 6, 8), share("missed", 1, 8), time]);
        assert_eq!(result.len(), 1, "{result:?}");
        assert_eq!(
            (result[0].measured.as_str(), result[0].holds),
            ("2 of 2", Some(true))
        );
    }

    #[test]
    fn percents_are_shares_where_the_name_says_so() {
        let of = |name: &str, measured: &str| {
            let (name, measured) = (name.to_owned(), measured.to_owned());
            Row {
                name,
                measured,
                runs: 200,
            }
            .share()
            .map(|share| share.hits)
        };
        assert_eq!(
            of(
                "gyro_x.bias: % of 95 % intervals",
                "95.500 (95 %: 91 to 98)"
            ),
            Some(191)
        );
        assert_eq!(of("detected", "0.955, bound 0.97"), Some(191));
        assert_eq!(of("mean NIS", "2.996"), None);
        assert_eq!(of("failures", "0"), None);
    }

    #[test]
    fn a_share_that_differs_is_told_with_its_row() {
        let result = judged(&[share("detected", 2, 8), share("missed", 0, 8)]);
        assert_eq!(result[0].holds, Some(false));
        assert_eq!(
            result[0].measured,
            "1 of 2: `detected` is 0.975 of 1000 on the page and 0.250 of 8 here"
        );
    }

    #[test]
    fn a_row_that_the_page_lacks_is_a_note() {
        let result = judged(&[share("detected", 8, 8), share("new", 0, 8)]);
        assert_eq!((result[0].holds, result[1].holds), (Some(true), None));
        assert_eq!(
            result[1].measured,
            "page lacks this row: `new`: measure it again with `cargo figures x --write`"
        );
        let none = compared("no-such-topic", &[]);
        assert!(none[0].holds.is_none() && none[0].measured.contains("there is none"));
    }

    #[test]
    fn a_section_is_renewed_in_its_place() {
        let parts = ["one", "two", "three"];
        let body = |word: &str| format!("{word}\n\n{}\n", table_of(&[share(word, 1, 2)]));
        let page = with_section("", "x", "three", &parts, &body("c"));
        let page = with_section(&page, "x", "one", &parts, &body("a"));
        let renewed = with_section(&page, "x", "three", &parts, &body("d"));
        assert_eq!(page.replace("c", "d"), renewed.replace("c", "d"));
        let names: Vec<String> = rows(&renewed).into_iter().map(|row| row.name).collect();
        assert_eq!(names, ["a", "d"]);
        assert_eq!(renewed.matches("\n## ").count(), 2);
    }

    /// Each committed page names its command and the commit that it was measured at, in every section, and
    /// has figures with unique names.
    #[test]
    fn committed_pages_name_their_commit_and_can_be_read() {
        let pages = std::fs::read_dir(workspace().join("docs/figures")).expect("it is committed");
        for page in pages {
            let path = page.expect("a file").path();
            if path.extension().is_none_or(|kind| kind != "md") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a page");
            let topic = path
                .file_stem()
                .and_then(|stem| stem.to_str())
                .expect("a name");
            let origins = text.split("Printed by `cargo figures ");
            let commits: Vec<usize> = origins
                .skip(1)
                .map(|origin| {
                    let commit = origin.split_once("` of commit ").map(|(_, rest)| rest);
                    let commit = commit.unwrap_or_default().chars();
                    commit.take_while(char::is_ascii_hexdigit).count()
                })
                .collect();
            let tables = text.lines().filter(|line| line.starts_with("| figure "));
            assert!(
                commits.len() == tables.count() && commits.iter().all(|digits| *digits >= 7),
                "{topic}: a table names no commit"
            );
            let mut names: Vec<String> = rows(&text).into_iter().map(|row| row.name).collect();
            assert!(!names.is_empty(), "{topic} has no figures");
            names.sort();
            let count = names.len();
            names.dedup();
            assert_eq!(names.len(), count, "{topic} has two figures of one name");
        }
    }

    /// Pages and rows of an earlier commit, the names that some have now, and why some are gone.
    #[derive(serde::Deserialize)]
    struct Moved {
        row: Vec<MovedRow>,
    }

    #[derive(serde::Deserialize)]
    struct MovedRow {
        was: String,
        now: Option<String>,
        gone: Option<String>,
    }

    #[test]
    fn no_row_of_an_earlier_commit_is_lost() {
        let root = workspace();
        let text = |file: &str| std::fs::read_to_string(root.join(file)).expect("it is committed");
        let moved: Moved = toml::from_str(&text("docs/figures/moved.toml")).expect("the list");
        let mut names: Vec<String> = Vec::new();
        for topic in &crate::topics::TOPICS {
            let page = text(&format!("docs/figures/{}.md", topic.name));
            let of_page = rows(&page).into_iter();
            names.extend(of_page.map(|row| format!("{}: {}", topic.name, row.name)));
        }
        for row in &moved.row {
            let Some(now) = &row.now else {
                assert!(
                    row.gone.as_ref().is_some_and(|why| !why.is_empty()),
                    "{}: why?",
                    row.was
                );
                continue;
            };
            assert!(
                row.gone.is_none() && names.contains(now),
                "no row is called `{now}`"
            );
        }
        for was in text("tests/data/figures/rows_57c517e1.txt").lines() {
            let is_listed = moved.row.iter().any(|row| matches(&row.was, was));
            let (_, name) = was.split_once(": ").expect("a page and a row");
            let is_there = names.iter().any(|now| now.ends_with(&format!(": {name}")));
            assert!(is_listed || is_there, "lost: {was}");
        }
    }

    /// Whether a text is a pattern, in which a `*` stands for any text.
    fn matches(pattern: &str, text: &str) -> bool {
        let mut parts = pattern.split('*');
        let Some(mut rest) = parts.next().and_then(|first| text.strip_prefix(first)) else {
            return false;
        };
        let parts: Vec<&str> = parts.collect();
        for part in &parts {
            match rest.find(part) {
                Some(place) => rest = &rest[place + part.len()..],
                None => return false,
            }
        }
        rest.is_empty() || pattern.ends_with('*')
    }
}

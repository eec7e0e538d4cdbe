//! What people read of an answer, before and after a change: numbers with units, ids, verdicts and commands of
//! screens and pages.
//!
//! `tests/data/facts` has the answers (`answers.toml`), the facts that an earlier build showed of them
//! (`shown.txt.gz`) and what may go (`moves.toml`). How a sentence is worded is no fact.

mod lines;
pub(crate) mod numbers;
#[cfg(test)]
mod tests;
mod values;

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read as _, Write as _};
use std::path::Path;

use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use gyrocal_testkit::workspace;
use rayon::prelude::*;
use serde::Deserialize;

use crate::before::moves::{Moves, empty};
use crate::before::{Case, cases, make, placeless, told};
use crate::harness::{Context, Error, Figure};
use lines::{Line, of_page, of_terminal};
use values::{is_id, numbers, words};

/// Missing facts that are printed.
const PRINTED: usize = 1000;

/// Words beside a label or an id that are facts.
const VERDICTS: [&str; 7] = [
    "detected", "excluded", "failed", "named", "passed", "reported", "white",
];

/// First screen, what `--verbose` adds, page.
const PLACES: [&str; 3] = ["screen", "verbose", "page"];

/// Answers of one kind, of records of simulators.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Kind {
    name: String,
    /// Answers, those of the small version among them.
    count: u64,
    #[serde(default)]
    small: u64,
    /// Lines of [`make`], and the command. `SEED` stands for a number from 1.
    make: Vec<String>,
    run: String,
}

/// An answer to be made.
#[derive(Debug)]
struct Answer {
    key: String,
    make: Vec<String>,
    run: String,
}

/// Place, subject, value.
type Fact = [String; 3];

/// What an answer shows: on the screen, below it, on its page.
#[derive(Debug, Default)]
struct Shown([Vec<Line>; 3]);

/// The figures of the facts; the first that are missing are printed before them. With names, only these answers are
/// made; `write` renews the facts.
///
/// # Errors
/// If an answer cannot be made, or a file of the comparison cannot be read or written.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let folder = workspace().join("tests/data/facts");
    let mut answers = answers(&folder, context.is_small())?;
    let named = &context.named;
    answers.retain(|one| named.is_empty() || named.contains(&one.key));
    let shown = answers.par_iter().map(|one| {
        let of_answer = |error| format!("{}: {error}", one.key);
        Ok((&*one.key, one.shown().map_err(of_answer)?))
    });
    let shown: Vec<(&str, Shown)> = shown.collect::<Result<_, Error>>()?;
    let whole = !context.is_small() && named.is_empty();
    if whole && context.write {
        let facts = shown.iter().map(|(key, shown)| (*key, shown.facts()));
        write(&folder, &facts.collect())?;
        empty(&folder)?;
    }
    let stored = read(&folder)?;
    let mut moves = Moves::read(&folder)?;
    let [mut all, mut gone, mut may] = [0; 3];
    for (key, shown) in &shown {
        let facts = stored.get(*key);
        let facts = facts.ok_or_else(|| format!("{key}: not stored; write all with --write"))?;
        all += facts.len();
        for fact in facts.iter().filter(|fact| !shown.has(fact)) {
            let fact = fact.join(": ");
            if moves.allow(key, &fact) {
                may += 1;
                continue;
            }
            gone += 1;
            if gone <= PRINTED {
                println!("{key}: {fact}");
            }
        }
    }
    let name = "facts of the stored answers that are found again";
    let mut figures = vec![Figure {
        target: "all".to_owned(),
        measured: format!("{} of {all}", all - gone),
        holds: Some(gone == 0 && all > 0),
        ..Figure::note(name, String::new())
            .over(shown.len(), "from 1, and records of the part before")
    }];
    figures.push(Figure::note(
        "facts that are gone as they may",
        may.to_string(),
    ));
    if whole {
        let name = "entries of moves.toml that no fact needs";
        figures.push(Figure::note(name, moves.unneeded().join("; ")));
    }
    Ok(figures)
}

/// The answers of all kinds, and those of the records of [`crate::before`].
fn answers(folder: &Path, small: bool) -> Result<Vec<Answer>, Error> {
    /// Commands that write a page.
    const WITH_PAGE: [&str; 5] = [
        "allan ",
        "calibrate ",
        "diagnose ",
        "plant diagnose ",
        "tumble ",
    ];
    let path = folder.join("answers.toml");
    let table = toml::from_str(&std::fs::read_to_string(&path)?);
    let mut table: BTreeMap<String, Vec<Kind>> =
        table.map_err(|error| format!("{}: {error}", path.display()))?;
    let mut answers = Vec::new();
    for kind in table.remove("kind").unwrap_or_default() {
        let count = if small { kind.small } else { kind.count };
        answers.extend((1..=count).map(|seed| {
            let with_seed = |line: &String| line.replace("SEED", &seed.to_string());
            Answer {
                key: format!("{} {seed}", kind.name),
                make: kind.make.iter().map(with_seed).collect(),
                run: with_seed(&kind.run),
            }
        }));
    }
    let before = if small { Vec::new() } else { cases()? };
    for Case {
        name,
        mut make,
        run,
        ..
    } in before
    {
        let has_page = |line: &String| WITH_PAGE.iter().any(|one| line.starts_with(one));
        let (with_page, others): (Vec<_>, Vec<_>) = run.into_iter().partition(has_page);
        make.extend(
            others
                .into_iter()
                .filter(|line| line.starts_with("import ")),
        );
        answers.extend(with_page.into_iter().map(|line| {
            let command = line.split(['@', '%']).next().unwrap_or_default();
            Answer {
                key: format!("before {name}, {}", command.trim_end()),
                make: make.clone(),
                run: format!("{line} --report %page.html"),
            }
        }));
    }
    Ok(answers)
}

impl Answer {
    /// Makes the record and runs the command: exit code, what it says, and its page, which may be empty.
    fn told(&self) -> Result<(i32, [String; 2], String), Error> {
        let folder = tempfile::tempdir()?;
        let folder = folder.path();
        for line in &self.make {
            make(line, folder)?;
        }
        let (code, told) = told(&format!("{} --verbose", self.run), folder)?;
        let page = std::fs::read_to_string(folder.join("page.html")).unwrap_or_default();
        let page = placeless(&page.replace("&#x2f;", "/"), folder);
        Ok((code, told, page))
    }

    fn shown(&self) -> Result<Shown, Error> {
        let (code, [out, error], page) = self.told()?;
        let [screen, mut details] = of_terminal(&out);
        details.extend(of_terminal(&error).concat());
        details.push(Line::new(&format!("exit code: {code}"), ""));
        Ok(Shown([screen, details, of_page(&page)]))
    }
}

impl Shown {
    fn facts(&self) -> BTreeSet<Fact> {
        let places = self.0.iter().zip(PLACES);
        let facts = places.flat_map(|(lines, place)| {
            let facts = lines.iter().flat_map(facts_of);
            facts.map(|[subject, value]| [place.to_owned(), subject, value])
        });
        facts.collect()
    }

    /// Whether a fact is in a line of its place; what the screen had may be anywhere on the terminal.
    fn has(&self, [place, subject, value]: &Fact) -> bool {
        let number = numbers(value).into_iter().find(|(at, _)| *at == 0);
        let is_told = |line: &&Line| {
            let has = |text: &str| has_word(&line.text, text);
            (subject.is_empty() || has(subject))
                && match &number {
                    Some((_, number)) => {
                        let found = numbers(&line.text);
                        (number.unit.is_empty() || has(&number.unit))
                            && found.iter().any(|(_, one)| number.is_told_by(one))
                    }
                    None => has(value) || line.command == *value || line.verdict == *value,
                }
        };
        let [screen, details, page] = &self.0;
        match place == "page" {
            true => page.iter().find(is_told).is_some(),
            false => screen.iter().chain(details).find(is_told).is_some(),
        }
    }
}

/// Subjects and values of a line. The subject of a number is the id before it in its sentence, else the label.
fn facts_of(line: &Line) -> Vec<[String; 2]> {
    let whole = [&line.verdict, &line.command].into_iter();
    let whole = whole.filter(|one| !one.is_empty());
    let mut facts: Vec<_> = whole.map(|one| [String::new(), one.clone()]).collect();
    for sentence in sentences(&line.text) {
        let words = words(sentence, &VERDICTS).into_iter();
        let mut found: Vec<_> = words.map(|(at, word)| (at, word.to_owned())).collect();
        found.extend(numbers(sentence).into_iter().map(|(at, one)| {
            let value = format!("{} {}", one.digits, one.unit);
            (at, value.trim_end().to_owned())
        }));
        found.sort();
        let mut subject = line.label.clone();
        for (_, value) in found {
            if is_id(&value) {
                facts.push([String::new(), value.clone()]);
                subject = value;
            } else if !(subject.is_empty() && VERDICTS.contains(&&*value)) {
                facts.push([subject.clone(), value]);
            }
        }
    }
    facts
}

/// The sentences of a text: they end before a capital letter.
fn sentences(text: &str) -> Vec<&str> {
    let mut sentences: Vec<&str> = Vec::new();
    for part in text.split('\n') {
        let mut begin = 0;
        for (at, _) in part.match_indices(". ") {
            if part[at + 2..].starts_with(char::is_uppercase) {
                sentences.push(&part[begin..=at]);
                begin = at + 2;
            }
        }
        sentences.push(&part[begin..]);
    }
    sentences
}

/// Whether a text has these words, not within others.
fn has_word(text: &str, words: &str) -> bool {
    let is_letter =
        |letter: Option<char>| letter.is_some_and(|one| one.is_alphanumeric() || one == '_');
    text.match_indices(words).any(|(at, _)| {
        let after = text[at + words.len()..].chars().next();
        !(words.starts_with(char::is_alphabetic) && is_letter(text[..at].chars().next_back())
            || words.ends_with(char::is_alphanumeric) && is_letter(after))
    })
}

/// Writes a line for each fact: answer, place, subject, value.
fn write(folder: &Path, all: &BTreeMap<&str, BTreeSet<Fact>>) -> Result<(), Error> {
    let mut file = GzEncoder::new(Vec::new(), Compression::best());
    for (key, facts) in all {
        for fact in facts {
            writeln!(file, "{key}\t{}", fact.join("\t"))?;
        }
    }
    let path = folder.join("shown.txt.gz");
    Ok(gyrocal_record::write_whole(&path, &file.finish()?)?)
}

/// The stored facts of all answers.
fn read(folder: &Path) -> Result<BTreeMap<String, Vec<Fact>>, Error> {
    let path = folder.join("shown.txt.gz");
    let file =
        std::fs::File::open(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut text = String::new();
    GzDecoder::new(file).read_to_string(&mut text)?;
    let mut all = BTreeMap::<String, Vec<Fact>>::new();
    for line in text.lines() {
        let [key, fact @ ..] = &line.split('\t').collect::<Vec<_>>()[..] else {
            continue;
        };
        let fact: Fact = fact
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .try_into()
            .map_err(|_| format!("{}: found `{line}`, expected four columns", path.display()))?;
        all.entry((*key).to_owned()).or_default().push(fact);
    }
    Ok(all)
}

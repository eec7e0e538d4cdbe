//! What documents show of the command is what it prints: each block `console` of README.md and docs is
//! run, on a terminal of 80 columns.

use std::fs;
use std::path::PathBuf;

use crate::folder::{Folder, repository};

/// Set, it renews the blocks: `GYROCAL_WRITE_DOCUMENTS=1 cargo test -p gyrocal-cli --test command
/// documents`.
const WRITE: &str = "GYROCAL_WRITE_DOCUMENTS";

const OPEN: &str = "```console\n";
const CLOSE: &str = "```\n";

/// README.md and the pages below docs, without generated ones.
fn documents() -> Vec<PathBuf> {
    let pages = fs::read_dir(repository("docs")).unwrap();
    let pages = pages.map(|entry| entry.unwrap().path());
    let mut all: Vec<PathBuf> = pages
        .filter(|path| path.extension().is_some_and(|kind| kind == "md"))
        .chain([repository("README.md")])
        .collect();
    all.sort();
    all
}

/// A folder with the examples and data of the repository, where commands may write below `target`.
fn workplace() -> Folder {
    let folder = Folder::new();
    for name in [
        "examples/data",
        "examples/duffing",
        "tests/data/dialects",
        "tests/data/measured",
    ] {
        copy(&repository(name), &folder.path(name));
    }
    fs::create_dir(folder.path("target")).unwrap();
    folder
}

fn copy(from: &std::path::Path, to: &std::path::Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

/// A block as its commands print it now.
fn printed(folder: &Folder, block: &str) -> String {
    let mut text = String::new();
    let mut command = String::new();
    for line in block.lines() {
        let continues = command.ends_with('\\');
        if !continues && !line.starts_with("$ ") {
            continue;
        }
        text.push_str(&format!("{line}\n"));
        command = command.trim_end_matches('\\').to_owned() + line;
        if line.ends_with('\\') {
            continue;
        }
        let words: Vec<&str> = command.split_whitespace().collect();
        let ["$", "gyrocal", arguments @ ..] = &words[..] else {
            panic!("{command}: expected a command line of gyrocal");
        };
        let output = folder.run_on_a_terminal(arguments);
        assert!(output.status.success(), "{command}");
        text.push_str(&String::from_utf8(output.stdout).unwrap());
        command.clear();
    }
    text
}

#[test]
fn documents_show_what_the_command_prints() {
    let folder = workplace();
    let mut blocks = 0;
    for path in documents() {
        let page = fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
        let mut pieces = page.split(OPEN);
        let mut renewed = pieces.next().unwrap_or_default().to_owned();
        for piece in pieces {
            let (block, rest) = piece.split_once(CLOSE).unwrap();
            let printed = printed(&folder, block);
            if std::env::var_os(WRITE).is_none() {
                assert_same(block, &printed, &path.display().to_string());
            }
            renewed.push_str(&format!("{OPEN}{printed}{CLOSE}{rest}"));
            blocks += 1;
        }
        if std::env::var_os(WRITE).is_some() && renewed != page {
            fs::write(&path, renewed).unwrap();
        }
    }
    assert!(blocks >= 6, "{blocks} blocks");
}

/// The same words, and numbers that differ as the rounding of another machine's arithmetic may: the
/// best attitude of a plan and what is drawn there change slightly.
#[track_caller]
fn assert_same(shown: &str, printed: &str, page: &str) {
    let (words, numbers) = with_numbers(shown);
    let (found_words, found) = with_numbers(printed);
    let hint =
        format!("{page} is stale: {WRITE}=1 cargo test -p gyrocal-cli --test command documents");
    assert_eq!(words, found_words, "{hint}");
    for (shown, found) in numbers.iter().zip(&found) {
        let tolerance = 3.0_f64.min(0.1 * shown.abs()).max(0.02);
        assert!((shown - found).abs() <= tolerance, "{hint}\n{printed}");
    }
}

/// A text without its numbers, and the numbers.
fn with_numbers(text: &str) -> (String, Vec<f64>) {
    let (mut words, mut numbers, mut number) = (String::new(), Vec::new(), String::new());
    for letter in text.chars().chain(['\n']) {
        let first = number.is_empty();
        if letter.is_ascii_digit() || (letter == '.' && !first) || (letter == '-' && first) {
            number.push(letter);
            continue;
        }
        match number.trim_end_matches('.').parse() {
            Ok(value) => {
                numbers.push(value);
                words.push('#');
            }
            Err(_) => words.push_str(&number),
        }
        number.clear();
        words.push(letter);
    }
    (
        words.split_whitespace().collect::<Vec<_>>().join(" "),
        numbers,
    )
}

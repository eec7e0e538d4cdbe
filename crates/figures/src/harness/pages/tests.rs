use gyrocal_evaluation::Statistic;

use super::*;
use crate::before::moves::matches;
use crate::figure::table_of;

fn share(name: &str, hits: u64, trials: u64) -> Figure {
    let share = Statistic::Share(Proportion { hits, trials });
    Figure::of_statistic(name, &share, None, true).over(trials as usize, "0..9")
}

fn page() -> Vec<Row> {
    let figures = [
        share("detected", 975, 1000),
        share("missed", 0, 1000),
        Figure::within("time", [0.0, 2.0], 1.0),
    ];
    let other = "| a | b |\n|---|---|\n| 1 | 2 |";
    rows(&format!("# Figures\n\n{other}\n\n{}\n", table_of(&figures)))
}

fn judged(figures: &[Figure]) -> Vec<Figure> {
    let command = "cargo figures x --write";
    compared_with("docs/figures/x.md", command, &page(), figures)
}

#[test]
fn shares_that_chance_explains_agree() {
    let time = Figure::within("time", [0.0, 2.0], 1.9);
    let result = judged(&[share("detected", 6, 8), share("missed", 1, 8), time]);
    assert_eq!(result.len(), 1, "{result:?}");
    assert_eq!(result[0].measured, "2 of 2");
    assert_eq!(result[0].holds, Some(true));
}

#[test]
fn percents_are_shares_where_the_name_says_so() {
    let of = |name: &str, measured: &str| {
        let row = Row {
            name: name.to_owned(),
            measured: measured.to_owned(),
            runs: 200,
        };
        row.share().map(|share| share.hits)
    };
    let percent = "gyro_x.bias: % of 95 % intervals";
    assert_eq!(of(percent, "95.500 (95 %: 91 to 98)"), Some(191));
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
        let topic = path.file_stem().expect("a name").display();
        let origins = text.split("Printed by `cargo figures ").skip(1);
        let commit = |origin: &str| {
            let commit = origin.split_once("` of commit ").map(|(_, rest)| rest);
            let commit = commit.unwrap_or_default().chars();
            commit.take_while(char::is_ascii_hexdigit).count()
        };
        let commits: Vec<usize> = origins.map(commit).collect();
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
    for topic in crate::topics::topics().unwrap() {
        let page = text(&format!("docs/figures/{}.md", topic.name));
        let of_page = rows(&page).into_iter();
        names.extend(of_page.map(|row| format!("{}: {}", topic.name, row.name)));
    }
    for row in &moved.row {
        let Some(now) = &row.now else {
            let gone = row.gone.as_ref().is_some_and(|why| !why.is_empty());
            assert!(gone, "{}: why?", row.was);
            continue;
        };
        let is_there = row.gone.is_none() && names.contains(now);
        assert!(is_there, "no row is called `{now}`");
    }
    for was in text("tests/data/figures/rows_57c517e1.txt").lines() {
        let is_listed = moved.row.iter().any(|row| matches(&row.was, was));
        let (_, name) = was.split_once(": ").expect("a page and a row");
        let is_there = names.iter().any(|now| now.ends_with(&format!(": {name}")));
        assert!(is_listed || is_there, "lost: {was}");
    }
}

#[test]
fn sources_of_parts_are_there() {
    let topics = crate::topics::topics().unwrap();
    let parts = topics.iter().flat_map(|topic| &topic.parts);
    let all = parts.map(|part| (&*part.name, &part.sources));
    for (name, sources) in all.chain([("judging", &crate::harness::sources::JUDGING)]) {
        let packages = sources.packages.iter();
        let manifests = packages.map(|package| workspace().join(package).join("Cargo.toml"));
        let files = sources.files.iter().map(|file| workspace().join(file));
        for path in manifests.chain(files) {
            assert!(path.exists(), "{name}: {}", path.display());
        }
    }
}

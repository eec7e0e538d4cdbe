//! `gyrocal characterise` as a user runs it. A record takes a second or more, so few are run.

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use gyrocal_evaluation::CharacteriseReport;

use crate::folder::{Folder, assert_says};

fn said(folder: &Folder, more: &str) -> String {
    let line = format!("characterise {more}");
    folder.succeed(line.split_whitespace().collect::<Vec<_>>())
}

#[test]
#[expect(clippy::too_many_lines, reason = "one slow run for all")]
fn a_killed_run_goes_on_where_it_was_and_says_the_same() {
    let line =
        "--cell cubic --runs 3 --seed 5 --method bic --results runs --json o.json --markdown o.md";
    let fresh = Folder::new();
    let expected = said(&fresh, line);
    assert_says(&expected, "silent");
    assert_says(&expected, ">= 0.75");
    let report: CharacteriseReport = fresh.json("o.json");
    assert_eq!(report.cells.len(), 1);
    let cell = &report.cells[0];
    assert_eq!((cell.cell.as_str(), cell.seeds), ("cubic", [5, 8]));
    assert_eq!(cell.characteristics[0].runs, 3);
    let methods: Vec<&str> = cell
        .comparison
        .iter()
        .map(|row| row.method.as_str())
        .collect();
    assert_eq!(methods, ["gyrocal", "bic"]);
    assert!(
        fresh.text("o.md").contains("| silent "),
        "{}",
        fresh.text("o.md")
    );

    let folder = Folder::new();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("gyrocal"))
        .current_dir(folder.path(""))
        .arg("characterise")
        .args(line.split_whitespace())
        .args(["--threads", "1"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let started = Instant::now();
    let kept = || fs::read_to_string(folder.path("runs/cubic.jsonl")).unwrap_or_default();
    while kept().lines().count() < 2 {
        assert!(
            started.elapsed() < Duration::from_secs(300),
            "it writes as it goes"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = kept();
    let whole = before.rfind('\n').unwrap() + 1;
    assert_eq!(said(&folder, line), expected);
    assert!(
        kept().starts_with(&before[..whole]),
        "what was finished is not run again"
    );
    assert_eq!(folder.text("o.json"), fresh.text("o.json"));
    assert_eq!(folder.text("o.md"), fresh.text("o.md"));

    // Results of other methods are other results.
    let errors = folder.fail("characterise --cell cubic --runs 1 --results runs");
    assert_says(
        &errors,
        "results of another campaign, of methods `bic`, expected `nis, ljung-box, bic, stls`",
    );

    // Five records that are not silent show that fewer than three quarters are.
    let text = kept();
    let mut lines = text.lines();
    let mut missed = lines.next().unwrap().to_owned();
    let case = lines.next().unwrap();
    assert_says(case, "\"verdict\":");
    let mut value: serde_json::Value = serde_json::from_str(case).unwrap();
    for seed in 5..10 {
        value["done"]["seed"] = seed.into();
        value["done"]["result"]["verdict"] = "effects-found".into();
        missed = format!("{missed}\n{value}");
    }
    folder.put("runs/cubic.jsonl", missed + "\n");
    let line = "characterise --cell cubic --runs 5 --seed 5 --method bic --results runs";
    let run = |more: &str| {
        let line = format!("{line} {more}");
        folder.run(line.split_whitespace().collect::<Vec<_>>())
    };
    let plain = run("");
    assert_eq!(plain.status.code(), Some(0));
    assert!(
        String::from_utf8(plain.stdout)
            .unwrap()
            .starts_with("MISSED  ")
    );
    assert_eq!(run("--exit-code").status.code(), Some(3));
}

#[test]
fn a_result_goes_into_the_folder_that_is_made_for_the_records() {
    let folder = Folder::new();
    let line = "characterise --cell cubic --runs 1 --method none --results runs --json runs/o.json";
    folder.succeed(line.split_whitespace().collect::<Vec<_>>());
    assert!(folder.path("runs/cubic.jsonl").exists());
    assert!(folder.text("runs/o.json").contains("\"cubic\""));
}

#[test]
fn bad_input_is_refused_before_any_work() {
    let folder = Folder::new();
    let errors = folder.fail("characterise --json nowhere/o.json");
    assert_says(&errors, "nowhere/o.json: cannot be written");
    let errors = folder.fail("characterise --results r --json r/s/o.json");
    assert_says(&errors, "r/s/o.json: cannot be written");
    folder.put("notes", "a file");
    let errors = folder.fail("characterise --results notes");
    assert_says(&errors, "notes: the results cannot be kept there");
    for (more, message) in [
        (
            "--cell d7",
            "found the cell `d7`, expected one of clean, d5",
        ),
        (
            "--method aic",
            "expected one of nis, ljung-box, bic, stls, none",
        ),
        (
            "--method none --method nis",
            "--method none excludes other methods",
        ),
        ("--runs 0", "--runs"),
        ("--json o --markdown o", "would overwrite --json o"),
        // Also where that cell is not asked for, and before the folder is there.
        (
            "--cell d5 --results runs --json runs/cubic.jsonl",
            "--json runs/cubic.jsonl would overwrite --results runs/cubic.jsonl",
        ),
    ] {
        let line = format!("characterise {more}");
        let output = folder.run(line.split_whitespace().collect::<Vec<_>>());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(message), "{errors}");
    }
}

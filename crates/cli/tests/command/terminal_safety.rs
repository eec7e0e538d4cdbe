//! Safety of the terminal: what comes from files, names and arguments never steers it, and is shown in
//! bounded pieces.

use std::process::Output;
use std::time::{Duration, Instant};

use crate::diagnose::hidden_fault;
use crate::folder::{Folder, assert_says, example, repository_argument};

/// Characters that set colours and titles, ring, end a text, and reorder letters.
const EVIL: &str = "\u{1b}]0;title\u{7}\u{1b}[31m\u{9b}2J\u{202e}\u{2066}\u{200f}\u{7f}";

/// Checks that no output steers the terminal; returns stderr.
#[track_caller]
fn assert_harmless(output: &Output) -> String {
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    let errors = String::from_utf8(output.stderr.clone()).unwrap();
    for text in [&said, &errors] {
        let steering = |letter: char| {
            (letter.is_control() && letter != '\n')
                || ('\u{200b}'..='\u{200f}').contains(&letter)
                || ('\u{2028}'..='\u{202e}').contains(&letter)
                || ('\u{2060}'..='\u{206f}').contains(&letter)
        };
        assert!(!text.contains(steering), "{:?}", text.escape_debug());
    }
    assert!(!errors.contains("panicked"), "{errors}");
    errors
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.put("r.csv", example("three_days.csv"));
    folder.put("b.toml", example("three_days.bench.toml"));
    folder
}

/// Runs `calibrate` and `diagnose` on a bad record; both escape what they quote.
#[track_caller]
fn assert_record_harmless(record: impl AsRef<[u8]>, quoted: &str) {
    let folder = folder();
    folder.put("r.csv", record);
    for command in ["calibrate", "diagnose", "plan"] {
        let output = folder.run([command, "r.csv", "--bench", "b.toml"]);
        let errors = assert_harmless(&output);
        assert_eq!(output.status.code(), Some(1), "{errors}");
        assert!(errors.contains(quoted), "{quoted}\nis not in\n{errors}");
    }
}

#[test]
fn content_of_records_is_escaped() {
    let text = example("three_days.csv");
    assert_record_harmless(text.replacen("time_s", EVIL, 1), "\\u{1b}]0;title\\u{7}");
    let field = text.replacen("60.0,", &format!("6{EVIL},"), 1);
    assert_record_harmless(field, "\\u{202e}");
    assert_record_harmless(text.replacen("60.0,", "6\0,", 1), "\\u{0}");
}

#[test]
fn content_of_descriptions_is_escaped() {
    let folder = folder();
    // TOML has no raw control characters: a key escapes them.
    let key = "\"\\u001b]0;title\\u0007\\u202e\" = 1\n";
    folder.put(
        "bad.toml",
        format!("{key}{}", example("three_days.bench.toml")),
    );
    let errors = assert_harmless(&folder.run("calibrate r.csv --bench bad.toml"));
    assert_says(&errors, "the unknown key `\\u{1b}]0;title\\u{7}\\u{202e}`");
    folder.put("raw.toml", format!("a = \"{EVIL}\"\n"));
    for arguments in [
        &["calibrate", "r.csv", "--bench", "raw.toml"][..],
        &["simulate", "raw.toml", "--out", "o.csv"],
        &["monte-carlo", "raw.toml", "--seeds", "0..1"],
        &["tumble", "r.csv", "--log-description", "raw.toml"],
        &["allan", "r.csv", "--log-description", "raw.toml"],
        &[
            "import",
            "strapdown",
            "r.csv",
            "--log-description",
            "raw.toml",
            "--out",
            "o.csv",
        ],
    ] {
        let output = folder.run(arguments);
        assert_harmless(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    }
}

#[test]
fn content_of_logs_is_escaped() {
    let folder = Folder::new();
    folder.put("log.csv", format!("time,{EVIL}\n0,1\n"));
    let arguments = ["allan", "log.csv", "--columns", "x", "--rate-hz", "1"];
    let errors = assert_harmless(&folder.run(arguments));
    assert_says(&errors, "\\u{9b}");
    // A column that exists is named in the answer.
    let rows: String = (0..200)
        .map(|row| format!("{row},{}\n", row * row % 17))
        .collect();
    folder.put("log.csv", format!("time,{EVIL}\n{rows}"));
    let arguments = [
        "allan",
        "log.csv",
        "--columns",
        EVIL,
        "--rate-hz",
        "1",
        "--json",
        "o.json",
        "-v",
    ];
    let output = folder.run(arguments);
    assert_harmless(&output);
    assert_eq!(output.status.code(), Some(0));
    // Results for programs are exact.
    let result: serde_json::Value = folder.json("o.json");
    assert_eq!(result["columns"][0]["name"], EVIL);
}

#[test]
fn names_in_results_are_escaped() {
    let folder = folder();
    folder.put("h.csv", example("hidden_fault.csv"));
    folder.put("h.toml", example("hidden_fault.bench.toml"));
    let name = "\\u001b]0;title\\u0007\\u202e";
    let diagnosis = hidden_fault();
    folder.put("forged.json", diagnosis.replace("gyro_y.g_z", name));
    folder.put("raw.json", diagnosis.replace("gyro_y.g_z", EVIL));
    folder.put("none.json", format!("{{\"{name}\": 1}}"));
    for diagnosis in ["forged.json", "raw.json", "none.json"] {
        let extend = folder.run(["extend", diagnosis, "--out", "x.model.toml"]);
        let errors = assert_harmless(&extend);
        assert_eq!(extend.status.code(), Some(1), "{errors}");
        let plan = [
            "plan",
            "h.csv",
            "--bench",
            "h.toml",
            "--diagnosis",
            diagnosis,
        ];
        assert_harmless(&folder.run(plan));
    }
}

#[cfg(unix)]
#[test]
fn file_names_and_arguments_are_escaped() {
    let folder = folder();
    let evil = format!("{EVIL}\nFAULT.csv");
    folder.put(&evil, example("three_days.csv"));
    let output = folder.run([
        "diagnose", &evil, "--bench", "b.toml", "--json", "o.json", "-v",
    ]);
    assert_harmless(&output);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("\\nFAULT.csv") && !said.contains("\nFAULT.csv"),
        "{said}"
    );
    let result: serde_json::Value = folder.json("o.json");
    assert_eq!(result["manifest"]["inputs"][0]["path"], *evil);
    let missing = format!("no{EVIL}.csv");
    for arguments in [
        &["calibrate", &*missing, "--bench", "b.toml"][..],
        &["calibrate", &*evil, "--bench", &*missing],
        &["calibrate", &*evil, "--bench", "b.toml", "--json", &*evil],
        &["calibrate", &*evil, &*evil, "--bench", "b.toml"],
        &["diagnose", "r.csv", "--bench", "b.toml", "--effects", EVIL],
        &[
            "diagnose",
            "r.csv",
            "--bench",
            "b.toml",
            "--false-alarm",
            EVIL,
        ],
        &["diagnose", "r.csv", "--bench", "b.toml", EVIL],
        &[
            "diagnose",
            "r.csv",
            "--bench",
            "b.toml",
            &format!("--{EVIL}"),
        ],
        &[EVIL],
        &["effects", EVIL],
        &["extend", "--effects", EVIL, "--out", "x.model.toml"],
        &["extend", "--effects", "gyro_y.g_z", "--out", &*evil],
        &["characterise", "--cell", EVIL],
        &["completions", EVIL],
        &["man", &format!("r.csv/{EVIL}")],
        &["simulate", "b.toml", "--out", "o.csv", "--seed", EVIL],
    ] {
        let output = folder.run(arguments);
        let errors = assert_harmless(&output);
        assert!(errors.contains("\\u{1b}"), "{arguments:?}: {errors}");
    }
}

#[cfg(unix)]
#[test]
fn reports_on_the_work_are_escaped() {
    let folder = folder();
    folder.put(EVIL, example("three_days.csv"));
    assert_harmless(&folder.run(["-vvvv", "diagnose", EVIL, "--bench", "b.toml"]));
    let scenario = repository_argument("examples/data/three_days.scenario.toml");
    let arguments = [
        "-vvvv", "simulate", &*scenario, "--out", EVIL, "--json", "t.json",
    ];
    assert_harmless(&folder.run(arguments));
}

/// A refusal within seconds, of a few hundred characters; the time has room for a build without
/// optimisation on a busy machine.
#[track_caller]
fn assert_short_and_soon(folder: &Folder, arguments: &[&str], words: &str) {
    let started = Instant::now();
    let output = folder.run(arguments);
    let took = started.elapsed();
    let errors = assert_harmless(&output);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains(words), "{words}\nis not in\n{errors}");
    assert!(errors.chars().count() < 1500, "{} characters", errors.len());
    let longest = errors.lines().map(|line| line.chars().count()).max();
    assert!(longest.unwrap() < 500, "{errors}");
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn a_long_line_is_shown_as_a_window_around_its_column() {
    let folder = folder();
    // 20 MB.
    let digits = "7".repeat(20_000_000);
    let text = example("three_days.csv").replacen("60.0,", &format!("60.0x{digits},"), 1);
    folder.put("long.csv", text);
    let calibrate = ["calibrate", "long.csv", "--bench", "b.toml"];
    assert_short_and_soon(&folder, &calibrate, "long.csv:3:1: found `60.0x777");
    folder.put("long.toml", format!("{digits} = 1\n[site]\n"));
    let calibrate = ["calibrate", "r.csv", "--bench", "long.toml"];
    assert_short_and_soon(&folder, &calibrate, "the unknown key `777");
    folder.put("name.csv", format!("time_s,{digits}\n0,1\n"));
    let calibrate = ["calibrate", "name.csv", "--bench", "b.toml"];
    assert_short_and_soon(
        &folder,
        &calibrate,
        "name.csv:1:8: found the unknown column",
    );
    let allan = ["allan", "name.csv", "--columns", "x", "--rate-hz", "1"];
    assert_short_and_soon(&folder, &allan, "expected a column `x`");
}

#[test]
fn a_header_of_ten_million_columns_is_refused_soon() {
    let folder = folder();
    folder.put(
        "wide.csv",
        format!("time_s{}\n0,1\n", ",x".repeat(10_000_000)),
    );
    let words = "found 10000001 fields, expected at most 10000 fields";
    let calibrate = ["calibrate", "wide.csv", "--bench", "b.toml"];
    assert_short_and_soon(&folder, &calibrate, words);
    let allan = ["allan", "wide.csv", "--columns", "x", "--rate-hz", "1"];
    assert_short_and_soon(&folder, &allan, words);
}

#[test]
fn a_last_line_that_is_cut_off_is_told() {
    let folder = folder();
    let text = example("three_days.csv");
    let whole = text.trim_end();
    let at = whole.rfind(',').unwrap();
    for cut in [&whole[..at], &whole[..=at], &whole[..at - 3]] {
        folder.put("cut.csv", cut);
        for command in ["calibrate", "diagnose", "plan"] {
            let errors = folder.fail([command, "cut.csv", "--bench", "b.toml"]);
            assert_says(&errors, "cut.csv:4322:1: found a last line that is cut off");
            assert_says(&errors, "copy the file again, or delete this line");
        }
    }
    // Within the last number it may be whole: that is a warning.
    folder.put("short.csv", &whole[..at + 5]);
    let output = folder.run("calibrate short.csv --bench b.toml");
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_says(&errors, "short.csv:4322: the file ends without a line feed");
    folder.put("whole.csv", whole);
    let output = folder.run("calibrate whole.csv --bench b.toml");
    assert!(output.stderr.is_empty());
    let rows: String = (0..200)
        .map(|row| format!("{row},{}\n", row * row % 17))
        .collect();
    folder.put("log.csv", format!("time,x\n{rows}200"));
    let errors = folder.fail("allan log.csv --columns x --rate-hz 1");
    assert_says(&errors, "log.csv:202:1: found a last line that is cut off");
}

#[test]
fn swapped_arguments_are_told() {
    let folder = folder();
    let scenario = repository_argument("examples/data/three_days.scenario.toml");
    for (arguments, words) in [
        (
            &["calibrate", "b.toml", "--bench", "r.csv"][..],
            "r.csv:1:1: found a table with columns, as a record (CSV) has, expected a description",
        ),
        (
            &["calibrate", "b.toml", "--bench", "b.toml"],
            "b.toml:1:1: found a description (TOML), expected a table with columns (CSV)",
        ),
        (
            &["diagnose", "r.csv", "--bench", "r.csv"],
            "found a table with columns",
        ),
        (
            &["plan", "b.toml", "--bench", "b.toml"],
            "found a description (TOML)",
        ),
        (
            &["simulate", "r.csv", "--out", "o.csv"],
            "found a table with columns",
        ),
        (
            &["tumble", "b.toml", "--log-description", "r.csv"],
            "found a table with columns",
        ),
        (
            &["allan", &*scenario, "--columns", "x", "--rate-hz", "1"],
            "found a description (TOML)",
        ),
    ] {
        let errors = folder.fail(arguments);
        assert!(errors.contains(words), "{words}\nis not in\n{errors}");
        assert_says(&errors, "the two may be swapped");
    }
}

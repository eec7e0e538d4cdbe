//! `gyrocal monte-carlo` as a user runs it.

use std::fs;
use std::process::Stdio;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use gyrocal_evaluation::MonteCarloReport;

use crate::folder::{Folder, assert_says};
use crate::simulate;

/// Three hours, which determine little but take no time.
static SCENARIO: LazyLock<String> = LazyLock::new(|| {
    simulate::SCENARIO
        .replace("seed = 1\n", "seed = 77\n")
        .replace("[0.0, 0.0, 0.0]", "[10.0, 20.0, 30.0]")
        .replace("= 3600", "= 10800")
});

fn folder() -> Folder {
    let folder = Folder::new();
    folder.put("s.toml", &*SCENARIO);
    folder
}

/// The command over these seeds, with more arguments separated by spaces.
fn said(folder: &Folder, seeds: &str, more: &str) -> String {
    let line = format!("monte-carlo s.toml --seeds {seeds} {more}");
    folder.succeed(line)
}

fn refused(folder: &Folder, more: &str) -> String {
    let line = format!("monte-carlo s.toml --seeds 0..3 {more}");
    folder.fail(line)
}

/// The numbers between a name at the beginning of a line and the end of that line.
fn numbers(said: &str, name: &str) -> Vec<f64> {
    let line = said
        .lines()
        .find_map(|line| line.trim_start().strip_prefix(name))
        .unwrap_or_else(|| panic!("no {name} in {said}"));
    line.split(|letter: char| !(letter.is_ascii_digit() || ".-e".contains(letter)))
        .filter_map(|word| word.trim_end_matches('.').parse().ok())
        .collect()
}

#[test]
fn the_record_that_ships_is_calibrated_as_well_as_its_sigmas_say() {
    let folder = Folder::new();
    let scenario = crate::folder::repository("examples/data/three_days.scenario.toml");
    // Every fifth minute: the same days in a fifth of the time.
    let text = fs::read_to_string(scenario).unwrap();
    folder.put(
        "s.toml",
        text.replace("interval_s = 60.0", "interval_s = 300.0"),
    );
    let said = said(&folder, "0..16", "--json o.json");
    assert_says(&said, "16 runs, 0 failed");
    assert_says(&said, " s.toml: seeds 0 to 15\n");
    assert!(
        said.ends_with("o.json: the result for programs\n"),
        "{said}"
    );
    let report: MonteCarloReport = folder.json("o.json");
    assert_eq!(report.schema_version, 1);
    assert_eq!(report.seeds, [0, 16]);
    assert_eq!(report.manifest.inputs[0].path, "s.toml");
    let summary = &report.summary;
    // The bands are left once in a thousand times; these seeds are fixed.
    assert!(summary.nis.unwrap().holds(), "{said}");
    assert!(summary.nees_determined.unwrap().holds(), "{said}");
    assert_eq!(summary.nees, summary.nees_determined, "all are determined");
    for coefficient in &summary.coefficients {
        assert_eq!(coefficient.determined, 16, "{}", coefficient.name);
        let ratio = coefficient.rmse_over_sigma.unwrap();
        // 16 runs leave chi-square's 99.99 % band of 0.47 to 1.60.
        assert!((0.47..1.6).contains(&ratio.value), "{coefficient:?}");
        let bias = coefficient.bias.unwrap() / coefficient.bias_standard_error.unwrap();
        // Student's t with 15 degrees of freedom: once in 10 000.
        assert!(bias.abs() < 5.2, "{coefficient:?}");
        // Below the table of the first screen.
        let (_, details) = said.split_once("All coefficients:").unwrap();
        let row = numbers(details, &format!("{} ", coefficient.name));
        assert!(row.contains(&16.0), "{said}");
        // Printed with three decimals.
        assert!(
            row.iter().any(|cell| (cell - ratio.value).abs() < 5.1e-4),
            "{said}"
        );
    }
    let nees = numbers(&said, "NEES of the determined coefficients ");
    assert_eq!(nees[1], 9.0, "{said}");
    assert!(
        (nees[0] - summary.nees.unwrap().mean).abs() < 5.1e-4,
        "{said}"
    );
}

#[test]
fn a_resumed_run_says_what_a_fresh_one_says_byte_for_byte() {
    let fresh = folder();
    let expected = said(&fresh, "0..8", "--results runs.jsonl --json o.json");
    let resumed = folder();
    said(&resumed, "0..4", "--results runs.jsonl");
    let first = resumed.text("runs.jsonl");
    assert_eq!(first.lines().count(), 5, "a header and four runs");
    let found = said(&resumed, "0..8", "--results runs.jsonl --json o.json");
    assert_eq!(found, expected);
    assert_eq!(resumed.text("o.json"), fresh.text("o.json"));
    let second = resumed.text("runs.jsonl");
    assert!(
        second.starts_with(&first),
        "what was finished is not run again"
    );
    assert_eq!(second.lines().count(), 9);
    // Nothing is left to do, and a narrower range of the same file is that range.
    assert_eq!(
        said(&resumed, "0..8", "--results runs.jsonl --json o.json"),
        expected
    );
    assert_eq!(resumed.text("runs.jsonl"), second);
    assert_eq!(
        said(&resumed, "2..5", "--results runs.jsonl"),
        said(&folder(), "2..5", "--results runs.jsonl")
    );
}

#[test]
fn a_killed_run_goes_on_where_it_was() {
    let seeds = "0..60";
    let expected = said(&folder(), seeds, "--results runs.jsonl");
    let folder = folder();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("gyrocal"))
        .current_dir(folder.path(""))
        .args(["monte-carlo", "s.toml", "--seeds", seeds])
        .args(["--results", "runs.jsonl", "--threads", "1"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let started = Instant::now();
    let lines =
        || fs::read_to_string(folder.path("runs.jsonl")).map_or(0, |text| text.lines().count());
    while lines() < 3 {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "it writes as it goes"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = folder.text("runs.jsonl");
    let whole = before.rfind('\n').unwrap() + 1;
    assert_eq!(said(&folder, seeds, "--results runs.jsonl"), expected);
    assert!(folder.text("runs.jsonl").starts_with(&before[..whole]));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let folder = folder();
    for more in ["", "--population"] {
        // A population has records of up to 14 days; each tenth minute will do.
        folder.put(
            "s.toml",
            SCENARIO.replace("interval_s = 60", "interval_s = 600"),
        );
        let one = said(&folder, "0..6", &format!("{more} --threads 1"));
        let two = said(&folder, "0..6", &format!("{more} --threads 2"));
        assert_eq!(one, two);
        assert_eq!(one, said(&folder, "0..6", more));
    }
}

#[test]
fn a_population_differs_from_run_to_run_and_is_that_of_the_seed_of_the_file() {
    let folder = folder();
    folder.put(
        "s.toml",
        SCENARIO.replace("interval_s = 60", "interval_s = 600"),
    );
    let first = said(&folder, "0..3", "--population --results a.jsonl");
    assert_says(&first, " s.toml: scenarios of its population 0 to 2\n");
    let truths: Vec<String> = folder
        .text("a.jsonl")
        .lines()
        .skip(1)
        .map(|line| {
            let line: serde_json::Value = serde_json::from_str(line).unwrap();
            line["done"]["result"]["truth"].to_string()
        })
        .collect();
    assert_eq!(truths.len(), 3);
    assert!(truths[0] != truths[1] && truths[1] != truths[2]);
    let errors = refused(&folder, "--results a.jsonl");
    assert_says(&errors, "results of another campaign");

    let other = SCENARIO.replace("interval_s = 60", "interval_s = 600");
    folder.put("s.toml", other.replace("seed = 77", "seed = 78"));
    let errors = refused(&folder, "--population --results a.jsonl");
    assert_says(&errors, "seed: 77");
    assert_ne!(said(&folder, "0..3", "--population"), first);
    // Without a population the seed of the file means nothing.
    let second = said(&folder, "0..3", "");
    folder.put("s.toml", other);
    assert_eq!(said(&folder, "0..3", ""), second);
}

#[test]
fn the_streaming_filter_is_another_campaign() {
    let folder = folder();
    let batch = said(&folder, "0..3", "--results runs.jsonl");
    assert_ne!(
        said(&folder, "0..3", "--streaming --results other.jsonl"),
        batch
    );
    let errors = refused(&folder, "--streaming --results runs.jsonl");
    assert_says(
        &errors,
        "of options `method: Batch,`, expected `method: Streaming,`",
    );
}

#[test]
fn a_torn_last_line_is_run_again() {
    let folder = folder();
    let expected = said(&folder, "0..4", "--results runs.jsonl");
    let whole = folder.text("runs.jsonl");
    folder.put("runs.jsonl", &whole[..whole.len() - 20]);
    assert_eq!(said(&folder, "0..4", "--results runs.jsonl"), expected);
    let mended = folder.text("runs.jsonl");
    assert_eq!(mended.lines().count(), 5);
    assert!(mended.ends_with('\n'));
}

#[test]
fn files_that_are_not_of_this_campaign_are_refused_and_left_alone() {
    let folder = folder();
    said(&folder, "0..2", "--results runs.jsonl");
    let kept = folder.text("runs.jsonl");
    folder.put("s.toml", SCENARIO.replace("39.1", "40.1"));
    let errors = refused(&folder, "--results runs.jsonl");
    assert_says(
        &errors,
        "runs.jsonl: found results of another campaign, of scenario `latitude_deg: 39.1,`, \
             expected `latitude_deg: 40.1,`",
    );
    assert_eq!(folder.text("runs.jsonl"), kept);

    // Another build may compute otherwise.
    folder.put("s.toml", &*SCENARIO);
    let (before, after) = kept.split_once("[\"program\",\"").unwrap();
    let (_, after) = after.split_once('"').unwrap();
    let another = format!("{before}[\"program\",\"0123456789abcdef\"{after}");
    folder.put("runs.jsonl", &another);
    let errors = refused(&folder, "--results runs.jsonl");
    assert_says(&errors, "another campaign, of program `0123456789abcdef`");
    assert_eq!(folder.text("runs.jsonl"), another);

    for foreign in ["time_s,accel_x_g\n1,2\n", "no end of line"] {
        folder.put("notes.txt", foreign);
        let errors = refused(&folder, "--results notes.txt");
        assert_says(
            &errors,
            "notes.txt: found a file that holds no results of a campaign",
        );
        assert_eq!(folder.text("notes.txt"), foreign);
    }

    folder.put("runs.jsonl", kept.replace("\"nees\":", "\"nest\":"));
    let errors = refused(&folder, "--results runs.jsonl");
    assert_says(&errors, "runs.jsonl:2: no result: ");
    assert_says(&errors, "delete the line");
}

#[test]
fn bad_input_is_refused_before_any_work() {
    let folder = folder();
    let errors = refused(&folder, "--json nowhere/o.json");
    assert_says(&errors, "nowhere/o.json: cannot be written");
    let errors = refused(&folder, "--results nowhere/r.jsonl");
    assert_says(&errors, "nowhere/r.jsonl: the results cannot be kept there");
    folder.put("s.toml", SCENARIO.replace("39.1", "93.1"));
    let errors = refused(&folder, "");
    assert_says(&errors, "s.toml:3:16: found");
    fs::remove_file(folder.path("s.toml")).unwrap();
    let errors = refused(&folder, "");
    assert_says(&errors, "s.toml: cannot be read");

    for (more, message) in [
        (
            "--seeds 3..3",
            "expected two whole numbers A..B with A less than B",
        ),
        ("--seeds 0..2000000000", "expected at most 10000000 seeds"),
        ("--seeds 0..2 --threads 0", "--threads"),
        (
            "--seeds 0..2 --results s.toml",
            "would overwrite the input s.toml",
        ),
        (
            "--seeds 0..2 --results o --json o",
            "would overwrite --results o",
        ),
        ("", "--seeds"),
    ] {
        let line = format!("monte-carlo s.toml {more}");
        let output = folder.run(line);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(message), "{errors}");
    }
}

#[test]
fn runs_that_fail_are_counted_with_their_reason_and_kept() {
    let folder = folder();
    // Fewer rows than the filter has states, in some seeds: most components are missing.
    let poor = SCENARIO.replace(
        "interval_s = 60",
        "interval_s = 600\nmissing_fraction = 0.7",
    );
    folder.put("s.toml", &poor);
    let output = said(&folder, "0..20", "--results runs.jsonl --json o.json");
    let report: MonteCarloReport = folder.json("o.json");
    let failures = &report.summary.failures;
    assert_eq!(report.summary.runs + failures.len(), 20);
    assert!((1..20).contains(&failures.len()), "{output}");
    let counts = format!("{} runs, {} failed", report.summary.runs, failures.len());
    let first = format!(
        " - seed {}: the record could not be calibrated: the record has ",
        failures[0].seed
    );
    assert!(
        output.contains(&counts) && output.contains(&first),
        "{output}"
    );
    let kept = folder.text("runs.jsonl");
    assert_eq!(
        said(&folder, "0..20", "--results runs.jsonl --json o.json"),
        output
    );
    assert_eq!(
        folder.text("runs.jsonl"),
        kept,
        "a failure is not tried again"
    );

    folder.put(
        "s.toml",
        SCENARIO.replace("duration_s = 10800", "duration_s = 300"),
    );
    let errors = refused(&folder, "");
    assert_says(
        &errors,
        "s.toml: no run gave a calibration; seed 0: the record could not be",
    );
}

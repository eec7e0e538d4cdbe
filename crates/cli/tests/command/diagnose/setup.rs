//! Gross errors of the set-up: told, mended or refused.

use gyrocal_answer::{Answer, Verdict};
use gyrocal_design::PlanResult;
use gyrocal_record::{CalibrationReport, FitVerdict};

use super::{BENCH, RECORD, folder, report};
use crate::folder::{Folder, assert_says};

const DIAGNOSE: [&str; 6] = ["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"];

/// Changes fields of the rows of the record, counted from 1.
fn spoil(folder: &Folder, change: impl Fn(usize, &mut Vec<String>)) {
    let text = folder.text(RECORD);
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default().to_owned();
    let rows = lines.enumerate().map(|(index, line)| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        change(index + 1, &mut fields);
        fields.join(",")
    });
    let text: Vec<String> = core::iter::once(header).chain(rows).collect();
    folder.put(RECORD, text.join("\n") + "\n");
}

fn negate_latitude(folder: &Folder) {
    let text = folder.text(BENCH);
    let text = text.replace("latitude_deg = ", "latitude_deg = -");
    folder.put(BENCH, text);
}

fn stopped(folder: &Folder) -> (String, Answer) {
    let said = folder.succeed(DIAGNOSE);
    let report = report(folder, "o.json");
    assert_eq!(report.verdict, Verdict::Setup);
    assert!(report.coefficients.is_none() && report.findings.is_empty());
    assert!(report.setup.iter().any(|problem| problem.stops));
    // The later exit code is asked for.
    let asked = [&DIAGNOSE[..4], &["--exit-code"]].concat();
    assert_eq!(folder.run(&asked).status.code(), Some(5));
    (said, report)
}

#[test]
fn a_wrong_latitude_stops_both_commands() {
    let folder = folder();
    negate_latitude(&folder);
    let (said, report) = stopped(&folder);
    assert!(
        said.starts_with("SET-UP WRONG  the record was not diagnosed")
            && said.contains("\nErrors of the set-up:\n - "),
        "{said}"
    );
    assert_eq!(report.setup[0].kind, "latitude");
    assert!(
        report.setup[0].evidence.contains("mean NIS"),
        "{:?}",
        report.setup
    );
    let folder = super::folder();
    negate_latitude(&folder);
    let calibrate = ["calibrate", RECORD, "--bench", BENCH, "--json", "c.json"];
    let errors = folder.fail_writing(calibrate, &["c.json"]);
    assert_says(&errors, "The set-up is wrong: hidden_fault.csv: ");
    assert_says(&errors, "help: ");
    let calibration: CalibrationReport = folder.json("c.json");
    assert_eq!(calibration.verdict, FitVerdict::Setup);
    // Both NIS in both results.
    assert_eq!(calibration.setup, report.setup);
    // A plan is refused as well, with a diagnosis of the record or without.
    let plan = ["plan", RECORD, "--bench", BENCH];
    let errors = folder.fail(plan);
    assert_says(&errors, "the set-up is wrong: hidden_fault.csv: ");
}

#[test]
fn outputs_of_earlier_runs_do_not_outlive_a_wrong_setup() {
    let folder = folder();
    negate_latitude(&folder);
    for name in ["f.csv", "c.csv", "d.csv"] {
        folder.put(name, "effect,yesterday\n");
    }
    let tables = ["--findings", "f.csv", "--coefficients", "c.csv"];
    let pictures = ["--figures", "pictures"];
    let said = folder.succeed([&DIAGNOSE[..], &tables, &pictures].concat());
    assert_says(
        &said,
        "f.csv: not written, as the set-up is wrong; the earlier file is removed",
    );
    assert_says(&said, "pictures: no pictures, as the set-up is wrong");
    // Of the folder only what is there is told: nothing, another file, a picture.
    let older = "; pictures that are there are older";
    for (name, holds) in [("", false), ("notes.txt", false), ("gain.svg", true)] {
        if !name.is_empty() {
            folder.put(&format!("pictures/{name}"), "");
        }
        let said = folder.succeed([&DIAGNOSE[..], &pictures].concat());
        assert_eq!(said.contains(older), holds, "{name}: {said}");
    }
    let calibrate = ["calibrate", RECORD, "--bench", BENCH];
    let errors = folder.run([&calibrate[..], &["--coefficients", "d.csv"]].concat());
    assert_says(&String::from_utf8(errors.stderr).unwrap(), "; d.csv: not");
    for name in ["f.csv", "c.csv", "d.csv"] {
        assert!(!folder.path(name).exists(), "{name}");
    }
}

#[test]
fn a_plan_needs_a_sound_setup_whatever_diagnosis_is_given() {
    let folder = folder();
    negate_latitude(&folder);
    folder.succeed(DIAGNOSE);
    let plan = ["plan", RECORD, "--bench", BENCH, "--diagnosis", "o.json"];
    let errors = folder.fail(plan);
    assert_says(&errors, "the set-up is wrong");
}

#[test]
fn a_plan_tells_what_was_mended_and_uses_the_rest() {
    let folder = folder();
    spoil(&folder, |row, fields| {
        if row % 50 == 7 {
            fields[3] = "-999".to_owned();
        }
    });
    folder.succeed(DIAGNOSE);
    for diagnosis in [&["--diagnosis", "o.json"][..], &[]] {
        let plan = [
            "plan", RECORD, "--bench", BENCH, "--hours", "24", "--json", "p.json",
        ];
        let said = folder.succeed([&plan[..], diagnosis].concat());
        assert_says(&said, "Errors of the set-up:");
        let plan: PlanResult = folder.json("p.json");
        assert_eq!(plan.setup, report(&folder, "o.json").setup);
        assert_eq!(plan.now.sizes[0].name, "gyro_y.g_z size");
    }
}

#[test]
fn missing_values_that_are_written_as_numbers_are_left_out_and_told() {
    for code in ["0", "-999"] {
        let folder = folder();
        spoil(&folder, |row, fields| {
            if row % 50 == 7 {
                fields[3] = code.to_owned();
            }
        });
        folder.succeed(DIAGNOSE);
        let report = report(&folder, "o.json");
        assert_eq!(report.verdict, Verdict::EffectsFound);
        assert_eq!(report.setup.len(), 1);
        assert_eq!(report.setup[0].kind, "missing-coded");
        assert_eq!(report.setup[0].rows, Some([7, 4307]));
        assert_eq!(report.setup[0].lines, Some([8, 4308]));
        assert_eq!(report.setup[0].file.as_deref(), Some(RECORD));
        assert!(!report.setup[0].stops);
        // The fault is still found.
        assert_eq!(report.findings[0].effect, "gyro_y.g_z");
        let said = folder.succeed(["calibrate", RECORD, "--bench", BENCH, "--json", "c.json"]);
        assert_says(
            &said,
            "Error of the set-up: hidden_fault.csv:8-4308: Missing values of",
        );
        assert!(folder.text("c.json").contains("missing-coded"));
    }
}

#[test]
fn two_errors_at_once_are_both_told_with_their_rows() {
    let folder = folder();
    negate_latitude(&folder);
    spoil(&folder, |row, fields| {
        if (2000..2100).contains(&row) {
            fields[1] = "0.25".to_owned();
        }
    });
    let (said, report) = stopped(&folder);
    let kinds: Vec<&str> = report.setup.iter().map(|p| p.kind.as_str()).collect();
    assert_eq!(kinds, ["stuck", "latitude"], "{said}");
    assert_eq!(report.setup[0].rows, Some([2000, 2099]));
}

#[test]
fn a_record_too_short_for_the_check_is_told_as_too_short() {
    let folder = folder();
    let text = folder.text(RECORD);
    let lines: Vec<&str> = text.lines().take(12).collect();
    folder.put(RECORD, lines.join("\n") + "\n");
    let errors = folder.fail(DIAGNOSE);
    assert_says(&errors, "expected at least 12 rows");
}

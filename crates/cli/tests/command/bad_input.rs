//! `gyrocal calibrate` on bad input: exit code 1, one message that says where, what was found
//! and what was expected, no output, no panic.

mod fits;
mod several;

use std::fs;

use gyrocal_answer::{Answer, Verdict};
use gyrocal_record::{CalibrationReport, FitVerdict, SetupProblem};

use crate::folder::{Folder, assert_says, example};

const JSON: &str = "calibrate r.csv --bench b.toml --json o.json";

/// Header and the first rows of the record that ships, one a minute.
fn record(rows: usize) -> String {
    let whole = example("three_days.csv");
    let lines: Vec<&str> = whole.lines().take(rows + 1).collect();
    lines.join("\n") + "\n"
}

fn bench() -> String {
    example("three_days.bench.toml")
}

/// The message for these two files.
fn refused(record: impl AsRef<[u8]>, bench: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.put("r.csv", record);
    folder.put("b.toml", bench);
    folder.fail(JSON)
}

/// The record with one line, counted from 1, replaced.
fn with_line(rows: usize, line: usize, replacement: &str) -> String {
    let whole = record(rows);
    let mut lines: Vec<&str> = whole.lines().collect();
    lines[line - 1] = replacement;
    lines.join("\n") + "\n"
}

#[test]
fn what_the_cases_start_from_is_good() {
    let folder = Folder::new();
    folder.put("r.csv", record(12));
    folder.put("b.toml", bench());
    folder.succeed(JSON);
    assert_eq!(folder.names(), ["b.toml", "o.json", "r.csv"]);
}

#[test]
fn bad_records_are_shown_where_they_are_wrong() {
    let cases = [
        (
            with_line(20, 1, "time_s,accel_x,accel_y_g,accel_z_g"),
            "r.csv:1:8: found the unknown column `accel_x`, expected `accel_x_g` or \
             `temperature_c`",
        ),
        (
            with_line(20, 1, "time_s,accel_x_g,accel_y_g"),
            "r.csv:1:1: found the header `time_s,accel_x_g,accel_y_g`, expected a column \
             `accel_z_g` too",
        ),
        (
            with_line(20, 7, "300.0,0.46,-0.114,0.89O"),
            "r.csv:7:19: found `0.89O`, expected a finite number or `nan`",
        ),
        (
            with_line(20, 7, "300.0,0.46,-0.114"),
            "r.csv:7:1: found 3 fields, expected 4 fields, as the header has",
        ),
        // The last line of the whole record lies beyond every buffer of a reader.
        (
            with_line(4321, 4322, "259200.0,inf,0.0,0.9"),
            "r.csv:4322:10: found `inf`, expected a finite number or `nan`",
        ),
        (
            record(11),
            "r.csv:12:1: found 11 rows after the header, expected at least 12 rows",
        ),
        (
            record(0),
            "r.csv:1:1: found 0 rows after the header, expected at least 12 rows",
        ),
        (
            with_line(20, 7, "300.0,0.0,0.0,9.81"),
            "r.csv:7:1: found a norm of specific force of 9.810 g (row 6 after the header), \
             expected a norm near 1 g, from 0.5 to 1.5",
        ),
        (
            String::new(),
            "r.csv:1:1: found an empty file, expected some content",
        ),
    ];
    for (text, message) in cases {
        // Shown as far as the message needs it, marked unless there is nothing to mark.
        let errors = refused(&text, bench());
        assert_says(&errors, message);
        assert_eq!(errors.contains("here"), !text.is_empty(), "{errors}");
        let windows = refused(text.replace('\n', "\r\n"), bench());
        assert_says(&windows, message);
    }
}

/// What is told of a set-up that is wrong, and its one problem in the result.
fn wrong_setup(record: impl AsRef<[u8]>, bench: impl AsRef<[u8]>) -> (String, SetupProblem) {
    let folder = Folder::new();
    folder.put("r.csv", record);
    folder.put("b.toml", bench);
    let errors = folder.fail_writing(JSON, &["o.json"]);
    let mut report: CalibrationReport = folder.json("o.json");
    assert_eq!(report.verdict, FitVerdict::Setup);
    assert!(report.coefficients.is_empty() && report.nis_mean.is_none());
    assert_eq!(report.setup.len(), 1, "{:?}", report.setup);
    let problem = report.setup.remove(0);
    assert_says(&errors, &problem.text());
    assert_says(&errors, "o.json: the result for programs");
    assert!(problem.stops);
    // The diagnosis says the same.
    folder.succeed("diagnose r.csv --bench b.toml --json d.json");
    let diagnosis: Answer = folder.json("d.json");
    assert_eq!(diagnosis.verdict, Verdict::Setup);
    assert_eq!(diagnosis.setup, std::slice::from_ref(&problem));
    (errors, problem)
}

#[test]
fn times_that_do_not_rise_are_told_with_their_lines() {
    for (line, evidence, advice) in [
        (
            "180.0,0.46,-0.114,0.89",
            "the first at 180 s after 240 s",
            "Sort the rows",
        ),
        (
            "240.0,0.46,-0.114,0.89",
            "the first at 240 s",
            "Keep one row of each time",
        ),
    ] {
        let (errors, problem) = wrong_setup(with_line(20, 7, line), bench());
        let words = format!("r.csv:7: Time does not rise at row 6. {advice}");
        assert_says(&errors, &words);
        assert_eq!(problem.kind, "clock");
        assert!(problem.evidence.contains(evidence), "{problem:?}");
        assert_eq!((problem.rows, problem.lines), (Some([6, 6]), Some([7, 7])));
    }
}

#[test]
fn empty_columns_and_hanging_loggers_are_told() {
    let change = |column: usize, value: Option<&str>| {
        let mut first: Option<String> = None;
        let text = record(300);
        let lines = text.lines().enumerate().map(|(index, line)| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            if index > 0 {
                match value {
                    Some(value) => fields[column] = value.to_owned(),
                    None => {
                        let values = first.get_or_insert_with(|| fields[1..].join(",")).clone();
                        return format!("{},{values}\n", fields[0]);
                    }
                }
            }
            fields.join(",") + "\n"
        });
        lines.collect::<String>()
    };
    let free: String = bench()
        .lines()
        .filter(|line| !line.contains("initial"))
        .map(|line| format!("{line}\n"))
        .collect();
    for empty in ["", "nan"] {
        let (_, problem) = wrong_setup(change(2, Some(empty)), &free);
        assert_eq!((&*problem.kind, problem.lines), ("missing", None));
        assert!(problem.description.starts_with("Accelerometer y has no"));
    }
    let (_, problem) = wrong_setup(change(0, None), bench());
    assert_eq!(problem.kind, "stuck");
    assert!(problem.description.contains("hardly ever change"));
}

#[test]
fn an_axis_in_another_unit_is_corrected_told_and_used() {
    let folder = Folder::new();
    let text = example("three_days.csv");
    let lines = text.lines().enumerate().map(|(index, line)| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        if index > 0 {
            let value: f64 = fields[2].parse().unwrap();
            fields[2] = format!("{}", 9.806_65 * value);
        }
        fields.join(",") + "\n"
    });
    folder.put("r.csv", lines.collect::<String>());
    folder.put("b.toml", bench());
    let said = folder.succeed(JSON);
    assert_says(&said.replace('\n', " "), "Its unit seems to be m/s^2.");
    let report: CalibrationReport = folder.json("o.json");
    assert_eq!(report.setup.len(), 1);
    assert_eq!(
        (&*report.setup[0].kind, report.setup[0].stops),
        ("scale", false)
    );
    folder.succeed("diagnose r.csv --bench b.toml --json d.json");
    let diagnosis: Answer = folder.json("d.json");
    assert_eq!(diagnosis.setup, report.setup);
    assert!(diagnosis.coefficients.is_some());
}

#[test]
fn a_record_in_another_unit_is_suspected_of_it() {
    let rows = (0..20).map(|row| format!("{},0.0,0.0,9.81\n", 60 * row));
    let text = format!(
        "time_s,accel_x_g,accel_y_g,accel_z_g\n{}",
        rows.collect::<String>()
    );
    let (errors, problem) = wrong_setup(text, bench());
    assert_eq!((&*problem.kind, problem.lines), ("unit", None));
    assert_says(&errors, "r.csv: Specific force is not in units of gravity.");
    assert_says(&errors, "It seems to be in m/s^2");
    assert_says(&errors, "median magnitude is 9.810 times that at rest");
}

#[test]
fn a_temperature_in_kelvins_is_told_with_its_lines_and_converted() {
    let folder = Folder::new();
    let whole = record(300);
    let with = |shift: f64| {
        let lines = whole.lines().enumerate().map(|(line, text)| match line {
            0 => format!("{text},temperature_c\n"),
            _ => format!("{text},{}\n", 20.0 + (line / 64) as f64 / 4.0 + shift),
        });
        lines.collect::<String>()
    };
    folder.put("r.csv", with(273.15));
    folder.put("b.toml", bench());
    let said = folder.succeed(JSON).replace('\n', " ");
    assert_says(&said, "It seems to be in K");
    assert_says(&said, "r.csv:2-301");
    let report: CalibrationReport = folder.json("o.json");
    let [problem] = &report.setup[..] else {
        panic!("{:?}", report.setup)
    };
    assert_eq!((&*problem.kind, problem.stops), ("temperature", false));
    assert_eq!(problem.lines, Some([2, 301]));
    folder.succeed("diagnose r.csv --bench b.toml --json d.json");
    let told: Answer = folder.json("d.json");
    assert_eq!(told.setup, report.setup);
    folder.put("r.csv", with(0.0));
    folder.succeed(JSON);
    let report: CalibrationReport = folder.json("o.json");
    assert_eq!(report.setup, []);
}

#[test]
fn files_that_are_not_text_are_refused() {
    let mut bytes = record(20).into_bytes();
    bytes.extend(b"1200.0,0.4\xff,0.1,0.9\n");
    assert_says(
        &refused(bytes, bench()),
        "r.csv:22:11: found byte 0xFF, expected UTF-8 text",
    );
    assert_says(
        &refused(record(20), b"# caf\xe9\n"),
        "b.toml:1:6: found byte 0xE9, expected UTF-8 text",
    );
}

#[test]
fn bad_bench_files_are_shown_where_they_are_wrong() {
    let cases = [
        (
            "= 48.2",
            "= 90.001",
            "b.toml:2:16: found `90.001`, expected a number from -90 to 90",
        ),
        (
            "= 48.2",
            "= -90.001",
            "b.toml:2:16: found `-90.001`, expected a number from -90 to 90",
        ),
        (
            "= 1e-5",
            "= 0.0",
            "b.toml:11:11: found `0.0`, expected a finite number greater than 0",
        ),
        (
            "= 1e-5",
            "= -1e-5",
            "b.toml:11:11: found `-1e-5`, expected a finite number greater than 0",
        ),
        (
            "= 0.002",
            "= 0",
            "b.toml:13:18: found `0`, expected a finite number greater than 0",
        ),
        (
            "= 0.002",
            "= -0.002",
            "b.toml:13:18: found `-0.002`, expected a finite number greater than 0",
        ),
        (
            "latitude_deg",
            "lattitude_deg",
            "b.toml:2:1: found the unknown key `lattitude_deg` in `[site]`, expected \
             `latitude_deg`",
        ),
        (
            "[noise]",
            "[noises]",
            "b.toml:9:2: found the unknown key `noises`, expected `site`, `platform`, `noise`, \
             `prior`, `gimbal_limits_deg` or `identification`",
        ),
        (
            "= 0.002",
            "= small",
            "b.toml:13:18: found `small`, expected valid TOML",
        ),
    ];
    for (right, wrong, message) in cases {
        let good = bench();
        assert_eq!(good.matches(right).count(), 1, "{right}");
        let errors = refused(record(20), good.replace(right, wrong));
        assert_says(&errors, message);
        assert_says(&errors, "here");
    }
    let errors = refused(record(20), "");
    assert_says(
        &errors,
        "b.toml:1:1: found an empty file, expected some content",
    );
}

#[test]
fn files_that_are_not_there_are_named() {
    let folder = Folder::new();
    assert_says(&folder.fail(JSON), "b.toml: cannot be read: ");
    folder.put("b.toml", bench());
    assert_says(&folder.fail(JSON), "r.csv: cannot be read: ");
}

#[test]
fn an_output_that_cannot_be_written_is_named() {
    let folder = Folder::new();
    folder.put("r.csv", record(20));
    folder.put("b.toml", bench());
    fs::create_dir(folder.path("taken")).unwrap();
    for path in ["no/such/folder/o.json", "taken"] {
        let errors = folder.fail(["calibrate", "r.csv", "--bench", "b.toml", "--json", path]);
        assert_says(&errors, &format!("{path}: cannot be written: "));
    }
}

#[test]
fn a_refused_input_leaves_an_older_output_as_it_was() {
    let folder = Folder::new();
    folder.put("r.csv", record(5));
    folder.put("b.toml", bench());
    folder.put("o.json", "old");
    folder.fail(JSON);
    assert_eq!(folder.text("o.json"), "old");
}

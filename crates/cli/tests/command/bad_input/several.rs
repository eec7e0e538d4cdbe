//! Records and bench files that do not go together, or not with an option.

use gyrocal_truth::{Coefficients, InitialAttitude, Scenario};

use super::{JSON, bench, record};
use crate::folder::{Folder, assert_says};

#[test]
fn rows_that_two_records_share_are_refused() {
    let folder = Folder::new();
    folder.put("a.csv", record(100));
    let later: Vec<String> = record(140)
        .lines()
        .enumerate()
        .filter(|(line, _)| *line == 0 || *line > 60)
        .map(|(_, text)| text.to_owned())
        .collect();
    folder.put("b.csv", later.join("\n"));
    folder.put("b.toml", bench());
    let errors = folder.fail("calibrate a.csv b.csv --bench b.toml");
    assert_says(
        &errors,
        "b.csv: found 40 consecutive rows that a.csv has too, from row 1 of the data \
         (t = 3600 s) on, expected rows of its own: they would count twice",
    );
    // A copy by another name is the same record.
    folder.put("b.csv", record(100));
    let errors = folder.fail("calibrate a.csv b.csv --bench b.toml");
    assert_says(
        &errors,
        "b.csv: found 100 consecutive rows that a.csv has too",
    );
}

#[test]
fn the_record_that_fails_is_named_alone_with_advice_of_its_own() {
    let folder = Folder::new();
    folder.put("a.csv", record(100));
    // Of the later rows the first twenty minutes have no x, so the platform cannot be levelled.
    let rows = record(200);
    let mut later = vec![rows.lines().next().unwrap().to_owned()];
    for (row, line) in rows.lines().skip(101).enumerate() {
        let mut fields: Vec<&str> = line.split(',').collect();
        if row <= 20 {
            fields[1] = "nan";
        }
        later.push(fields.join(","));
    }
    folder.put("b.csv", later.join("\n"));
    folder.put("b.toml", bench());
    folder.forget_attitude("b.toml");
    let errors = folder.fail("calibrate a.csv b.csv --bench b.toml");
    assert_says(&errors, "× b.csv: no calibration");
    assert_says(&errors, "record 2 of 2 cannot be calibrated");
    assert_says(&errors, "the platform cannot be levelled");
    assert_says(&errors, "help: give initial_angles_deg");
}

#[test]
fn bench_files_that_contradict_each_other_are_refused() {
    let folder = Folder::new();
    let sigma = |sigma: &str| {
        let declared = format!("= 48.2\nlatitude_sigma_deg = {sigma}");
        bench().replace("= 48.2", &declared)
    };
    let prior = "\n[prior]\nbias_sigma_deg_per_h = 2.0\n";
    let cases = [
        (
            bench(),
            bench() + prior,
            "found a [prior] other than in b.toml",
        ),
        (
            sigma("0.001"),
            sigma("0.002"),
            "found uncertainties of the same site other than in b.toml",
        ),
    ];
    for (one, other, message) in cases {
        folder.put("b.toml", one);
        folder.put("c.toml", other);
        let arguments = "calibrate x.csv y.csv --bench b.toml --bench c.toml";
        let errors = folder.fail(arguments);
        assert_says(&errors, &format!("c.toml: {message}, expected the same"));
    }
    folder.put("b.toml", sigma("0"));
    assert_says(
        &folder.fail(JSON),
        "b.toml:3:22: found `0`, expected a finite number greater than 0",
    );
}

#[test]
fn a_record_that_is_too_slow_to_average_is_told_so() {
    let folder = Folder::new();
    folder.put("r.csv", record(20));
    folder.put("b.toml", bench());
    for seconds in ["60", "601"] {
        let errors = folder.fail(format!("{JSON} --average {seconds}"));
        assert_says(
            &errors,
            &format!("r.csv: means over {seconds} s were asked for, expected from 120 s"),
        );
    }
    // Five means are no calibration.
    assert_says(
        &folder.fail(format!("{JSON} --average 240")),
        "the record has 5 rows with a value",
    );
}

/// Records of two platforms.
fn two_platforms() -> Folder {
    let folder = Folder::new();
    for (name, seed, coefficients) in [
        ("a", 51, Coefficients::PAPER_LIKE),
        ("b", 52, Coefficients::default()),
    ] {
        let scenario = Scenario {
            seed,
            coefficients,
            initial: InitialAttitude::AnglesDeg([5.0, 10.0, seed as f64]),
            duration_s: 86_400.0,
            interval_s: 300.0,
            ..Scenario::default()
        };
        folder.put_record(name, &scenario);
    }
    folder
}

/// Both records, each with its bench file.
const BOTH: &str = "a.csv b.csv --bench a.bench.toml --bench b.bench.toml";

#[test]
fn records_of_several_platforms_are_not_taken_for_those_of_one() {
    let folder = two_platforms();
    let words = |text: &str| {
        text.replace(['│', '\n'], " ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    for command in ["diagnose", "plan"] {
        let errors = words(&folder.fail(format!("{command} {BOTH}")));
        for part in [
            "b.csv: gyro_",
            "differs from that of a.csv by",
            "diagnose records of several platforms one by one",
            "help: give the records of one platform",
        ] {
            assert_says(&errors, part);
        }
    }
    let output = folder.run(format!("calibrate --verbose {BOTH}"));
    assert_eq!(output.status.code(), Some(1));
    let said = words(&String::from_utf8(output.stdout).unwrap());
    assert_says(
        &said,
        "If these are records of several platforms, calibrate a.csv, b.csv one by one.",
    );
}

#[test]
fn benches_that_contradict_each_other_are_told_by_every_command_of_several_records() {
    let folder = two_platforms();
    let text = folder.text("b.bench.toml");
    let other = text
        + "
[prior]
bias_sigma_deg_per_h = 3.0
";
    folder.put("b.bench.toml", other);
    for command in ["calibrate", "diagnose", "plan"] {
        let errors = folder.fail(format!("{command} {BOTH}"));
        assert_says(&errors, "[prior]");
        assert_says(&errors, "help: ");
    }
}

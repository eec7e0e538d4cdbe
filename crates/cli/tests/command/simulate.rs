//! `gyrocal simulate` as a user runs it.

use std::fs;

use crate::folder::{Folder, assert_says, repository};

pub(crate) const SCENARIO: &str = "\
seed = 1
[site]
latitude_deg = 39.1
[platform]
initial_angles_deg = [0.0, 0.0, 0.0]
initial_angles_sigma_deg = [0.01, 0.01, 0.01]
[gyros]
bias_deg_per_h = [0.5, -0.5, 0.5]
g_deg_per_h_per_g = [-0.2, 0.2, 0.2]
gg_deg_per_h_per_g2 = [-0.1, 0.1, -0.1]
[noise]
accel_g = 1e-5
gyro_deg_per_h = 0.002
[sampling]
duration_s = 3600
interval_s = 60
";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.put("s.toml", SCENARIO);
    folder
}

const PLAIN: &str = "simulate s.toml --out r.csv";

#[test]
fn record_bench_and_truth_are_written() {
    let folder = folder();
    let said = folder.succeed_as_is("simulate s.toml --out r.csv --bench-out b.toml --json t.json");
    assert!(
        said.starts_with("SIMULATED  r.csv: 61 rows over 0.04 days, seed 1\n"),
        "{said}"
    );
    assert_eq!(folder.names(), ["b.toml", "r.csv", "s.toml", "t.json"]);
    assert_eq!(folder.text("r.csv").lines().count(), 62);
    assert!(folder.text("b.toml").contains("latitude_deg = 39.1\n"));
    let truth: serde_json::Value = folder.json("t.json");
    assert_eq!(truth["schema_version"], 1);
    assert_eq!(truth["coefficients"][4]["name"], "gyro_y.g_y");
    assert_eq!(truth["coefficients"][4]["value"], 0.2);
    assert_eq!(truth["manifest"]["inputs"][0]["path"], "s.toml");
    let command = "gyrocal simulate s.toml --out r.csv --bench-out b.toml --json t.json";
    assert_eq!(truth["manifest"]["command"], command);
}

#[test]
fn what_is_hidden_is_in_the_record_and_in_the_truth_but_not_in_the_bench() {
    let hidden = "\
[temperature]
[[hidden]]
effect = \"gyro_y.g_z\"
size = 0.35
[[hidden]]
effect = \"accel_x.temperature\"
size = 1e-4
";
    let simulate = |scenario: String| {
        let folder = Folder::new();
        folder.put("s.toml", scenario);
        let said = folder.succeed(format!("{PLAIN} --bench-out b.toml --json t.json"));
        (folder, said)
    };
    let (clean, said_clean) = simulate(format!("{SCENARIO}[temperature]\n"));
    let (faulty, said_faulty) = simulate(format!("{SCENARIO}{hidden}"));
    assert!(!said_clean.contains("hidden"), "{said_clean}");
    let line = "\nhidden effects  gyro_y.g_z, accel_x.temperature\n";
    assert!(said_faulty.contains(line), "{said_faulty}");
    assert_eq!(faulty.text("b.toml"), clean.text("b.toml"));
    let (record, other) = (faulty.text("r.csv"), clean.text("r.csv"));
    assert_ne!(record, other);
    assert!(record.starts_with("time_s,accel_x_g,accel_y_g,accel_z_g,temperature_c\n"));
    let truth: serde_json::Value = faulty.json("t.json");
    assert_eq!(truth["rows"], 61);
    assert_eq!(truth["hidden"][0]["effect"], "gyro_y.g_z");
    assert_eq!(
        truth["hidden"][0]["parameters"],
        serde_json::json!([{ "name": "size", "value": 0.35, "unit": "deg/h/g" }])
    );
    let truth: serde_json::Value = clean.json("t.json");
    assert_eq!(truth["hidden"], serde_json::json!([]));
}

#[test]
fn a_mistake_in_a_hidden_effect_is_shown_where_it_is() {
    let folder = Folder::new();
    let hidden = "[[hidden]]\neffect = \"gyro_y.gz\"\nsize = 1\n";
    folder.put("s.toml", format!("{SCENARIO}{hidden}"));
    let errors = folder.fail(PLAIN);
    for part in [
        "s.toml:18:10: found the unknown effect `\"gyro_y.gz\"`",
        "here",
        "did you mean `gyro_y.g_z`",
    ] {
        assert!(errors.contains(part), "{part}\nis not in\n{errors}");
    }
}

#[test]
fn the_seed_decides_and_nothing_else() {
    let folder = folder();
    folder.succeed(PLAIN);
    let first = folder.text("r.csv");
    folder.succeed(PLAIN);
    assert_eq!(folder.text("r.csv"), first);
    folder.succeed("simulate s.toml --out r.csv --seed 2");
    assert_ne!(folder.text("r.csv"), first);
    folder.succeed("simulate s.toml --out r.csv --seed 1");
    assert_eq!(folder.text("r.csv"), first);
}

#[test]
fn the_record_that_ships_is_what_its_scenario_gives() {
    let folder = Folder::new();
    let scenario = repository("examples/data/three_days.scenario.toml");
    let scenario = scenario.to_str().unwrap();
    folder.succeed([
        "simulate",
        scenario,
        "--out",
        "three_days.csv",
        "--bench-out",
        "three_days.bench.toml",
    ]);
    folder.assert_examples(&["three_days.csv", "three_days.bench.toml"]);
}

#[test]
fn bad_scenarios_are_shown_where_they_are_wrong() {
    let cases = [
        (
            "latitude_deg = 39.1",
            "latitude_deg = 91",
            "s.toml:3:16: found `91`, expected a number from -90 to 90",
        ),
        (
            "accel_g = 1e-5",
            "accel_g = 0",
            "s.toml:12:11: found `0`, expected a finite number greater than 0",
        ),
        (
            "accel_g = 1e-5",
            "accel_g = -1e-5",
            "s.toml:12:11: found `-1e-5`, expected a finite number greater than 0",
        ),
        (
            "gyro_deg_per_h = 0.002",
            "gyro_deg_per_h = -0.002",
            "s.toml:13:18: found `-0.002`, expected a finite number greater than 0",
        ),
        (
            "accel_g = 1e-5",
            "acel_g = 1e-5",
            "s.toml:12:1: found the unknown key `acel_g` in `[noise]`, expected `accel_g` or `gyro_deg_per_h`",
        ),
        (
            "accel_g = 1e-5\n",
            "",
            "s.toml:11:2: found `[noise]` without it, expected `accel_g = ` a finite number",
        ),
        (
            "[noise]",
            "[noise",
            "s.toml:11:7: found nothing, expected valid TOML",
        ),
        (
            "interval_s = 60",
            "interval_s = \"60\"",
            "s.toml:16:14: found `\"60\"`, expected a finite number",
        ),
        (
            SCENARIO,
            "",
            "s.toml:1:1: found an empty file, expected some content",
        ),
    ];
    for (right, wrong, message) in cases {
        let folder = Folder::new();
        folder.put("s.toml", SCENARIO.replace(right, wrong));
        let errors = folder.fail("simulate s.toml --out r.csv --bench-out b.toml --json t.json");
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
        // The line is shown and marked; an empty file has none.
        assert_eq!(errors.contains("here"), right != SCENARIO, "{errors}");
    }
}

#[test]
fn a_scenario_that_is_not_text_is_refused() {
    let folder = Folder::new();
    folder.put("s.toml", b"seed = 1\n# caf\xe9\n");
    let errors = folder.fail(PLAIN);
    assert_says(&errors, "s.toml:2:6: found byte 0xE9, expected UTF-8 text");
}

#[test]
fn a_scenario_that_is_not_there_is_named() {
    let errors = Folder::new().fail(PLAIN);
    assert_says(&errors, "s.toml: cannot be read: ");
}

#[test]
fn an_output_that_cannot_be_written_leaves_no_other() {
    let folder = folder();
    fs::create_dir(folder.path("taken")).unwrap();
    for path in ["no/such/folder/t.json", "taken"] {
        let errors = folder.fail(["simulate", "s.toml", "--out", "r.csv", "--json", path]);
        assert_says(&errors, &format!("{path}: cannot be written: "));
    }
    folder.put("r.csv", "old");
    folder.fail("simulate s.toml --out r.csv --json taken");
    assert_eq!(folder.text("r.csv"), "old");
}

#[test]
fn a_wrong_command_line_is_a_usage_error() {
    let folder = folder();
    for arguments in [
        "",
        "simulate",
        "simulate s.toml",
        "simulate s.toml --out r.csv --seed -1",
        "simulate s.toml --out ./s.toml",
        "simulate s.toml --out r.csv --bench-out ./r.csv",
    ] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(folder.names(), ["s.toml"]);
        assert_eq!(folder.text("s.toml"), SCENARIO);
    }
}

#[test]
fn verbose_tells_more_on_stderr_only() {
    let folder = folder();
    let quiet = folder.run(PLAIN);
    let verbose = folder.run("-vv simulate s.toml --out r.csv");
    assert!(quiet.stderr.is_empty());
    assert!(
        String::from_utf8(verbose.stderr)
            .unwrap()
            .contains("simulated")
    );
    assert_eq!(quiet.stdout, verbose.stdout);
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_told_is_a_failure() {
    let folder = folder();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = std::process::Command::new(assert_cmd::cargo::cargo_bin("gyrocal"))
        .current_dir(folder.path(""))
        .args(PLAIN.split(' '))
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_says(&errors, "stdout: cannot be written");
}

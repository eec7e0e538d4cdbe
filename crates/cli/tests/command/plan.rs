//! `gyrocal plan` as a user runs it.

use gyrocal_design::{Aim, AttitudeOf, PlanResult};

use crate::diagnose::hidden_fault;
use crate::folder::{
    BENCH, Folder, RECORD, assert_says, hidden_fault as folder, repository_argument,
};

#[test]
fn a_run_is_planned_from_a_diagnosis() {
    let folder = folder();
    folder.put("d.json", hidden_fault());
    let arguments = format!(
        "plan {RECORD} --bench {BENCH} --diagnosis d.json --hours 24 --limits y=-80..80 --sigma gyro_x.g_x=1e-4 --json p.json"
    );
    let said = folder.succeed(&arguments);
    assert_says(&said, "Recommended next run: 24 h from platform angles x");
    assert_says(&said, "The same duration in the present attitude");
    assert_says(
        &said,
        "Shortest run that meets the goal (a sigma of gyro_x.g_x",
    );
    assert_says(&said, "gyro_y.g_z size");
    let report: PlanResult = folder.json("p.json");
    assert_eq!(report.aim, Aim::Sigmas);
    assert_eq!(report.proposals.len(), 3);
    assert_eq!(report.now.coefficients.len(), 9);
    assert_eq!(report.now.sizes[0].name, "gyro_y.g_z size");
    let best = &report.proposals[0];
    assert_eq!(best.duration_s, 86_400.0);
    // A day in another attitude gives more information than one in the same.
    assert!(best.outlook.sigma_ratio < 0.8 * report.going_on[0].outlook.sigma_ratio);
    let goal = report.goal.unwrap();
    let run = goal.run.unwrap();
    assert!(run.outlook.coefficients[1].sigma <= 1e-4);
    // The same again, to the last bit.
    folder.succeed(&arguments);
    let again: PlanResult = folder.json("p.json");
    assert_eq!(again.proposals, report.proposals);
}

#[test]
fn mistakes_are_told() {
    let folder = folder();
    let plan = |more: &[&str]| {
        let mut arguments = vec!["plan", RECORD, "--bench", BENCH];
        arguments.extend(more);
        folder.fail(&arguments)
    };
    folder.put(
        "other.csv",
        folder.text(RECORD).replacen("0.0,", "0.00,", 1),
    );
    folder.succeed([
        "diagnose",
        "other.csv",
        "--bench",
        BENCH,
        "--json",
        "other.json",
        // The record is an input of the diagnosis, but only as the later record.
        "--validate",
        RECORD,
        "--validate-bench",
        BENCH,
    ]);
    let mut diagnosis: serde_json::Value = folder.json("other.json");
    let inputs = &mut diagnosis["manifest"]["inputs"];
    inputs[0] = inputs[2].clone();
    inputs[1]["sha256"] = "0".into();
    folder.put("bench.json", diagnosis.to_string());
    folder.put("no.json", "{}");
    let cases: [(&[&str], &str); 5] = [
        (
            &["--diagnosis", "other.json"],
            "a diagnosis of another record",
        ),
        (
            &["--diagnosis", "bench.json"],
            "a diagnosis with another bench file",
        ),
        (
            &["--diagnosis", "no.json"],
            "JSON that is not the result of a diagnosis",
        ),
        (&["--hours", "0.1"], "a run of 360 s was asked for"),
        (
            &["--hours", "48", "--limits", "x=-30..30"],
            "keeps the gimbals within their limits",
        ),
    ];
    for (more, message) in cases {
        let errors = plan(more);
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
    for (limits, message) in [
        ("x=30..-30", "expected AXIS=FROM..TO"),
        (
            "x=-10..10,y=0..1,x=20..30",
            "--limits of x are given more than once",
        ),
    ] {
        let output = folder.run(["plan", RECORD, "--bench", BENCH, "--limits", limits]);
        assert_eq!(output.status.code(), Some(2));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(message), "{errors}");
    }
}

/// A record of a unit at rest, computed from its log, with its axes.
fn unit_folder() -> Folder {
    let folder = Folder::new();
    let log = "tests/data/measured/ring_laser_static/imu.csv";
    let description = "tests/data/measured/ring_laser_static/log.toml";
    folder.succeed([
        "import",
        "strapdown",
        &repository_argument(log),
        "--log-description",
        &repository_argument(description),
        "--out",
        "r.csv",
        "--bench-out",
        "b.toml",
        "--axes-out",
        "a.csv",
    ]);
    folder
}

const OF_UNIT: [&str; 4] = ["plan", "r.csv", "--bench", "b.toml"];

#[test]
fn a_log_of_a_strapdown_unit_is_planned() {
    let folder = unit_folder();
    let diagnose = ["r.csv", "--bench", "b.toml", "--gyro-axes", "a.csv"];
    folder.succeed([&["diagnose"], &diagnose[..], &["--json", "d.json"]].concat());
    let with_axes = [&OF_UNIT[..], &["--gyro-axes", "a.csv", "--json", "p.json"]].concat();
    let said = folder.succeed(&with_axes);
    for words in [
        "Recommended next run: 0.5 h from unit angles x",
        "Unit angles turn East, North, Up into the axes of the instruments, about x, then y, then z",
    ] {
        assert!(said.contains(words), "{words}\nis not in\n{said}");
    }
    let fresh: PlanResult = folder.json("p.json");
    assert_eq!(fresh.attitude_of, AttitudeOf::Unit);
    let inputs = fresh.manifest.inputs.iter().map(|input| &*input.path);
    assert_eq!(inputs.collect::<Vec<_>>(), ["r.csv", "b.toml", "a.csv"]);
    // Another attitude tells what the same cannot.
    let best = &fresh.proposals[0].outlook;
    assert!(best.sigma_ratio < 0.9 * fresh.going_on[0].outlook.sigma_ratio);
    folder.succeed([&with_axes[..], &["--diagnosis", "d.json"]].concat());
    let written: PlanResult = folder.json("p.json");
    let pairs = fresh.now.coefficients.iter().zip(&written.now.coefficients);
    for (fresh, written) in pairs {
        // A written result has the noise and the names, and is fitted again: sigmas differ by a thousandth.
        assert!(
            (written.sigma / fresh.sigma - 1.0).abs() < 5e-3,
            "{written:?} {fresh:?}"
        );
    }
    // A diagnosis that is given does not change what comes next.
    for given in [&[][..], &["--diagnosis", "d.json"]] {
        let short = folder.run([&OF_UNIT[..], &["--gyro-axes", "a.csv"], given].concat());
        let short = String::from_utf8(short.stdout).unwrap();
        let short = short.replace("\\\n", " ");
        let short = short.split_whitespace().collect::<Vec<_>>().join(" ");
        for step in [
            "gyrocal import strapdown LOG.csv --log-description LOG.toml --out next.csv",
            "gyrocal calibrate r.csv next.csv --bench b.toml --bench next.toml --gyro-axes a.csv --gyro-axes next.axes.csv",
        ] {
            assert!(short.contains(step), "{step}\nis not in\n{short}");
        }
    }
}

#[test]
fn axes_that_a_diagnosis_was_not_made_with_are_refused() {
    let folder = unit_folder();
    let diagnose = ["diagnose", "r.csv", "--bench", "b.toml"];
    folder.succeed([&diagnose[..], &["--json", "platform.json"]].concat());
    let with_axes = ["--gyro-axes", "a.csv", "--json", "unit.json"];
    folder.succeed([&diagnose[..], &with_axes].concat());
    // Another file with the same axes.
    folder.put("other.csv", folder.text("a.csv") + "\n");
    let cases: [(&[&str], i32, &str); 4] = [
        (
            &["--diagnosis", "unit.json"],
            2,
            "is of a strapdown unit: give its axes, --gyro-axes AXES.csv, for each record",
        ),
        (
            &["--diagnosis", "platform.json", "--gyro-axes", "a.csv"],
            2,
            "is of a stabilised platform: leave --gyro-axes out, or diagnose with them",
        ),
        (
            &["--diagnosis", "unit.json", "--gyro-axes", "other.csv"],
            1,
            "a diagnosis with other axes",
        ),
        (
            &["--gyro-axes", "a.csv", "--gyro-axes", "a.csv"],
            2,
            "2 of --gyro-axes for 1 of records: give one for each record, in their order",
        ),
    ];
    for (more, code, message) in cases {
        let output = folder.run([&OF_UNIT[..], more].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        let errors = errors.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(output.status.code(), Some(code), "{errors}");
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
}

//! `gyrocal plan` as a user runs it.

use gyrocal_design::{Aim, PlanResult};

use crate::folder::Folder;

const RECORD: &str = "hidden_fault.csv";
const BENCH: &str = "hidden_fault.bench.toml";

fn folder() -> Folder {
    let folder = Folder::new();
    for name in [RECORD, BENCH] {
        folder.put_example(name);
    }
    folder
}

#[test]
fn a_run_is_planned_from_a_diagnosis() {
    let folder = folder();
    folder.succeed(&["diagnose", RECORD, "--bench", BENCH, "--json", "d.json"]);
    let arguments = [
        "plan",
        RECORD,
        "--bench",
        BENCH,
        "--diagnosis",
        "d.json",
        "--hours",
        "24",
        "--limits",
        "y=-80..80",
        "--sigma",
        "gyro_x.g_x=1e-4",
        "--json",
        "p.json",
    ];
    let said = folder.succeed(&arguments);
    assert!(
        said.contains("Recommended next run: 24 h from platform angles x"),
        "{said}"
    );
    assert!(
        said.contains("The same duration in the present attitude"),
        "{said}"
    );
    assert!(
        said.contains("Shortest run that meets the goal (a sigma of gyro_x.g_x"),
        "{said}"
    );
    assert!(said.contains("gyro_y.g_z size"), "{said}");
    let report: PlanResult = serde_json::from_str(&folder.text("p.json")).unwrap();
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
    let again: PlanResult = serde_json::from_str(&folder.text("p.json")).unwrap();
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
    folder.succeed(&[
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
    let mut diagnosis: serde_json::Value =
        serde_json::from_str(&folder.text("other.json")).unwrap();
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
        let output = folder.run(&["plan", RECORD, "--bench", BENCH, "--limits", limits]);
        assert_eq!(output.status.code(), Some(2));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(message), "{errors}");
    }
}

//! `gyrocal diagnose` of several records.

use gyrocal_answer::{SizeChoice, Verdict};
use gyrocal_design::PlanResult;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario};

use super::report;
use crate::folder::{CommandLine, Folder, assert_says};

/// Two records of a day with a mass unbalance, `a.csv` and `b.csv`, each with its bench file.
fn folder() -> Folder {
    let folder = Folder::new();
    let records = [
        ("a", 21, [5.0, 10.0, 20.0]),
        ("b", 22, [60.0, -30.0, 120.0]),
    ];
    for (name, seed, angles_deg) in records {
        let scenario = Scenario {
            seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::AnglesDeg(angles_deg),
            duration_s: 86_400.0,
            interval_s: 300.0,
            hidden: vec![Hidden::new("gyro_y.g_z", &[("size", 0.01)]).unwrap()],
            ..Scenario::default()
        };
        folder.put_record(name, &scenario);
    }
    folder
}

/// The message of a command line that cannot be.
fn refused(folder: &Folder, arguments: impl CommandLine) -> String {
    let output = folder.run(arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    errors
}

#[test]
fn two_records_are_told_together_and_alone() {
    let folder = folder();
    let said = folder.succeed("diagnose a.csv b.csv --bench a.bench.toml --bench b.bench.toml --json o.json --report o.html");
    assert_says(&said, "2 records together (a.csv, b.csv)");
    assert_says(&said, "one size in all records");
    assert_says(&said, "Each record alone:");
    let page = folder.text("o.html");
    let words: String = page.replace("<span>", "").replace("</span>", "");
    let plan = "gyrocal plan a.csv b.csv --bench a.bench.toml --bench b.bench.toml";
    assert!(words.contains(plan));
    assert!(words.contains("aria-label=\"2 records\""));
    let result = report(&folder, "o.json");
    assert_eq!(result.verdict, Verdict::EffectsFound);
    assert_eq!(result.manifest.inputs.len(), 4);
    assert_eq!(result.records.len(), 2);
    let by_record = result.findings[0].by_record.as_ref().unwrap();
    assert_eq!(by_record.choice, SizeChoice::Shared);
    a_run_is_planned(&folder);
    // A model file is made from it as from one record.
    folder.succeed("extend o.json --out both.model.toml");
    assert!(folder.text("both.model.toml").contains("gyro_y.g_z"));
}

#[test]
fn what_goes_with_one_record_is_refused() {
    let folder = folder();
    let both = ["diagnose", "a.csv", "b.csv", "--bench", "a.bench.toml"];
    let said = refused(&folder, [&both[..], &["--filter", "euler"]].concat());
    assert_says(&said, "goes with one record");
    let said = folder.fail("diagnose a.csv a.csv --bench a.bench.toml");
    assert_says(&said, "consecutive rows");
    let three = ["--bench", "b.bench.toml", "--bench", "a.bench.toml"];
    let said = refused(&folder, [&both[..], &three].concat());
    assert_says(&said, "3 bench files for 2 records");
}

/// The next run is planned from the joint diagnosis `o.json`, and from nothing else.
fn a_run_is_planned(folder: &Folder) {
    let with = |records: &[&'static str], more: &[&'static str]| {
        let plan = ["plan"].iter().chain(records).copied();
        let benches = ["--bench", "a.bench.toml", "--bench", "b.bench.toml"];
        let arguments = plan.chain(benches).chain(["--diagnosis", "o.json"]);
        arguments.chain(more.iter().copied()).collect::<Vec<_>>()
    };
    let more = ["--hours", "6", "--json", "p.json"];
    let said = folder.succeed(with(&["a.csv", "b.csv"], &more));
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "2 records together (a.csv, b.csv): 578 rows over 2.00 days",
        "Expected result of records and run together",
    ] {
        assert!(said.contains(part), "{said} lacks {part}");
    }
    let short = folder.run(with(&["a.csv", "b.csv"], &["--hours", "6"]));
    let short = String::from_utf8(short.stdout).unwrap();
    let short = short.replace("\\\n", " ");
    let short = short.split_whitespace().collect::<Vec<_>>().join(" ");
    let next = "gyrocal calibrate a.csv b.csv next.csv --bench a.bench.toml --bench b.bench.toml --bench \
                next.toml";
    assert!(short.contains(next), "{short}");
    let plan: PlanResult = folder.json("p.json");
    assert_eq!((plan.records.len(), plan.record.rows), (2, 578));
    assert_eq!(plan.now.sizes[0].name, "gyro_y.g_z size");
    assert_eq!(plan.manifest.inputs.len(), 5);
    // In another order they are other records.
    let said = folder.fail(with(&["b.csv", "a.csv"], &[]));
    assert_says(&said, "a diagnosis of another record");
    let said = refused(folder, "plan a.csv --bench a.bench.toml --diagnosis o.json");
    assert_says(&said, "o.json is a result of 2 records, and one is given");
}

#[test]
fn records_that_were_not_diagnosed_are_planned_from_after_a_joint_diagnosis() {
    let folder = folder();
    let records = ["plan", "a.csv", "b.csv"];
    let benches = ["--bench", "a.bench.toml", "--bench", "b.bench.toml"];
    let short = ["--hours", "6", "--json", "p.json", "--report", "p.html"];
    folder.succeed([&records[..], &benches, &short].concat());
    let plan: PlanResult = folder.json("p.json");
    assert_eq!(plan.now.sizes[0].name, "gyro_y.g_z size");
    assert!(folder.text("p.html").contains("2 records"));
    let said = folder.fail("plan a.csv a.csv --bench a.bench.toml");
    assert_says(&said, "consecutive rows");
    let three = ["--bench", "a.bench.toml"];
    let said = refused(&folder, [&records[..], &benches, &three].concat());
    assert_says(&said, "3 bench files for 2 records");
    let text = folder.text("b.bench.toml");
    let other = text
        + "
[prior]
bias_sigma_deg_per_h = 3.0
";
    folder.put("b.bench.toml", other);
    let said = folder.fail([&records[..], &benches].concat());
    assert_says(&said, "[prior]");
}

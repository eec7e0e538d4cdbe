//! `gyrocal diagnose` of several records.

use gyrocal_diagnosis::Verdict;
use gyrocal_diagnosis::result::SizeChoice;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, simulate};

use super::report;
use crate::folder::Folder;

/// Two records of a day with a mass unbalance, `a.csv` and `b.csv`, each with its bench file.
fn folder() -> Folder {
    let folder = Folder::new();
    let records = [
        ("a", 21, [5.0, 10.0, 20.0]),
        ("b", 22, [60.0, -30.0, 120.0]),
    ];
    for (name, seed, angles_deg) in records {
        let made = simulate(&Scenario {
            seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::AnglesDeg(angles_deg),
            duration_s: 86_400.0,
            interval_s: 300.0,
            hidden: vec![Hidden::new("gyro_y.g_z", &[("size", 0.01)]).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        let path = |end: &str| folder.path(&format!("{name}.{end}"));
        made.record.write(&path("csv")).unwrap();
        made.bench.write(&path("bench.toml")).unwrap();
    }
    folder
}

/// The message of a command line that cannot be.
fn refused(folder: &Folder, arguments: &[&str]) -> String {
    let output = folder.run(arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    errors
}

#[test]
fn two_records_are_told_together_and_alone() {
    let folder = folder();
    let said = folder.succeed(&[
        "diagnose",
        "a.csv",
        "b.csv",
        "--bench",
        "a.bench.toml",
        "--bench",
        "b.bench.toml",
        "--json",
        "o.json",
        "--report",
        "o.html",
    ]);
    assert!(said.contains("2 records together (a.csv, b.csv)"), "{said}");
    assert!(said.contains("one size in all records"), "{said}");
    assert!(said.contains("Each record alone:"), "{said}");
    let result = report(&folder, "o.json");
    assert_eq!(result.verdict, Verdict::EffectsFound);
    assert_eq!(result.manifest.inputs.len(), 4);
    assert_eq!(result.records.len(), 2);
    let by_record = result.findings[0].by_record.as_ref().unwrap();
    assert_eq!(by_record.choice, SizeChoice::Shared);
    let said = refused(
        &folder,
        &[
            "plan",
            "a.csv",
            "--bench",
            "a.bench.toml",
            "--diagnosis",
            "o.json",
        ],
    );
    assert!(said.contains("a result of 2 records"), "{said}");
    // A model file is made from it as from one record.
    folder.succeed(&["extend", "o.json", "--out", "both.model.toml"]);
    assert!(folder.text("both.model.toml").contains("gyro_y.g_z"));
}

#[test]
fn what_goes_with_one_record_is_refused() {
    let folder = folder();
    let both = ["diagnose", "a.csv", "b.csv", "--bench", "a.bench.toml"];
    let said = refused(&folder, &[&both[..], &["--filter", "euler"]].concat());
    assert!(said.contains("goes with one record"), "{said}");
    let said = folder.fail(&["diagnose", "a.csv", "a.csv", "--bench", "a.bench.toml"]);
    assert!(said.contains("consecutive rows"), "{said}");
    let three = ["--bench", "b.bench.toml", "--bench", "a.bench.toml"];
    let said = refused(&folder, &[&both[..], &three].concat());
    assert!(said.contains("3 bench files for 2 records"), "{said}");
}

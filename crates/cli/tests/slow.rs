//! The package of a new plant from its script to an extended one, by commands that derive it.
#![cfg(test)]

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

#[test]
fn a_new_package_is_derived_diagnosed_and_extended() {
    let folder = tempfile::tempdir().unwrap();
    let gyrocal = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("gyrocal").unwrap();
        let ended = command.current_dir(&folder).args(arguments).assert();
        ended.success();
    };
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let tree = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    gyrocal(&[
        "new-plant",
        "oscillator",
        "--gyrocal",
        tree.to_str().unwrap(),
    ]);
    let script = "oscillator/plant.py";
    gyrocal(&["plant", "derive", script]);
    // The package begins with the oscillator of the example.
    let record = tree.join("examples/duffing/record.csv");
    let findings = |json: &str| {
        let plant = ["plant", "diagnose", "oscillator/plant.json"];
        let columns = [
            record.to_str().unwrap(),
            "--columns",
            "oscillator/columns.toml",
        ];
        gyrocal(&[plant, columns, ["--quiet", "--json", json]].concat());
        let answer: Value = serde_json::from_str(&text(json)).unwrap();
        answer["findings"].as_array().unwrap().len()
    };
    assert_eq!(findings("d.json"), 1);
    gyrocal(&["plant", "extend", "d.json", "--script", script]);
    assert!(text(script).contains("    plant.extend(\"v_rate.x^3\", -0.05"));
    gyrocal(&["plant", "derive", script]);
    assert_eq!(findings("e.json"), 0);
}

//! The command of a package for one plant: the answer of the library with interpreted functions.
#![cfg(test)]

use std::path::Path;
use std::process::Command;

use gyrocal_plant::{ColumnMap, LoadedPlant, SearchOptions, diagnose};

#[test]
fn the_command_of_the_package_gives_the_answer_of_the_library() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let directory = tempfile::tempdir().unwrap();
    let [json, page] = ["d.json", "r.html"].map(|name| directory.path().join(name));
    let output = Command::new(env!("CARGO_BIN_EXE_gyrocal-example-duffing"))
        .current_dir(here)
        .args([
            "diagnose",
            "record.csv",
            "--columns",
            "columns.toml",
            "--json",
        ])
        .arg(&json)
        .arg("--report")
        .arg(&page)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("lacks one effect: v_rate.x^3"));
    // The command that made it, not that of the platform.
    assert!(page.contains(
        "<span>gyrocal-example-duffing</span> <span>diagnose</span> <span>record.csv</span>"
    ));
    let written: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(json).unwrap()).unwrap();

    let plant = LoadedPlant::read(&here.join("plant.json")).unwrap();
    let columns = ColumnMap::read(&here.join("columns.toml")).unwrap();
    let record = columns
        .record(plant.description(), &here.join("record.csv"))
        .unwrap();
    let answer = diagnose(&plant, record, None, &SearchOptions::default()).unwrap();
    let found = &answer.answer.findings[0];
    assert_eq!(written["findings"][0]["effect"], found.effect);
    let (value, size) = (
        &written["findings"][0]["parameters"][0]["estimate"],
        &found.parameters[0],
    );
    // Interpreted and generated functions differ by rounding.
    assert!((value.as_f64().unwrap() - size.estimate).abs() < 1e-6 * size.sigma.unwrap());
}

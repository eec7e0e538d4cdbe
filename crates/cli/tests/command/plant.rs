//! `gyrocal plant`: docs/any-plant.md shows what it prints (`documents.rs`).

use crate::folder::{Folder, repository};

#[test]
fn a_missing_file_is_told() {
    let folder = Folder::new();
    let [plant, record] = ["plant.json", "record.csv"].map(|name| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    });
    let errors = folder.fail(&[
        "plant",
        "diagnose",
        &plant,
        &record,
        "--columns",
        "nothing.toml",
    ]);
    assert!(errors.contains("nothing.toml: cannot be read"), "{errors}");
}

#[test]
fn the_answer_for_programs_names_the_cause_and_its_set() {
    let folder = Folder::new();
    let example = |name: &str| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    };
    folder.succeed(&[
        "plant",
        "diagnose",
        &example("plant.json"),
        &example("record.csv"),
        "--columns",
        &example("columns.toml"),
        "--json",
        "o.json",
    ]);
    let answer: serde_json::Value = serde_json::from_str(&folder.text("o.json")).unwrap();
    // The simulator's spring softens by -0.05 x^3 (crates/plant-truth).
    assert_eq!(answer["findings"][0]["effect"], "v_rate.x^3");
}

//! `gyrocal plant`: the page `docs/any-plant.md` shows what the command prints.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use assert_cmd::Command;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn diagnose(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("gyrocal").unwrap();
    command
        .current_dir(root().join("examples/duffing"))
        .args(["plant", "diagnose", "plant.json", "record.csv"])
        .args(arguments);
    command
}

#[test]
fn the_page_shows_what_the_command_prints() {
    let arguments = ["--columns", "columns.toml", "--validate", "later.csv"];
    let output = diagnose(&arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let printed = String::from_utf8(output.stdout).unwrap();
    let page = std::fs::read_to_string(root().join("docs/any-plant.md")).unwrap();
    let without_ends = |text: &str| -> String {
        let lines = text.trim_end().lines().map(str::trim_end);
        lines.collect::<Vec<_>>().join("\n")
    };
    assert!(
        without_ends(&page).contains(&without_ends(&printed)),
        "{printed}"
    );
}

#[test]
fn a_missing_file_is_told() {
    let output = diagnose(&["--columns", "nothing.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("nothing.toml: cannot be read"), "{told}");
}

//! Help, completions, and exit codes.

use crate::folder::{Folder, assert_says, example, repository};

/// The commands that the help lists.
fn commands(folder: &Folder) -> Vec<String> {
    let said = folder.succeed_as_is("--help");
    let list = said.split_once("Commands:\n").unwrap().1;
    let list = list.split_once("\n\n").unwrap().0;
    let names = list.lines().filter(|line| !line.starts_with("   "));
    names
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_command_has_examples_groups_and_the_exit_codes() {
    let folder = Folder::new();
    let names = commands(&folder);
    assert!(names.len() >= 13, "{names:?}");
    let whole = folder.succeed_as_is("--help");
    let codes = whole.split_once("Exit codes:").unwrap().1;
    for name in &names {
        let said = folder.succeed_as_is([name, "--help"]);
        assert!(
            said.contains(&format!("\n  gyrocal {name} ")),
            "{name}: {said}"
        );
        assert!(said.contains("Output on the terminal:"), "{name}: {said}");
        assert!(said.ends_with(codes), "{name}: {said}");
    }
    let said = folder.succeed_as_is("diagnose --help");
    assert_says(&said, "\nFiles to write:\n");
    assert_says(&said, "\nFiles to read:\n");
    assert_says(&said, "[default: 0.01]");
    // One list of exit codes, which the documentation has too.
    let page = std::fs::read_to_string(repository("docs/command.md")).unwrap();
    for line in codes.trim().lines().filter(|line| line.starts_with("  ")) {
        let (code, meaning) = line.trim().split_once("  ").unwrap_or(("", ""));
        if !code.is_empty() {
            assert!(page.contains(&format!("| {code} | {meaning} |")), "{line}");
        }
    }
}

#[test]
fn completions_know_the_commands() {
    let folder = Folder::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = folder.succeed_as_is(["completions", shell]);
        for name in commands(&folder) {
            assert!(script.contains(&name), "{shell}: {name}");
        }
    }
}

#[test]
fn exit_codes_are_as_listed() {
    let folder = Folder::new();
    for name in [
        "three_days.csv",
        "three_days.bench.toml",
        "hidden_fault.csv",
        "hidden_fault.bench.toml",
    ] {
        folder.put_example(name);
    }
    let clean = ["three_days.csv", "--bench", "three_days.bench.toml"];
    let fault = ["hidden_fault.csv", "--bench", "hidden_fault.bench.toml"];
    let code = |parts: &[&[&str]]| folder.run(parts.concat()).status.code();
    let asked = &["--exit-code"][..];
    // A calibration is a result whatever its verdict is, unless it means nothing.
    assert_eq!(code(&[&["calibrate"], &clean]), Some(0));
    assert_eq!(code(&[&["calibrate"], &fault]), Some(0));
    let tight = example("three_days.bench.toml").replace("accel_g = 1e-5", "accel_g = 1e-7");
    folder.put("tight.toml", tight);
    let gross = ["three_days.csv", "--bench", "tight.toml"];
    assert_eq!(code(&[&["calibrate"], &gross]), Some(1));
    assert_eq!(code(&[&["calibrate", "no.csv"], &clean[1..]]), Some(1));
    assert_eq!(code(&[&["calibrate"], &clean[..1]]), Some(2));
    assert_eq!(code(&[&["diagnose"], &clean, asked]), Some(0));
    assert_eq!(code(&[&["diagnose"], &fault, asked]), Some(3));
    assert_eq!(
        code(&[&["diagnose", "no.csv"], &clean[1..], asked]),
        Some(1)
    );
    assert_eq!(code(&[&["diagnose"], &clean[..1], asked]), Some(2));
    let text = example("three_days.csv");
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(5, 6);
    folder.put("swapped.csv", lines.join("\n") + "\n");
    let swapped = [&["swapped.csv"], &clean[1..]].concat();
    assert_eq!(code(&[&["diagnose"], &swapped]), Some(0));
    assert_eq!(code(&[&["diagnose"], &swapped, asked]), Some(5));
    assert_eq!(code(&[&["calibrate"], &swapped]), Some(1));
    // The third of three errors of accelerometers is left as a curve.
    let three = ["csv.gz", "toml"].map(|end| {
        let name = format!("tests/data/before/inputs/three_accelerometer.{end}");
        repository(&name).display().to_string()
    });
    let three = [three[0].as_str(), "--bench", &three[1]];
    assert_eq!(code(&[&["diagnose"], &three, asked]), Some(6));
    assert_eq!(code(&[&["nothing"]]), Some(2));
    // Without a command there is no result.
    assert_eq!(code(&[&[]]), Some(2));
}

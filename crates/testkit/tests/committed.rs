//! Freshness of committed files, checked without Python.
#![cfg(test)]

use std::fs;
use std::time::{Duration, SystemTime};

use gyrocal_codegen::build::Derivation;
use gyrocal_testkit::{WorkspaceCopy, workspace};

/// Cargo does not see an edit that keeps an old file time: this test does.
#[test]
fn committed_files_are_fresh() {
    let derivation = Derivation::open(workspace().join("codegen/derive")).unwrap();
    let stale = derivation.stale().unwrap();
    let list: Vec<String> = stale.iter().map(ToString::to_string).collect();
    assert!(
        list.is_empty(),
        "{}\nrun `{}`",
        list.join("\n"),
        derivation.write_command()
    );
}

#[test]
fn an_edit_with_an_old_file_time_is_seen() {
    let copy = WorkspaceCopy::make(env!("CARGO_TARGET_TMPDIR"), "old-time");
    let before = Derivation::open(copy.derivation()).unwrap();
    copy.edit(
        "codegen/derive/drift.py",
        "square * a**2",
        "2 * square * a**2",
    );
    let old = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    let file = copy.derivation().join("drift.py");
    fs::File::options()
        .write(true)
        .open(file)
        .unwrap()
        .set_modified(old)
        .unwrap();
    let after = Derivation::open(copy.derivation()).unwrap();
    assert_ne!(before.fingerprint(), after.fingerprint());
    let stale = after.stale().unwrap();
    assert!(
        stale
            .iter()
            .any(|stale| stale.path.ends_with("src/generated/platform.rs"))
    );
}

#[test]
fn every_kind_of_input_counts() {
    let copy = WorkspaceCopy::make(env!("CARGO_TARGET_TMPDIR"), "inputs");
    let derivation = copy.derivation();
    let fingerprint = || {
        Derivation::open(&derivation)
            .unwrap()
            .fingerprint()
            .to_owned()
    };
    let mut seen = vec![fingerprint()];
    for file in ["derivation.toml", "requirements.lock", "frames.py"] {
        let path = derivation.join(file);
        fs::write(&path, fs::read_to_string(&path).unwrap() + "\n").unwrap();
        seen.push(fingerprint());
    }
    fs::write(derivation.join("new_file.py"), "").unwrap();
    seen.push(fingerprint());
    fs::rename(
        derivation.join("new_file.py"),
        derivation.join("renamed.py"),
    )
    .unwrap();
    seen.push(fingerprint());
    let all = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), all, "an input does not count");

    let before = fingerprint();
    fs::create_dir(derivation.join("__pycache__")).unwrap();
    fs::write(derivation.join("__pycache__/frames.py"), "x").unwrap();
    let unix = fs::read_to_string(derivation.join("frames.py")).unwrap();
    fs::write(derivation.join("frames.py"), unix.replace('\n', "\r\n")).unwrap();
    assert_eq!(fingerprint(), before, "byte code or line endings count");
}

#[test]
fn the_lock_file_pins_everything_by_hash_and_names_no_host() {
    let derive = workspace().join("codegen/derive");
    let lock = fs::read_to_string(derive.join("requirements.lock")).unwrap();
    let wanted = fs::read_to_string(derive.join("requirements.in")).unwrap();
    let of_generator = workspace().join("codegen/emit/exporter/requirements.lock");
    let default = fs::read_to_string(of_generator).unwrap();
    assert_eq!(default, lock, "codegen/emit/exporter has another copy");
    let pin = wanted
        .lines()
        .find(|line| line.starts_with("casadi=="))
        .unwrap();
    assert!(
        lock.lines()
            .any(|line| line.starts_with(&format!("{pin} "))),
        "lock is older"
    );
    let entries: Vec<&str> = lock
        .split("\n")
        .filter(|line| line.contains("=="))
        .collect();
    for entry in &entries {
        assert!(entry.ends_with(" \\"), "`{entry}` has no hash");
    }
    for word in [
        "://",
        "--index",
        "--find-links",
        "--extra",
        "--trusted",
        "@ ",
    ] {
        assert!(
            !lock
                .lines()
                .any(|line| !line.starts_with('#') && line.contains(word)),
            "{word}"
        );
    }
}

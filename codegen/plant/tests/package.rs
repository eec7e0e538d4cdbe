//! A new package, and the committed copy of it that the workspace builds (`examples/duffing`).
#![cfg(test)]

use std::path::{Path, PathBuf};

use gyrocal_plant_codegen::{Package, Source};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn example(file: &str) -> PathBuf {
    workspace().join("examples/duffing").join(file)
}

#[test]
fn a_new_package_is_the_one_that_the_workspace_builds() {
    let package = Package::new("oscillator", Source::Path(workspace())).unwrap();
    for file in &package.files {
        if file.path == "Cargo.toml" {
            // Paths, name and lints differ.
            for line in [
                "gyrocal-cli = { path = ",
                "gyrocal-plant-codegen = { path = ",
            ] {
                let committed = std::fs::read_to_string(example("Cargo.toml")).unwrap();
                assert!(
                    file.text.contains(line) && committed.contains(line),
                    "{line}"
                );
            }
        } else if file.path != ".gitignore" {
            let committed = std::fs::read_to_string(example(file.path)).unwrap();
            assert_eq!(file.text, committed, "{}", file.path);
        }
    }
}

#[test]
fn names_and_trees_that_are_none_are_refused() {
    let version = || Source::Version("0.1.0".to_owned());
    let refused = |name: &str| Package::new(name, version()).unwrap_err().to_string();
    for name in ["1st", "a b", "", "a/b", "fn", "self", "gen", "a-"] {
        let error = refused(name);
        assert!(error.contains("is no name of a package"), "{error}");
    }
    for name in ["test", "std", "proc-macro", "deps"] {
        let error = refused(name);
        assert!(error.contains("keeps for itself"), "{error}");
    }
    // A package of the tree would meet one of the same name in the lock file.
    for name in ["gyrocal", "gyrocal-plant", "gyrocal_fleet"] {
        let error = refused(name);
        assert!(
            error.contains("is the name of a package of gyrocal"),
            "{error}"
        );
    }
    for name in ["my-plant", "Cart_Pole2", "gyro"] {
        Package::new(name, version()).unwrap();
    }
    let manifest = &Package::new("plant", version()).unwrap().files[0].text;
    assert!(
        manifest.contains("gyrocal-plant = { version = \"=0.1.0\" }"),
        "{manifest}"
    );
    let directory = tempfile::tempdir().unwrap();
    let error = Package::new("plant", Source::Path(directory.path().to_owned())).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("give the root of a tree of gyrocal"),
        "{error}"
    );
}

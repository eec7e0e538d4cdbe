//! Links of the documentation to files of the workspace lead somewhere.
#![cfg(test)]

use std::fs;
use std::path::{Path, PathBuf};

use gyrocal_testkit::workspace;

/// All pages below a folder.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
    found
}

/// Targets of `[text](target)` outside code blocks that are no addresses, without their anchor.
fn local_links(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    let targets = prose.flat_map(|part| part.split("](").skip(1));
    targets
        .filter_map(|rest| rest.split([')', ' ']).next())
        .filter(|target| !target.contains("://") && !target.starts_with("mailto:"))
        .filter_map(|target| target.split('#').next())
        .filter(|target| !target.is_empty())
        .collect()
}

#[test]
fn local_links_are_told_from_addresses_and_code() {
    let text = "[a](b.md#c) [d](https://e.org/f.md) [g](#h)\n```rust\n[i](j)\n```\n[k\nl](m/n.md)";
    assert_eq!(local_links(text), ["b.md", "m/n.md"]);
}

#[test]
fn links_of_the_documentation_lead_to_files() {
    let root = workspace();
    let mut documents = pages(&root.join("docs"));
    for name in [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "SECURITY.md",
        "codegen/emit/README.md",
    ] {
        documents.push(root.join(name));
    }
    let mut checked = 0;
    let mut dead = Vec::new();
    for document in documents {
        let text = fs::read_to_string(&document).unwrap();
        for link in local_links(&text) {
            checked += 1;
            if !document.with_file_name(link).exists() {
                dead.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(dead.is_empty(), "no such file:\n{}", dead.join("\n"));
    // The README alone links to a dozen files.
    assert!(checked >= 12, "{checked} links found");
}

/// The README is the front door: what is said at length stands below docs.
#[test]
fn the_readme_stays_short() {
    let text = fs::read_to_string(workspace().join("README.md")).unwrap();
    assert!(text.lines().count() <= 120, "{}", text.lines().count());
}

/// The example of the page on embedding is that of `ControllerFilter`, which runs as a test.
#[test]
fn the_example_of_embedding_is_the_one_that_runs() {
    let page = fs::read_to_string(workspace().join("docs/embedding.md")).unwrap();
    let (_, after) = page.split_once("```rust\n").unwrap();
    let (shown, _) = after.split_once("```").unwrap();
    let source = fs::read_to_string(workspace().join("src/controller.rs")).unwrap();
    let plain = |text: &str| -> Vec<String> {
        let lines = text
            .lines()
            .map(|line| line.trim_start_matches("///").trim());
        let lines = lines.map(|line| line.trim_start_matches("# ").to_owned());
        lines.filter(|line| !line.is_empty()).collect()
    };
    let (shown, source) = (plain(shown), plain(&source));
    let runs = source.windows(shown.len()).any(|lines| lines == shown);
    assert!(
        runs,
        "docs/embedding.md shows other lines than src/controller.rs"
    );
}

/// Libraries of this workspace in the section `[dependencies]` of a package, without optional ones.
fn uses(folder: &str) -> Vec<String> {
    let manifest = workspace().join(folder).join("Cargo.toml");
    let text = fs::read_to_string(manifest).unwrap();
    let (_, after) = text.split_once("\n[dependencies]\n").unwrap_or(("", ""));
    let lines = after.lines().take_while(|line| !line.starts_with('['));
    lines
        .filter(|line| line.starts_with("gyrocal") && !line.contains("optional"))
        .filter_map(|line| line.split(['.', ' ']).next())
        .map(|name| name.trim_start_matches("gyrocal-").to_owned())
        .collect()
}

/// The folder of a package.
fn folder(package: &str) -> String {
    match package {
        "gyrocal" => ".".to_owned(),
        "codegen" => "codegen/emit".to_owned(),
        "plant-codegen" => "codegen/plant".to_owned(),
        other => format!("crates/{other}"),
    }
}

fn with_theirs(packages: &[String]) -> Vec<String> {
    let mut all = packages.to_vec();
    for package in packages {
        all.extend(with_theirs(&uses(&folder(package))));
    }
    all
}

/// The map of the architecture has every package, with what it uses beside what its dependencies bring.
#[test]
fn the_map_of_the_architecture_is_the_tree() {
    let root = workspace();
    let page = fs::read_to_string(root.join("docs/ARCHITECTURE.md")).unwrap();
    let mut checked = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let folder = cells[1].split('`').nth(1).unwrap();
        if cells.len() != 6 || !root.join(folder).join("Cargo.toml").exists() {
            continue;
        }
        let listed = cells[4].split(", ").filter(|name| !name.is_empty());
        let listed: Vec<String> = listed.map(str::to_owned).collect();
        let (direct, brought) = (uses(folder), with_theirs(&listed));
        let lacks = direct.iter().find(|name| !brought.contains(name));
        assert_eq!(lacks, None, "{folder} lacks a library that it uses");
        let wrong = listed.iter().find(|name| !direct.contains(name));
        assert_eq!(wrong, None, "{folder} lists what it does not use");
        checked += 1;
    }
    assert!(checked >= 29, "{checked} packages");
    for package in fs::read_dir(root.join("crates")).unwrap() {
        let name = package.unwrap().file_name();
        let place = format!("`crates/{}`", name.to_str().unwrap());
        assert!(page.contains(&place), "the map lacks {place}");
    }
}

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
    for name in ["README.md", "CHANGELOG.md", "codegen/emit/README.md"] {
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

//! The structure of the tree, and the cost of a build and of the gate.

mod builds;
mod structure;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gyrocal_evaluation::FieldPopulation;
use gyrocal_testkit::{snapshot, workspace};

use crate::harness::{Context, Error, Figure, pages};

/// Packages of the evidence, and their most lines in `src`.
const EVIDENCE: [&str; 3] = ["evaluation", "figures", "testkit"];
const EVIDENCE_LINES: f64 = 18_500.0;

/// What a user reads of a result: packages, and files of packages that compute; and their most lines.
const PRESENTATION: [&str; 8] = [
    "cli/src",
    "document/src",
    "pages/src",
    "report/src",
    "words/src",
    "design/src/first_screen.rs",
    "design/src/prose.rs",
    "fleet/src/prose.rs",
];
const PRESENTATION_LINES: f64 = 19_000.0;

/// Most lines of Rust in `src` of all packages.
const TREE_LINES: f64 = 132_000.0;

/// All figures of the part; the small ones without builds.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let root = workspace();
    let mut figures = structure::figures(&root)?.to_vec();
    let small = context.is_small();
    // Shown at every commit, and judged at full size.
    figures.extend(lines(&root)?.map(|lines| lines.judged(!small)));
    figures.extend(presentation(&root)?);
    figures.extend(topics(&root)?);
    if !small {
        figures.extend(builds::figures(&root)?);
    }
    Ok(figures)
}

/// Lines of Rust in `src`, without those that are generated.
fn lines(root: &Path) -> Result<[Figure; 3], Error> {
    let of_file = |bytes: &[u8]| bytes.iter().filter(|byte| **byte == b'\n').count() as f64;
    let of_folder = |folder: &Path| -> f64 {
        let files = snapshot(folder).into_iter();
        let rust = files.filter(|(path, bytes)| {
            path.extension().is_some_and(|of| of == "rs") && !bytes.starts_with(b"// @generated")
        });
        rust.map(|(_, bytes)| of_file(&bytes)).sum()
    };
    let of = |package: &Path| of_folder(&package.join("src"));
    let mut presentation = 0.0;
    for place in PRESENTATION {
        let place = root.join("crates").join(place);
        presentation += match place.is_dir() {
            true => of_folder(&place),
            false => of_file(&std::fs::read(&place)?),
        };
    }
    let evidence = EVIDENCE.map(|name| of(&root.join("crates").join(name)));
    let all = packages(root)?.iter().map(|package| of(package)).sum();
    let figure = |name: &str, limit, lines| Figure::at_most(name, limit, lines, "");
    let of_evidence = format!("lines of Rust in src of {}", EVIDENCE.join(", "));
    let of_all = "lines of Rust in src of all packages";
    Ok([
        figure(&of_evidence, EVIDENCE_LINES, evidence.iter().sum()),
        figure("lines of presentation", PRESENTATION_LINES, presentation),
        figure(of_all, TREE_LINES, all),
    ])
}

/// Folders of all packages of the workspace.
fn packages(root: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut packages = ["", "codegen/emit", "codegen/plant"]
        .map(|of| root.join(of))
        .to_vec();
    packages.extend(crates(root)?);
    packages.sort();
    Ok(packages)
}

/// Folders of the packages in `crates`.
fn crates(root: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = std::fs::read_dir(root.join("crates"))?;
    entries.map(|entry| Ok(entry?.path())).collect()
}

/// Packages that draw pictures, by what they depend on, and packages that head an answer.
fn presentation(root: &Path) -> Result<[Figure; 2], Error> {
    let (mut draw, mut head) = (0.0, 0.0);
    for package in crates(root)? {
        let manifest = std::fs::read_to_string(package.join("Cargo.toml"))?;
        draw += f64::from(manifest.contains("resvg"));
        let files = snapshot(&package.join("src"));
        // In two parts, so that this file is none of them.
        let heading = ["\"NOT", "SETTLED\""].join(" ");
        let heads = |text: &[u8]| String::from_utf8_lossy(text).contains(&heading);
        head += f64::from(files.values().any(|text| heads(text)));
    }
    Ok([
        Figure::within("packages that draw pictures", [1.0; 2], draw),
        Figure::within("packages that head an answer", [1.0; 2], head),
    ])
}

/// The number of pages of figures, rows that two of them have, and rows of wrong keys of benches.
fn topics(root: &Path) -> Result<[Figure; 3], Error> {
    let mut pages_of: BTreeMap<String, usize> = BTreeMap::new();
    let (mut topics, folder) = (0.0, root.join("docs/figures"));
    for page in std::fs::read_dir(folder)? {
        let name = page?.file_name();
        let Some(topic) = name.to_str().and_then(|name| name.strip_suffix(".md")) else {
            continue;
        };
        topics += 1.0;
        for row in pages::names(topic) {
            *pages_of.entry(row).or_default() += 1;
        }
    }
    let several = pages_of.values().filter(|count| **count > 1).count();
    let keys = FieldPopulation::wrong_keys()?.len();
    Ok([
        Figure::within("topics of figures", [8.0; 2], topics),
        Figure::at_most("rows that two topics measure", 0.0, several as f64, ""),
        Figure::within("wrong bench keys: rows", [60.0, f64::INFINITY], keys as f64),
    ])
}

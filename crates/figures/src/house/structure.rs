//! What no lint sees: effects compared with literals, cycles between modules, long files. Read line by
//! line, as rustfmt writes them, without comments, tests and generated files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use gyrocal::EFFECTS;
use gyrocal_testkit::snapshot;

use super::packages;
use crate::harness::{Error, Figure};

/// Lines that a file may have.
const FILE_LINES: usize = 400;

/// Words of an expression that holds an id or kind.
const HOLDERS: [&str; 6] = ["effect", "effects", "enters", "id", "kind", "row"];

/// What stands before a literal that is compared, and after it.
const BEFORE: &str = "== != | contains( ends_with( find( once( prefix( starts_with( suffix(";
const AFTER: [&str; 5] = ["=> ", "| ", "= ", "== ", "!= "];

/// A row for each, of all packages of the workspace.
pub(super) fn figures(root: &Path) -> Result<[Figure; 3], Error> {
    let (mut compared, mut circular, mut long) = (Vec::new(), Vec::new(), Vec::new());
    for package in packages(root)? {
        let name = package.strip_prefix(root)?.join("src");
        let mut files = Vec::new();
        for (path, bytes) in snapshot(&package.join("src")) {
            let text = String::from_utf8_lossy(&bytes);
            if path.extension().is_none_or(|of| of != "rs") || text.starts_with("// @generated") {
                continue;
            }
            let file = read(&path, &text);
            let path = name.join(path).display().to_string();
            compared.extend(comparisons(&file.1).map(|found| format!("{path}:{found}")));
            let lines = text.lines().count();
            long.extend((lines > FILE_LINES).then(|| format!("{path}, {lines} lines")));
            files.push(file);
        }
        let cycle = cycle(&files).join(", ");
        circular.extend((!cycle.is_empty()).then(|| format!("{} {{{cycle}}}", name.display())));
    }
    let literals = "places where an effect's id or kind is compared with a string literal";
    let cycles = "cycles between top-level modules of a crate";
    let files = format!("files above {FILE_LINES} lines");
    let rows = [(literals, compared), (cycles, circular), (&files, long)];
    Ok(rows.map(|(name, places)| {
        let measured = format!("{} {}", places.len(), places.join("; "));
        let measured = measured.trim_end().to_owned();
        Figure::told(name, "<= 0", measured, places.is_empty()).over(1, "this tree")
    }))
}

/// Module of a file, from the root of its crate, and text; lines of comments and tests are empty.
fn read(path: &Path, text: &str) -> (Vec<String>, String) {
    let parts = path.with_extension("");
    let parts = parts.iter().map(|part| part.to_string_lossy().into_owned());
    let mut module: Vec<String> = parts.collect();
    module.retain(|part| !["lib", "main", "mod"].contains(&part.as_str()));
    let mut tests = module.last().is_some_and(|name| name.ends_with("tests"));
    let lines = text.lines().map(|line| {
        tests |= line == "mod tests {";
        let left_out = tests || line.trim_start().starts_with("//");
        if left_out { "" } else { line }
    });
    (module, lines.collect::<Vec<_>>().join("\n"))
}

/// Line and literal of each place that compares an id or kind of an effect, or a part of one.
fn comparisons(text: &str) -> impl Iterator<Item = String> {
    let mut matched = "";
    text.lines().zip(1..).flat_map(move |(line, number)| {
        matched = line.split_once("match ").map_or(matched, |(_, of)| of);
        let pieces: Vec<&str> = line.split('"').collect();
        let found = pieces.windows(3).step_by(2).filter(|around| {
            let before = around[0].trim_end_matches([' ', '&']);
            let after = around[2].trim_start_matches([' ', ')']);
            let part = around[1].trim_matches(['.', '_']);
            let mut held = words(line).chain(words(matched));
            let compared = around[0].contains("matches!(")
                || BEFORE.split(' ').any(|of| before.ends_with(of))
                || AFTER.iter().any(|of| after.starts_with(of));
            compared
                && (around[1].contains('.') || held.any(|word| HOLDERS.contains(&word)))
                && EFFECTS.iter().any(|effect| {
                    let parts = effect.id.split('.').chain(effect.id.split('_').take(1));
                    let kind = format!("{:?}", effect.kind);
                    parts.chain([effect.id, &kind]).any(|of| of == part)
                })
        });
        let found = found.map(|around| format!("{number} `{}`", around[1]));
        found.collect::<Vec<_>>()
    })
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    let all = text.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
    all.filter(|word| !word.is_empty())
}

/// Modules at the top of a crate that use each other, directly or through others.
fn cycle(files: &[(Vec<String>, String)]) -> Vec<&str> {
    let tops = files.iter().filter_map(|(path, _)| path.first());
    let tops: BTreeSet<&str> = tops.map(String::as_str).collect();
    // The root exports what its modules define.
    let mut owners: BTreeMap<&str, &str> = tops.iter().map(|top| (*top, *top)).collect();
    for (_, root) in files.iter().filter(|(path, _)| path.is_empty()) {
        for import in root.split("use ").skip(1) {
            let import = import.split(';').next().unwrap_or_default();
            if let Some(top) = words(import).next().and_then(|module| tops.get(module)) {
                words(import).for_each(|name| _ = owners.entry(name).or_insert(top));
            }
        }
    }
    let mut uses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (path, text) in files {
        let Some(top) = path.first() else { continue };
        for root in ["crate::".to_owned(), "super::".repeat(path.len())] {
            for used in text.split(&root).skip(1) {
                let group = used.strip_prefix('{').and_then(|of| of.split(';').next());
                let most = if group.is_some() { usize::MAX } else { 1 };
                let names = words(group.unwrap_or(used)).take(most);
                let used = names.filter_map(|name| owners.get(name)).copied();
                let others = used.filter(|used| used != top);
                uses.entry(top).or_default().extend(others);
            }
        }
    }
    // What uses nothing that is left, or is used by nothing, is in no cycle.
    for _ in &tops {
        let left: BTreeSet<&str> = uses.keys().copied().collect();
        let used: BTreeSet<&str> = uses.values().flatten().copied().collect();
        uses.retain(|top, of| {
            of.retain(|of| left.contains(of));
            !of.is_empty() && used.contains(top)
        });
    }
    uses.into_keys().collect()
}

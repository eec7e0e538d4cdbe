//! Twelve records of an independent simulator with sealed answers (tests/data/cases/README.md).

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use sha2::{Digest, Sha256};

use crate::folder::{Folder, repository};

/// The seal of an answer.
fn seal(case: &str, effect: &str) -> String {
    let digest = Sha256::digest(format!("gyrocal:{case}:{effect}").as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Error of the answer to a case, if any.
fn fault(case: &str, seals: &BTreeSet<String>) -> Option<String> {
    let folder = Folder::new();
    let data = repository("tests/data/cases");
    let input = |kind: &str| data.join(format!("{case}.{kind}")).display().to_string();
    let (record, bench) = (input("csv"), input("toml"));
    folder.succeed(["diagnose", &record, "--bench", &bench, "--json", "o.json"]);
    let report = super::report(&folder, "o.json");
    let named: Vec<&str> = match report.findings.as_slice() {
        [] => vec!["none"],
        findings => findings.iter().map(|f| f.effect.as_str()).collect(),
    };
    let found: BTreeSet<String> = named.iter().map(|effect| seal(case, effect)).collect();
    (found != *seals).then(|| {
        let right = named.iter().filter(|id| seals.contains(&seal(case, id)));
        format!(
            "{case}: named {named:?}, of which {} of {} expected are right",
            right.count(),
            seals.len()
        )
    })
}

#[test]
fn number_and_names_of_effects_are_those_sealed() {
    let text = fs::read_to_string(repository("tests/data/cases/answers.sha256")).unwrap();
    let mut cases: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for line in text.lines() {
        let (hash, case) = line.split_once("  ").unwrap();
        cases
            .entry(case.to_owned())
            .or_default()
            .insert(hash.to_owned());
    }
    assert_eq!(cases.len(), 12);
    let cases: Vec<_> = cases.iter().collect();
    let faults: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = cases
            .chunks(cases.len().div_ceil(4))
            .map(|chunk| {
                let work = move || {
                    let faults = chunk.iter().filter_map(|(case, seals)| fault(case, seals));
                    faults.collect::<Vec<_>>()
                };
                scope.spawn(work)
            })
            .collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap())
            .collect()
    });
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::compare::compared;
use super::moves::{Moves, empty};
use super::results::keep;
use super::{RECORDS, cases, folder};

fn result() -> Value {
    json!({ "diagnose": {
        "verdict": "effects-found",
        "p_value": 1e-200,
        "findings": [
            { "effect": "b", "z": 17.5, "parameters": [{ "name": "size", "estimate": 40.0, "sigma": 1e-3 }] },
            { "effect": "a", "z": 9.5, "parameters": [] },
        ],
        "covariance": [[4.0, 1e-20], [1e-20, 9.0]],
        "rows": 4321,
    }})
}

/// Paths at which an edited result differs.
fn differ(edit: impl FnOnce(&mut Value)) -> Vec<String> {
    let mut now = result();
    edit(&mut now["diagnose"]);
    let (_, differences) = compared(&result(), &now);
    differences.into_iter().map(|one| one.path).collect()
}

#[test]
fn the_table_has_all_kinds_and_states_and_a_result_of_each_record() {
    let cases = cases().unwrap();
    let names: BTreeSet<&str> = cases.iter().map(|case| &*case.name).collect();
    assert_eq!([cases.len(), names.len()], [RECORDS; 2]);
    let kinds: BTreeSet<&str> = cases.iter().map(|case| &*case.kind).collect();
    let expected = ["log", "plant", "platform", "several", "strapdown"];
    assert_eq!(kinds, BTreeSet::from(expected));
    let states: BTreeSet<&str> = cases.iter().map(|case| &*case.state).collect();
    let expected = ["clean", "cut", "faulty", "set-up wrong"];
    assert_eq!(states, BTreeSet::from(expected));
    let files = std::fs::read_dir(folder().join("results")).unwrap();
    let files = files.map(|file| file.unwrap().path().file_stem().unwrap().to_owned());
    let files: BTreeSet<String> = files.map(|stem| stem.into_string().unwrap()).collect();
    assert_eq!(files, names.into_iter().map(str::to_owned).collect());
}

#[test]
fn what_is_edited_missing_or_new_is_found_where_it_is() {
    assert_eq!(compared(&result(), &result()).0, 14);
    assert!(differ(|_| ()).is_empty());
    type Edit = fn(&mut Value);
    let edits: [(Edit, &str); 7] = [
        (|now| now["findings"][0]["z"] = json!(17.51), "findings[].z"),
        (|now| now["rows"] = json!(4322), "rows"),
        (|now| now["verdict"] = json!("clean"), "verdict"),
        (|now| now["verdict"] = Value::Null, "verdict"),
        (
            |now| _ = now["findings"][1].as_object_mut().unwrap().remove("z"),
            "findings[].z",
        ),
        (
            |now| now["findings"][1]["why"] = json!("no"),
            "findings[].why",
        ),
        (
            |now| _ = now["covariance"].as_array_mut().unwrap().pop(),
            "covariance[]",
        ),
    ];
    for (edit, key) in edits {
        assert_eq!(differ(edit), [format!("diagnose.{key}")]);
    }
}

#[test]
fn a_new_element_hides_no_others_and_moves_none() {
    let inserted = |now: &mut Value| {
        let findings = now["findings"].as_array_mut().unwrap();
        findings.insert(0, json!({ "effect": "c" }));
    };
    assert_eq!(differ(inserted), ["diagnose.findings[]"]);
    let edited = differ(|now| {
        inserted(now);
        now["findings"][2]["z"] = json!(9.6);
    });
    assert_eq!(edited, ["diagnose.findings[]", "diagnose.findings[].z"]);
}

#[test]
fn numbers_are_equal_within_what_their_tolerance_says() {
    let estimate = |value: f64| {
        differ(|now| now["findings"][0]["parameters"][0]["estimate"] = json!(value)).len()
    };
    // A millionth of its sigma of 1e-3, not of itself.
    assert_eq!([estimate(40.0 + 0.9e-9), estimate(40.0 + 1.2e-9)], [0, 1]);
    let z = |value: f64| differ(|now| now["findings"][1]["z"] = json!(value)).len();
    assert_eq!([z(9.5 * (1.0 + 0.9e-6)), z(9.5 * (1.0 + 1.1e-6))], [0, 1]);
    // What is zero but for rounding is as exact as the largest of its row.
    let covariance = |value: f64| differ(|now| now["covariance"][1][0] = json!(value)).len();
    assert_eq!([covariance(-3e-18), covariance(1e-5)], [0, 1]);
    // A logarithm of 460.
    let p_value = |value: f64| differ(|now| now["p_value"] = json!(value)).len();
    assert_eq!(
        [p_value(1.0004e-200), p_value(1.001e-200), p_value(0.0)],
        [0, 1, 1]
    );
}

#[test]
fn a_move_allows_what_it_names_and_one_that_nothing_needs_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let heading = "# What.\n#\n# [[move]]\n";
    let list = "\n[[move]]\nstep = \"one\"\nrecords = [\"several-*\"]\nkeys = [\"diagnose.*[].z\"]\n\
                reason = \"\"\n[[move]]\nstep = \"two\"\nrecords = [\"*\"]\nkeys = [\"plan.aim\"]\n\
                reason = \"\"\n";
    let file = folder.path().join("moves.toml");
    std::fs::write(&file, format!("{heading}{list}")).unwrap();
    let mut moves = Moves::read(folder.path()).unwrap();
    assert_eq!(moves.unneeded(), ["one", "two"]);
    assert!(moves.allow("several-rivals", "diagnose.findings[].z"));
    assert!(!moves.allow("several-rivals", "diagnose.findings[].z_of"));
    assert!(!moves.allow("harmonics", "diagnose.findings[].z"));
    assert_eq!(moves.unneeded(), ["two"]);
    empty(folder.path()).unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), heading);
    let without_reason = list.replace("reason = \"\"\n", "");
    std::fs::write(&file, without_reason).unwrap();
    assert!(Moves::read(folder.path()).is_err());
}

#[test]
fn results_are_kept_without_what_git_compares() {
    let mut value = json!({ "diagnose": {
        "manifest": { "version": "1", "inputs": [{ "path": "@a", "sha256": "0" }] },
        "version": [1.0 / 3.0, 7, 2.0],
    }});
    keep("", &mut value);
    assert_eq!(
        value.to_string(),
        r#"{"diagnose":{"manifest":{"inputs":[{"path":"@a"}]},"version":[0.333333333333,7,2.0]}}"#
    );
}

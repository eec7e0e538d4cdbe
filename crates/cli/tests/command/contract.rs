//! The JSON contracts: their committed schemas, and that results conform to them.

use std::fs;

use jsonschema::Validator;
use serde_json::Value;

use crate::folder::{Folder, repository};

/// Set, it renews the committed schemas: `GYROCAL_WRITE_SCHEMAS=1 cargo test -p gyrocal-cli --test
/// command schema`.
const WRITE: &str = "GYROCAL_WRITE_SCHEMAS";

const DIAGNOSIS: &str = "docs/schema/diagnosis.schema.json";
const PLAN: &str = "docs/schema/plan.schema.json";
const LOG: &str = "docs/schema/log.schema.json";

const UNCERTAINTY: &str = "docs/schema/uncertainty.schema.json";

/// Checks that a result of a command conforms to a committed schema.
#[track_caller]
fn assert_conforms(folder: &Folder, name: &str, schema: &str) {
    let schema = fs::read_to_string(repository(schema)).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator: Validator = jsonschema::validator_for(&schema).unwrap();
    let result: Value = serde_json::from_str(&folder.text(name)).unwrap();
    let errors: Vec<String> = validator
        .iter_errors(&result)
        .map(|error| format!("{}: {error}", error.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{name}: {}", errors.join("\n"));
}

/// Checks that a diagnosis conforms to its schema.
#[track_caller]
pub(crate) fn assert_diagnosis(folder: &Folder, name: &str) {
    assert_conforms(folder, name, DIAGNOSIS);
}

/// Checks that a plan conforms to its schema.
#[track_caller]
pub(crate) fn assert_plan(folder: &Folder, name: &str) {
    assert_conforms(folder, name, PLAN);
}

/// Checks that an uncertainty budget conforms to its schema.
#[track_caller]
pub(crate) fn assert_uncertainty(folder: &Folder, name: &str) {
    assert_conforms(folder, name, UNCERTAINTY);
}

#[test]
fn schemas_that_are_committed_are_those_of_the_types() {
    let schemas = [
        (DIAGNOSIS, gyrocal_diagnosis::result::schema()),
        (PLAN, gyrocal_design::schema()),
        (UNCERTAINTY, gyrocal_diagnosis::uncertainty_schema()),
        (LOG, gyrocal_instruments::Description::schema()),
    ];
    for (path, schema) in schemas {
        let mut expected = serde_json::to_string_pretty(&schema).unwrap();
        expected.push('\n');
        let path = repository(path);
        if std::env::var_os(WRITE).is_some() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, &expected).unwrap();
        }
        let committed = fs::read_to_string(&path).unwrap_or_default();
        assert!(
            committed.replace("\r\n", "\n") == expected,
            "{} is stale: {WRITE}=1 cargo test -p gyrocal-cli --test command schema",
            path.display()
        );
    }
}

#[test]
fn a_result_that_lacks_a_key_does_not_conform() {
    let schema = fs::read_to_string(repository(DIAGNOSIS)).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    assert!(!validator.is_valid(&serde_json::json!({ "schema_version": 2 })));
}

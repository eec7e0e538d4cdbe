//! The JSON contracts: their committed schemas, and that results conform to them. `Folder` holds every
//! result that a test of this package writes against its schema.

use std::fs;

use gyrocal_answer::{PlantComparison, PlantFit};
use gyrocal_diagnosis::WatchResult;
use gyrocal_evaluation::{CharacteriseReport, MonteCarloReport};
use gyrocal_instruments::multi_position::TumbleResult;
use gyrocal_instruments::rates::RateReport;
use gyrocal_instruments::strapdown::ImportReport;
use gyrocal_instruments::{AllanReport, Description, ResultFile};
use gyrocal_record::{CalibrationReport, ExtensionReport, written_schema};
use gyrocal_testkit::contracts::{check_contracts, schema_of, violations};
use gyrocal_truth::TruthReport;

use crate::folder::{Folder, repository};

/// Set, it renews the committed schemas: `GYROCAL_WRITE_SCHEMAS=1 cargo test -p gyrocal-cli --test
/// command schema`.
const WRITE: &str = "GYROCAL_WRITE_SCHEMAS";

const LOG: &str = "docs/schema/log.schema.json";

/// Checks the result for programs of a command line, if it asks for one.
#[track_caller]
pub(crate) fn assert_conforms(folder: &Folder, arguments: &[&str]) {
    let json = arguments.iter().position(|one| *one == "--json");
    let Some(name) = json.and_then(|at| arguments.get(at + 1)) else {
        return;
    };
    let words = [1, 2].map(|count| arguments[..count.min(arguments.len())].join(" "));
    let schema = words.iter().find_map(|command| schema_of(command)).unwrap();
    // Devices keep nothing.
    if folder.path(name).is_file() {
        let found = violations(&schema, &folder.text(name));
        assert!(found.is_empty(), "{name}: {found}");
    }
}

#[test]
fn schemas_that_are_committed_are_those_of_the_types() {
    let schemas = [
        ("allan", written_schema::<ResultFile<AllanReport>>()),
        ("calibrate", written_schema::<CalibrationReport>()),
        ("characterise", written_schema::<CharacteriseReport>()),
        ("diagnose", gyrocal_answer::schema()),
        ("extend", written_schema::<ExtensionReport>()),
        (
            "import strapdown",
            written_schema::<ResultFile<ImportReport>>(),
        ),
        ("monte-carlo", written_schema::<MonteCarloReport>()),
        ("plan", gyrocal_design::schema()),
        (
            "plant compare",
            written_schema::<ResultFile<PlantComparison>>(),
        ),
        ("plant diagnose", gyrocal_answer::schema()),
        ("plant fit", written_schema::<ResultFile<PlantFit>>()),
        ("rates", written_schema::<ResultFile<RateReport>>()),
        ("report", gyrocal_diagnosis::uncertainty_schema()),
        ("simulate", written_schema::<TruthReport>()),
        ("tumble", written_schema::<ResultFile<TumbleResult>>()),
        ("watch", written_schema::<WatchResult>()),
    ];
    let commands: Vec<&str> = schemas.iter().map(|(command, _)| *command).collect();
    assert_eq!(commands, gyrocal_cli::commands_with_json());
    let mut files: Vec<_> = schemas
        .into_iter()
        .map(|(command, schema)| (schema_of(command).unwrap(), schema))
        .collect();
    files.push((LOG.to_owned(), Description::schema()));
    for (path, schema) in files {
        let mut expected = serde_json::to_string_pretty(&schema).unwrap();
        expected.push('\n');
        let path = repository(&path);
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
fn results_of_all_commands_conform_on_the_examples() {
    let folder = Folder::new();
    let outcomes = check_contracts(&gyrocal_cli::commands_with_json(), |arguments| {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = folder.run(&arguments);
        match output.status.success() {
            true => Ok(()),
            false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
        }
    });
    for one in outcomes {
        assert!(one.fault.is_empty(), "{}: {}", one.command, one.fault);
    }
}

#[test]
fn a_result_that_lacks_a_key_or_has_a_wrong_type_does_not_conform() {
    let schema = schema_of("diagnose").unwrap();
    let lacking = violations(&schema, "{\"schema_version\": 2}");
    assert!(lacking.contains("manifest"), "{lacking}");
    let schema = schema_of("extend").unwrap();
    let manifest = "{\"program\": \"gyrocal\", \"version\": \"0\", \"model_hash\": \"\", \
                    \"inputs\": [], \"seed\": 0, \"command\": \"\"}";
    let of = |effects: &str| {
        format!(
            "{{\"schema_version\": 1, \"manifest\": {manifest}, \"effects\": {effects}, \
             \"strapdown\": false, \"left_out\": []}}"
        )
    };
    assert_eq!(violations(&schema, &of("[]")), "");
    assert!(!violations(&schema, &of("[1]")).is_empty());
}

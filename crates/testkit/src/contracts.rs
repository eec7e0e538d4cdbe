//! Results for programs against the schemas in `docs/schema`: every command that has `--json`, run on files
//! of the repository.

use std::path::Path;

use jsonschema::Validator;
use serde_json::Value;

use crate::workspace;

/// Arguments of several commands. `@` begins a path in the repository, `%` one in the folder of the run.
const LOG: &str = "@tests/data/measured/ring_laser_static/imu.csv \
                   --log-description @tests/data/measured/ring_laser_static/log.toml";
const FAULT: &str =
    "@examples/data/hidden_fault.csv --bench @examples/data/hidden_fault.bench.toml";
const DAYS: &str = "@examples/data/three_days.csv --bench @examples/data/three_days.bench.toml";

/// Every command with `--json`: its words, the file of its schema without the ending, and its other
/// arguments; those first whose results others read.
#[rustfmt::skip] // a table
const CONTRACTS: [(&str, &str, &[&str]); 16] = [
    ("allan", "allan", &[LOG]),
    ("calibrate", "calibration", &[DAYS]),
    ("characterise", "characteristics", &["--cell d8 --runs 1"]),
    ("diagnose", "diagnosis", &[FAULT]),
    ("extend", "extension", &["%diagnose.json --out %extended.model.toml"]),
    ("import strapdown", "import", &[LOG, "--out %record.csv"]),
    ("monte-carlo", "monte-carlo", &["@examples/data/three_days.scenario.toml --seeds 0..2"]),
    ("plan", "plan", &[FAULT, "--diagnosis %diagnose.json"]),
    ("plant compare", "plant-comparison", &["@examples/duffing/plant.json @examples/duffing/plant.json",
        "@examples/duffing/record.csv --columns @examples/duffing/columns.toml"]),
    ("plant diagnose", "diagnosis", &["@examples/duffing/plant.json @examples/duffing/record.csv",
        "--columns @examples/duffing/columns.toml --validate @examples/duffing/later.csv"]),
    ("plant fit", "plant-fit", &["@examples/duffing/plant.json @examples/duffing/record.csv",
        "--columns @examples/duffing/columns.toml --later @examples/duffing/later.csv"]),
    ("rates", "rates", &[LOG]),
    ("report", "uncertainty", &[FAULT, "--uncertainty --out %report.html"]),
    ("simulate", "truth", &["@examples/data/hidden_fault.scenario.toml --out %simulated.csv"]),
    ("tumble", "tumble", &["@tests/data/measured/xsens_38_positions/imu_counts.csv",
        "--log-description @tests/data/measured/xsens_38_positions/log.toml"]),
    ("watch", "watch", &[DAYS]),
];

/// Result of one command held against its schema.
#[derive(Debug)]
pub struct ContractOutcome {
    /// The words of the command.
    pub command: String,
    /// What is wrong; empty if the result conforms.
    pub fault: String,
}

/// Runs each of these commands in a folder of its own by `run`, which gets all arguments, and validates what
/// `--json` writes. A command without a schema is a fault.
pub fn check_contracts(
    commands: &[String],
    run: impl Fn(&[String]) -> Result<(), String>,
) -> Vec<ContractOutcome> {
    let folder = tempfile::tempdir().unwrap();
    let outcome = |command: &str, fault| ContractOutcome {
        command: command.to_owned(),
        fault,
    };
    let listed = CONTRACTS.iter();
    let listed = listed.filter(|(own, ..)| commands.iter().any(|command| command == own));
    let listed = listed.map(|(own, _, rest)| outcome(own, fault(own, rest, folder.path(), &run)));
    let unlisted = commands.iter().filter(|own| schema_of(own).is_none());
    let unlisted = unlisted.map(|own| outcome(own, "no schema".to_owned()));
    listed.chain(unlisted).collect()
}

/// The schema of the result of a command, by its words, as a path in the repository.
pub fn schema_of(command: &str) -> Option<String> {
    let (_, schema, _) = CONTRACTS.iter().find(|(own, ..)| *own == command)?;
    Some(format!("docs/schema/{schema}.schema.json"))
}

/// What of a result does not conform to a schema of the repository; empty if all does.
pub fn violations(schema: &str, result: &str) -> String {
    let schema = std::fs::read_to_string(workspace().join(schema)).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator: Validator = jsonschema::validator_for(&schema).unwrap();
    let result: Value = serde_json::from_str(result).unwrap();
    let errors = validator.iter_errors(&result);
    let errors = errors.map(|error| format!("{}: {error}", error.instance_path()));
    errors.collect::<Vec<_>>().join("\n")
}

/// The words of a line of arguments. `@` begins a path in the repository, `%` one in a folder.
pub fn words(line: &str, folder: &Path) -> Vec<String> {
    let word = |word: &str| match word.split_at(1) {
        ("@", path) => workspace().join(path).display().to_string(),
        ("%", name) => folder.join(name).display().to_string(),
        _ => word.to_owned(),
    };
    line.split_whitespace().map(word).collect()
}

fn fault(
    command: &str,
    rest: &[&str],
    folder: &Path,
    run: impl Fn(&[String]) -> Result<(), String>,
) -> String {
    let json = folder.join(format!("{}.json", command.replace(' ', "-")));
    let mut arguments: Vec<String> = command.split(' ').map(str::to_owned).collect();
    arguments.extend(rest.iter().flat_map(|line| words(line, folder)));
    arguments.extend(["--json".to_owned(), json.display().to_string()]);
    if let Err(reason) = run(&arguments) {
        return reason;
    }
    let schema = schema_of(command).unwrap();
    violations(&schema, &std::fs::read_to_string(json).unwrap())
}

//! Results for programs against the schemas in `docs/schema`: every command that has `--json`, run on files
//! of the repository.

use std::path::Path;

use jsonschema::Validator;
use serde_json::Value;

use crate::workspace;

/// A command with `--json`.
struct Contract {
    /// Its words.
    command: &'static str,
    /// File of its schema, without the ending.
    schema: &'static str,
    /// Its other arguments. `@` begins a path in the repository, `%` one in the folder of the run.
    arguments: &'static str,
}

/// All of them, those first whose results others read.
const CONTRACTS: [Contract; 14] = [
    Contract {
        command: "allan",
        schema: "allan",
        arguments: "@tests/data/measured/ring_laser_static/imu.csv \
                    --log-description @tests/data/measured/ring_laser_static/log.toml",
    },
    Contract {
        command: "calibrate",
        schema: "calibration",
        arguments: "@examples/data/three_days.csv --bench @examples/data/three_days.bench.toml",
    },
    Contract {
        command: "characterise",
        schema: "characteristics",
        arguments: "--cell d8 --runs 1",
    },
    Contract {
        command: "diagnose",
        schema: "diagnosis",
        arguments: "@examples/data/hidden_fault.csv --bench @examples/data/hidden_fault.bench.toml",
    },
    Contract {
        command: "extend",
        schema: "extension",
        arguments: "%diagnose.json --out %extended.model.toml",
    },
    Contract {
        command: "import strapdown",
        schema: "import",
        arguments: "@tests/data/measured/ring_laser_static/imu.csv \
                    --log-description @tests/data/measured/ring_laser_static/log.toml --out %record.csv",
    },
    Contract {
        command: "monte-carlo",
        schema: "monte-carlo",
        arguments: "@examples/data/three_days.scenario.toml --seeds 0..2",
    },
    Contract {
        command: "plan",
        schema: "plan",
        arguments: "@examples/data/hidden_fault.csv --bench @examples/data/hidden_fault.bench.toml \
                    --diagnosis %diagnose.json",
    },
    Contract {
        command: "plant diagnose",
        schema: "plant-diagnosis",
        arguments: "@examples/duffing/plant.json @examples/duffing/record.csv \
                    --columns @examples/duffing/columns.toml --validate @examples/duffing/later.csv",
    },
    Contract {
        command: "rates",
        schema: "rates",
        arguments: "@tests/data/measured/ring_laser_static/imu.csv \
                    --log-description @tests/data/measured/ring_laser_static/log.toml",
    },
    Contract {
        command: "report",
        schema: "uncertainty",
        arguments: "@examples/data/hidden_fault.csv --bench @examples/data/hidden_fault.bench.toml \
                    --uncertainty --out %report.html",
    },
    Contract {
        command: "simulate",
        schema: "truth",
        arguments: "@examples/data/hidden_fault.scenario.toml --out %simulated.csv",
    },
    Contract {
        command: "tumble",
        schema: "tumble",
        arguments: "@tests/data/measured/xsens_38_positions/imu_counts.csv \
                    --log-description @tests/data/measured/xsens_38_positions/log.toml",
    },
    Contract {
        command: "watch",
        schema: "watch",
        arguments: "@examples/data/three_days.csv --bench @examples/data/three_days.bench.toml",
    },
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
    let listed = CONTRACTS
        .iter()
        .filter(|one| commands.iter().any(|command| command == one.command));
    let mut outcomes: Vec<ContractOutcome> = listed
        .map(|one| ContractOutcome {
            command: one.command.to_owned(),
            fault: fault(one, folder.path(), &run),
        })
        .collect();
    let unlisted = commands
        .iter()
        .filter(|command| schema_of(command).is_none());
    outcomes.extend(unlisted.map(|command| ContractOutcome {
        command: command.clone(),
        fault: "no schema".to_owned(),
    }));
    outcomes
}

/// The schema of the result of a command, by its words, as a path in the repository.
pub fn schema_of(command: &str) -> Option<String> {
    let one = CONTRACTS.iter().find(|one| one.command == command)?;
    Some(format!("docs/schema/{}.schema.json", one.schema))
}

/// What of a result does not conform to a schema of the repository; empty if all does.
pub fn violations(schema: &str, result: &str) -> String {
    let schema = std::fs::read_to_string(workspace().join(schema)).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let validator: Validator = jsonschema::validator_for(&schema).unwrap();
    let result: Value = serde_json::from_str(result).unwrap();
    let errors: Vec<String> = validator
        .iter_errors(&result)
        .map(|error| format!("{}: {error}", error.instance_path()))
        .collect();
    errors.join("\n")
}

fn fault(one: &Contract, folder: &Path, run: impl Fn(&[String]) -> Result<(), String>) -> String {
    let argument = |word: &str| match word.split_at(1) {
        ("@", path) => workspace().join(path).display().to_string(),
        ("%", name) => folder.join(name).display().to_string(),
        _ => word.to_owned(),
    };
    let json = folder.join(format!("{}.json", one.command.replace(' ', "-")));
    let mut arguments: Vec<String> = one.command.split(' ').map(str::to_owned).collect();
    arguments.extend(one.arguments.split_whitespace().map(argument));
    arguments.extend(["--json".to_owned(), json.display().to_string()]);
    if let Err(reason) = run(&arguments) {
        return reason;
    }
    let schema = schema_of(one.command).unwrap();
    violations(&schema, &std::fs::read_to_string(json).unwrap())
}

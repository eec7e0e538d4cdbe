//! Simulation of a scenario.

use std::ops::ControlFlow;
use std::path::PathBuf;

use gyrocal_inference::stop;
use gyrocal_record::Input;
use gyrocal_truth::{Scenario, TruthReport, simulate_watched};
use pyo3::prelude::*;
use sha2::{Digest, Sha256};

use crate::bench::{HeldBench, toml_of_json};
use crate::error::{Failure, Outcome};
use crate::job;
use crate::origin::{json, manifest};
use crate::record::HeldRecord;

/// The largest integer of TOML, so that a seed fits into a scenario file.
const SEED_MAX: u64 = i64::MAX as u64;

/// Simulates a scenario: a file, or its tables (JSON). Returns record, bench description and truth
/// (JSON).
#[pyfunction]
#[pyo3(signature = (path, tables, seed, name, command))]
pub(crate) fn simulate(
    py: Python<'_>,
    path: Option<PathBuf>,
    tables: Option<&str>,
    seed: Option<u64>,
    name: &str,
    command: &str,
) -> PyResult<(HeldRecord, HeldBench, String)> {
    job::run(py, || {
        let (mut scenario, input) = scenario(path, tables)?;
        if let Some(seed) = seed {
            if seed > SEED_MAX {
                let expected = format!("at most {SEED_MAX}");
                return Err(Failure::of_value("seed", format!("{seed}"), expected, ""));
            }
            scenario.seed = seed;
        }
        let simulation = simulate_watched(&scenario, &[], stopped).map_err(|error| Failure {
            message: format!("{}: {error}", input.path),
            ..Failure::default()
        })?;
        let manifest = manifest("", scenario.seed, vec![input], command);
        let truth = json(&TruthReport::new(&simulation, manifest))?;
        let bench_name = format!("{name}.bench");
        let bench = simulation.bench.to_toml(bench_name.as_ref())?;
        let record = HeldRecord::of_memory(simulation.record, name)?;
        Ok((record, HeldBench::of_memory(&bench, &bench_name)?, truth))
    })
}

/// Whether a simulation ends at a row.
fn stopped(_row: usize) -> ControlFlow<()> {
    match stop::is_asked() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

fn scenario(path: Option<PathBuf>, tables: Option<&str>) -> Outcome<(Scenario, Input)> {
    if let Some(path) = path {
        return Ok((Scenario::read(&path)?, Input::of(&path)?));
    }
    let name = "<scenario>";
    let text = toml_of_json(tables.unwrap_or("{}"), name)?;
    let digest = Sha256::digest(text.as_bytes());
    let input = Input {
        path: name.to_owned(),
        sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
        ..Input::default()
    };
    Ok((Scenario::parse(&text, name)?, input))
}

//! Operating characteristics of the diagnosis.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use gyrocal::generated::MODEL_HASH;
use gyrocal_evaluation::{
    BaselineMethod, CellReport, CharacteriseReport, PopulationCell, cell_campaign, cell_report,
};
use gyrocal_record::SCHEMA_VERSION;
use pyo3::prelude::*;

use crate::error::{Class, Failure, Outcome};
use crate::job;
use crate::origin::{json, manifest};

/// What is asked of a characterisation.
struct Request {
    runs: Option<u64>,
    seed: u64,
    results: Option<PathBuf>,
    methods: Vec<BaselineMethod>,
    threads: Option<NonZeroUsize>,
}

/// Measures the operating characteristics; the result (JSON).
#[pyfunction]
#[pyo3(signature = (cells, runs, seed, results, methods, threads, command))]
#[expect(
    clippy::too_many_arguments,
    reason = "the module in Python calls it, with defaults"
)]
pub(crate) fn characterise(
    py: Python<'_>,
    cells: Vec<String>,
    runs: Option<u64>,
    seed: u64,
    results: Option<PathBuf>,
    methods: Option<Vec<String>>,
    threads: Option<NonZeroUsize>,
    command: &str,
) -> PyResult<String> {
    let cells = cells_of(&cells)?;
    let request = Request {
        runs,
        seed,
        results,
        methods: methods_of(methods)?,
        threads,
    };
    job::run(py, || {
        let reports = cells.iter().map(|cell| report(*cell, &request));
        let report = CharacteriseReport {
            schema_version: SCHEMA_VERSION,
            cells: reports.collect::<Outcome<Vec<CellReport>>>()?,
            manifest: manifest(MODEL_HASH, request.seed, Vec::new(), command),
        };
        json(&report)
    })
}

/// Each cell once; all of them if none is named.
fn cells_of(names: &[String]) -> Outcome<Vec<PopulationCell>> {
    let mut cells: Vec<PopulationCell> = Vec::new();
    for name in names {
        let cell = PopulationCell::of_name(name).map_err(|error| Failure {
            message: format!("cells: {error}"),
            ..Failure::default()
        })?;
        if !cells.contains(&cell) {
            cells.push(cell);
        }
    }
    Ok(if cells.is_empty() {
        PopulationCell::ALL.to_vec()
    } else {
        cells
    })
}

/// The methods in their own order.
fn methods_of(names: Option<Vec<String>>) -> Outcome<Vec<BaselineMethod>> {
    let Some(names) = names else {
        return Ok(BaselineMethod::ALL.to_vec());
    };
    let known = BaselineMethod::ALL.map(BaselineMethod::name);
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        let found = format!("`{name}`");
        return Err(Failure::of_value(
            "methods",
            found,
            format!("some of {}", known.join(", ")),
            "",
        ));
    }
    let is_asked = |method: &BaselineMethod| names.iter().any(|name| name == method.name());
    Ok(BaselineMethod::ALL.into_iter().filter(is_asked).collect())
}

fn report(cell: PopulationCell, request: &Request) -> Outcome<CellReport> {
    let runs = request.runs.unwrap_or(cell.full_runs());
    let seeds = request.seed..request.seed + runs;
    let mut campaign = cell_campaign(cell, seeds.clone(), &request.methods);
    if let Some(folder) = &request.results {
        campaign = campaign.results(kept(folder, cell)?);
    }
    if let Some(threads) = request.threads {
        campaign = campaign.threads(threads);
    }
    let evaluated = campaign.run(|seed| cell.evaluate(seed, &request.methods), |_| ());
    let outcome = evaluated.map_err(|error| Failure {
        class: Class::Computation,
        message: error.to_string(),
        ..Failure::default()
    })?;
    Ok(cell_report(cell, &outcome, &seeds))
}

/// File of the kept records of a cell.
fn kept(folder: &Path, cell: PopulationCell) -> Outcome<PathBuf> {
    std::fs::create_dir_all(folder).map_err(|reason| Failure {
        message: format!(
            "{}: the results cannot be kept there: {reason}",
            folder.display()
        ),
        file: Some(folder.display().to_string()),
        ..Failure::default()
    })?;
    Ok(folder.join(format!("{}.jsonl", cell.name())))
}

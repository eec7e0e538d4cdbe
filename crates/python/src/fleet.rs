//! What the diagnosed records of a fleet show together.

use gyrocal::generated::MODEL_HASH;
use gyrocal_fleet::{FleetError, FleetOptions, FleetRecord, RecordName, RecordProblem, summarise};
use pyo3::prelude::*;

use crate::error::{Failure, Outcome};
use crate::job;
use crate::origin::{json, manifest};

/// A diagnosed record as the module in Python hands it over.
#[derive(FromPyObject)]
pub(crate) struct Diagnosed {
    #[pyo3(item)]
    unit: String,
    #[pyo3(item)]
    record: String,
    #[pyo3(item)]
    date_s: Option<f64>,
    #[pyo3(item)]
    batch: Option<String>,
    #[pyo3(item)]
    site: Option<String>,
    #[pyo3(item)]
    result: Option<String>,
    #[pyo3(item)]
    scores: Option<Vec<u8>>,
    #[pyo3(item)]
    error: Option<String>,
}

impl From<FleetError> for Failure {
    fn from(error: FleetError) -> Self {
        match error {
            FleetError::Result(error) => error.into(),
            error => Self {
                message: error.to_string(),
                ..Self::default()
            },
        }
    }
}

/// What the records of a fleet show together: the result (JSON), and its sentences and tables (JSON).
#[pyfunction]
pub(crate) fn summarise_fleet(
    py: Python<'_>,
    records: Vec<Diagnosed>,
    false_discovery_rate: f64,
    group_probability: f64,
    outlier_probability: f64,
    seed: u64,
    command: &str,
) -> PyResult<String> {
    let options = FleetOptions {
        false_discovery_rate,
        group_probability,
        outlier_probability,
        seed,
    };
    job::run(py, || answer(records, &options, command))
}

fn answer(records: Vec<Diagnosed>, options: &FleetOptions, command: &str) -> Outcome<String> {
    let mut read = Vec::with_capacity(records.len());
    let mut problems = Vec::new();
    for one in records {
        let name = RecordName {
            unit: one.unit,
            record: one.record,
            date_s: one.date_s,
            batch: one.batch,
            site: one.site,
        };
        let (unit, record) = (name.unit.clone(), name.record.clone());
        let found = match &one.result {
            Some(result) => FleetRecord::read(name, result, one.scores.as_deref())
                .map_err(|error| error.to_string()),
            None => Err(one
                .error
                .unwrap_or_else(|| "it was not diagnosed".to_owned())),
        };
        match found {
            Ok(record) => read.push(record),
            Err(problem) => problems.push(RecordProblem {
                unit,
                record,
                problem,
            }),
        }
    }
    let mut result = summarise(&read, options)?;
    result.problems.extend(problems);
    result.manifest = manifest(MODEL_HASH, options.seed, Vec::new(), command);
    json(&result)
}

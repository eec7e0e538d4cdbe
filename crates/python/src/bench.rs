//! A bench description: of a file, of a text or of tables.

use std::path::PathBuf;

use gyrocal_record::{Bench, Input};
use pyo3::prelude::*;
use sha2::{Digest, Sha256};

use crate::error::{Failure, Outcome};

/// A bench description that calls of the library take.
#[pyclass(frozen, name = "Bench", module = "gyrocal._gyrocal")]
pub(crate) struct HeldBench {
    pub(crate) bench: Bench,
    pub(crate) input: Input,
}

impl HeldBench {
    /// Takes a bench description in memory.
    pub(crate) fn of_memory(text: &str, name: &str) -> Outcome<Self> {
        let bench = Bench::parse(text, name)?;
        let input = Input {
            path: name.to_owned(),
            sha256: hash(text.as_bytes()),
            role: None,
            identification: bench.identification.clone(),
        };
        Ok(Self { bench, input })
    }

    fn text(&self) -> Outcome<String> {
        Ok(self.bench.to_toml(self.input.path.as_ref())?)
    }
}

#[pymethods]
impl HeldBench {
    /// Reads a file.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        let read = || -> Outcome<Self> {
            let bench = Bench::read(&path)?;
            let input = Input {
                identification: bench.identification.clone(),
                ..Input::of(&path)?
            };
            Ok(Self { bench, input })
        };
        Ok(read()?)
    }

    /// Takes the text of a file.
    #[staticmethod]
    fn of_text(text: &str, name: &str) -> PyResult<Self> {
        Ok(Self::of_memory(text, name)?)
    }

    /// Takes the tables of a file, as JSON.
    #[staticmethod]
    fn of_json(json: &str, name: &str) -> PyResult<Self> {
        Ok(Self::of_memory(&toml_of_json(json, name)?, name)?)
    }

    /// The name that errors and results give it.
    #[getter]
    fn name(&self) -> &str {
        &self.input.path
    }

    /// SHA-256 of the file or of the text, in hexadecimal.
    #[getter]
    fn sha256(&self) -> &str {
        &self.input.sha256
    }

    /// Latitude, north positive.
    #[getter]
    fn latitude_deg(&self) -> f64 {
        self.bench.latitude_deg
    }

    /// The text of a file that reads as the same description.
    fn to_toml(&self) -> PyResult<String> {
        Ok(self.text()?)
    }
}

/// The text of a TOML file with the tables that a JSON object gives.
pub(crate) fn toml_of_json(json: &str, name: &str) -> Outcome<String> {
    let refuse = |reason: &dyn std::fmt::Display| Failure {
        message: format!("{name}: {reason}"),
        advice: Some("give numbers, strings, lists and tables; leave out what is None".to_owned()),
        ..Failure::default()
    };
    let value: serde_json::Value = serde_json::from_str(json).map_err(|error| refuse(&error))?;
    let table = toml::Table::try_from(value).map_err(|error| refuse(&error))?;
    toml::to_string(&table).map_err(|error| refuse(&error))
}

fn hash(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

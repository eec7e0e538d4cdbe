//! Any plant, by its program file: its functions are interpreted.

use std::path::Path;

use gyrocal_pages::{Part, of_plant};
use gyrocal_plant::{LoadedPlant, PlantError, PlantRecord, SearchOptions, diagnose};
use gyrocal_record::{Input, Manifest, printable_path};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::error::{Class, Failure, Outcome};
use crate::origin::{answer_text, manifest};

/// A plant that is ready to be fitted.
#[pyclass(frozen, name = "Plant", module = "gyrocal._gyrocal")]
pub(crate) struct HeldPlant {
    plant: LoadedPlant,
}

/// The page of a diagnosis: its charts need the fits, which no result holds.
#[pyclass(frozen, name = "PlantPage", module = "gyrocal._gyrocal")]
pub(crate) struct HeldPage {
    pub(crate) part: Outcome<Part>,
}

/// The result (JSON) and its page.
type Answer = (String, HeldPage);

/// The columns of a record: time, inputs, outputs and logged quantities in the order of the plant.
#[derive(Clone, Debug)]
struct Columns {
    name: String,
    time_s: Vec<f64>,
    inputs: Vec<Vec<f64>>,
    outputs: Vec<Vec<f64>>,
    regressors: Vec<Vec<f64>>,
}

/// The same as Python hands it over.
#[derive(FromPyObject)]
pub(crate) struct GivenColumns<'py> {
    #[pyo3(item)]
    name: String,
    #[pyo3(item)]
    time_s: PyReadonlyArray1<'py, f64>,
    #[pyo3(item)]
    inputs: Vec<PyReadonlyArray1<'py, f64>>,
    #[pyo3(item)]
    outputs: Vec<PyReadonlyArray1<'py, f64>>,
    #[pyo3(item)]
    regressors: Vec<PyReadonlyArray1<'py, f64>>,
}

impl GivenColumns<'_> {
    fn columns(&self) -> Columns {
        let column = |given: &PyReadonlyArray1<'_, f64>| given.as_array().to_vec();
        let all = |given: &[PyReadonlyArray1<'_, f64>]| given.iter().map(column).collect();
        Columns {
            name: self.name.clone(),
            time_s: column(&self.time_s),
            inputs: all(&self.inputs),
            outputs: all(&self.outputs),
            regressors: all(&self.regressors),
        }
    }
}

impl From<PlantError> for Failure {
    fn from(error: PlantError) -> Self {
        let class = match error {
            PlantError::Input { .. }
            | PlantError::Unreadable { .. }
            | PlantError::NoPlant { .. } => Class::Input,
            _ => Class::Computation,
        };
        Self {
            class,
            message: error.to_string(),
            ..Self::default()
        }
    }
}

/// Settings of a diagnosis.
fn options(false_alarm: f64) -> Outcome<SearchOptions> {
    Ok(SearchOptions {
        false_alarm_probability: Failure::unless_probability("false_alarm", false_alarm)?,
        ..SearchOptions::default()
    })
}

#[pymethods]
impl HeldPlant {
    /// Of the text of a program file.
    #[staticmethod]
    fn of_program(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        let plant = py.detach(|| LoadedPlant::parse(text, name).map_err(Failure::from))?;
        Ok(Self { plant })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> String {
        self.plant.description().name.clone()
    }

    /// Names of the inputs.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        let inputs = self.plant.description().inputs.iter();
        inputs.map(|one| one.id.clone()).collect()
    }

    /// Names of the outputs.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        let outputs = self.plant.description().outputs.iter();
        outputs.map(|one| one.id.clone()).collect()
    }

    /// Names of the logged quantities.
    #[getter]
    fn regressors(&self) -> Vec<String> {
        self.plant.description().regressors.clone()
    }

    /// Ids of the effects of its catalogue.
    #[getter]
    fn effects(&self) -> Vec<&'static str> {
        let effects = self.plant.tables().effects.iter();
        effects.map(|effect| effect.id).collect()
    }

    /// Diagnoses a record: the result (JSON) and its page. `inputs` are names and hashes, and
    /// `command` is the call, both for the manifest.
    fn diagnose(
        &self,
        py: Python<'_>,
        record: GivenColumns<'_>,
        later: Option<GivenColumns<'_>>,
        false_alarm: f64,
        inputs: Vec<(String, String)>,
        command: &str,
    ) -> PyResult<Answer> {
        let record = record.columns();
        let later = later.map(|later| later.columns());
        let options = options(false_alarm)?;
        let inputs = inputs.into_iter().map(|(path, sha256)| Input {
            path,
            sha256,
            ..Input::default()
        });
        let manifest = manifest(self.plant.hash(), options.seed, inputs.collect(), command);
        Ok(py.detach(|| self.answer(record, later, &options, manifest))?)
    }
}

impl HeldPlant {
    fn answer(
        &self,
        record: Columns,
        later: Option<Columns>,
        options: &SearchOptions,
        manifest: Manifest,
    ) -> Outcome<Answer> {
        let path = Path::new(&record.name);
        let name = printable_path(path.file_name().map_or(path, Path::new));
        let record = self.record(record)?;
        let later = later.map(|later| self.record(later)).transpose()?;
        let mut diagnosed = diagnose(&self.plant, record, later, options)?;
        let part = of_plant(&diagnosed, &name, &manifest).map_err(|error| Failure::of_text(&error));
        diagnosed.answer.manifest = manifest;
        let result = answer_text(&diagnosed.answer)?;
        Ok((result, HeldPage { part }))
    }

    fn record(&self, columns: Columns) -> Outcome<PlantRecord> {
        let Columns {
            name,
            time_s,
            inputs,
            outputs,
            regressors,
        } = columns;
        let by_rows = |columns: &[Vec<f64>]| -> Vec<f64> {
            let rows = 0..time_s.len();
            rows.flat_map(|row| {
                columns
                    .iter()
                    .filter_map(move |column| column.get(row).copied())
            })
            .collect()
        };
        let record = PlantRecord {
            inputs: by_rows(&inputs),
            outputs: by_rows(&outputs),
            regressors,
            regressor_means: Vec::new(),
            starts: Vec::new(),
            time_s,
        };
        Ok(record.prepared(self.plant.description(), &name)?)
    }
}

//! Any plant, by its program file: its functions are interpreted.

use std::path::Path;

use gyrocal_instruments::ResultFile;
use gyrocal_pages::{Part, of_plant};
use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose, fit};
use gyrocal_record::{Input, Manifest, printable_path};
use pyo3::prelude::*;

use crate::error::{Class, Failure, Outcome};
use crate::job;
use crate::origin::{answer_text, json, manifest};
use crate::plant_record::{GivenColumns, HeldPlantRecord};
use crate::plant_series::{Series, SeriesArrays};

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

/// The result (JSON), its page, and the outputs over time.
type Answer<'py> = (String, HeldPage, SeriesArrays<'py>);

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

    /// Takes the columns of a record.
    fn record(&self, py: Python<'_>, columns: GivenColumns<'_>) -> PyResult<HeldPlantRecord> {
        let plant = self.plant.description();
        Ok(HeldPlantRecord::new(py, plant, &columns)?)
    }

    /// Diagnoses a record. `inputs` are names and hashes, and `command` is the call, both for the manifest.
    fn diagnose<'py>(
        &self,
        py: Python<'py>,
        record: &Bound<'py, HeldPlantRecord>,
        later: Option<Bound<'py, HeldPlantRecord>>,
        false_alarm: f64,
        inputs: Vec<(String, String)>,
        command: &str,
    ) -> PyResult<Answer<'py>> {
        let (record, later) = (record.get(), later.as_ref().map(Bound::get));
        let options = options(false_alarm)?;
        let manifest = self.manifest(options.seed, inputs, command);
        let (text, page, series) = job::run(py, || self.answer(record, later, &options, manifest))?;
        Ok((text, page, series.arrays(py)?))
    }

    /// Fits a record, and searches nothing: the result (JSON), and the outputs over time.
    fn fit<'py>(
        &self,
        py: Python<'py>,
        record: &Bound<'py, HeldPlantRecord>,
        later: Option<Bound<'py, HeldPlantRecord>>,
        first_rows: usize,
        inputs: Vec<(String, String)>,
        command: &str,
    ) -> PyResult<(String, SeriesArrays<'py>)> {
        let named = |held: &Bound<'py, HeldPlantRecord>| held.get().named.clone();
        let (record, later) = (named(record), later.as_ref().map(named));
        let manifest = self.manifest(0, inputs, command);
        let (text, series) = job::run(py, || {
            let fit = fit(&self.plant, record, later, first_rows, &mut |_, _| ())?;
            let text = json(&ResultFile::new(manifest, &fit.answer))?;
            Ok((text, Series::of(&fit.fitted)?))
        })?;
        Ok((text, series.arrays(py)?))
    }
}

impl HeldPlant {
    fn manifest(&self, seed: u64, inputs: Vec<(String, String)>, command: &str) -> Manifest {
        let inputs = inputs.into_iter().map(|(path, sha256)| Input {
            path,
            sha256,
            ..Input::default()
        });
        manifest(self.plant.hash(), seed, inputs.collect(), command)
    }

    fn answer(
        &self,
        record: &HeldPlantRecord,
        later: Option<&HeldPlantRecord>,
        options: &SearchOptions,
        manifest: Manifest,
    ) -> Outcome<(String, HeldPage, Series)> {
        let path = Path::new(&record.named.name);
        let name = printable_path(path.file_name().map_or(path, Path::new));
        let rows = |held: &HeldPlantRecord| held.named.record.clone();
        let mut diagnosed = diagnose(&self.plant, rows(record), later.map(rows), options)?;
        let part = of_plant(&diagnosed, &name, &manifest).map_err(|error| Failure::of_text(&error));
        diagnosed.answer.manifest = manifest;
        let result = answer_text(&diagnosed.answer)?;
        let best = match diagnosed.answer.has_findings() {
            true => &diagnosed.searched.fitted,
            false => &diagnosed.searched.nominal,
        };
        Ok((result, HeldPage { part }, Series::of(best)?))
    }
}

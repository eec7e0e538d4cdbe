//! Records of plants.

use std::path::Path;

use gyrocal_plant::description::Description;
use gyrocal_plant::{ColumnMap, NamedRecord, PlantRecord};
use gyrocal_record::printable_path;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde_json::{Map, Value, json};

use crate::error::{Failure, Outcome};

/// A record of a plant that is ready to be fitted.
#[pyclass(frozen, name = "PlantRecord", module = "gyrocal._gyrocal")]
pub(crate) struct HeldPlantRecord {
    pub(crate) named: NamedRecord,
    bridged: Vec<String>,
}

/// The columns of a record in the order of the plant, as Python hands them over.
#[derive(FromPyObject)]
pub(crate) struct GivenColumns<'py> {
    #[pyo3(item)]
    name: String,
    /// Names of the columns of the inputs.
    #[pyo3(item)]
    input_columns: Vec<String>,
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
    fn record(&self) -> PlantRecord {
        let column = |given: &PyReadonlyArray1<'_, f64>| given.as_array().to_vec();
        let time_s = column(&self.time_s);
        let by_rows = |given: &[PyReadonlyArray1<'_, f64>]| -> Vec<f64> {
            let columns: Vec<Vec<f64>> = given.iter().map(column).collect();
            let rows = 0..time_s.len();
            rows.flat_map(|row| {
                let values = columns.iter();
                values.filter_map(move |column| column.get(row).copied())
            })
            .collect()
        };
        PlantRecord {
            inputs: by_rows(&self.inputs),
            outputs: by_rows(&self.outputs),
            regressors: self.regressors.iter().map(column).collect(),
            time_s,
            ..PlantRecord::default()
        }
    }

    /// The map that a file of columns would have for the inputs.
    fn map(&self, plant: &Description) -> Outcome<ColumnMap> {
        let names = plant.inputs.iter().map(|input| input.id.clone());
        let columns = self.input_columns.iter().cloned().map(Value::String);
        let inputs: Map<String, Value> = names.zip(columns).collect();
        let map = json!({ "time": "time_s", "inputs": inputs, "outputs": {} });
        serde_json::from_value(map).map_err(|error| Failure::of_text(&format!("columns: {error}")))
    }
}

impl HeldPlantRecord {
    pub(crate) fn new(
        py: Python<'_>,
        plant: &Description,
        given: &GivenColumns<'_>,
    ) -> Outcome<Self> {
        let map = given.map(plant)?;
        let record = given.record();
        let origin = &given.name;
        py.detach(|| {
            let named = NamedRecord {
                name: printable_path(Path::new(origin)),
                record: record.prepared(plant, origin)?,
            };
            let bridged = map.bridged(plant, &named);
            Ok(Self { named, bridged })
        })
    }
}

#[pymethods]
impl HeldPlantRecord {
    /// What is to be said of inputs where the record has no rows for a while.
    #[getter]
    fn bridged(&self) -> Vec<String> {
        self.bridged.clone()
    }
}

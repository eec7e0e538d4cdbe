//! Outputs of a plant over time, as its fit has them.

use gyrocal_plant::{FittedPlant, PlantError};
use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;

/// Outputs over time, by rows.
pub(crate) struct Series {
    outputs: usize,
    time_s: Vec<f64>,
    measured: Vec<f64>,
    simulated: Vec<f64>,
    one_step: Vec<f64>,
    sigmas: Vec<f64>,
}

/// The same as Python takes them: a dictionary.
#[derive(IntoPyObject)]
pub(crate) struct SeriesArrays<'py> {
    time_s: Bound<'py, PyArray1<f64>>,
    measured: Bound<'py, PyArray2<f64>>,
    simulated: Bound<'py, PyArray2<f64>>,
    one_step: Bound<'py, PyArray2<f64>>,
    sigmas: Bound<'py, PyArray1<f64>>,
}

impl Series {
    /// Outputs of the record of a fit: measured, simulated, and predicted one step ahead.
    pub(crate) fn of(fitted: &FittedPlant) -> Result<Self, PlantError> {
        let record = fitted.record();
        Ok(Self {
            outputs: fitted.loaded().description().outputs.len(),
            time_s: record.time_s.clone(),
            measured: record.outputs.clone(),
            simulated: fitted.simulated(),
            one_step: fitted.one_step()?,
            sigmas: fitted.output_sigmas(),
        })
    }

    pub(crate) fn arrays(self, py: Python<'_>) -> PyResult<SeriesArrays<'_>> {
        let shape = [self.time_s.len(), self.outputs];
        let by_rows = |values: Vec<f64>| PyArray1::from_vec(py, values).reshape(shape);
        Ok(SeriesArrays {
            measured: by_rows(self.measured)?,
            simulated: by_rows(self.simulated)?,
            one_step: by_rows(self.one_step)?,
            time_s: PyArray1::from_vec(py, self.time_s),
            sigmas: PyArray1::from_vec(py, self.sigmas),
        })
    }
}

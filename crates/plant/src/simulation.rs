//! Errors of simulations, by output: open-loop ones, and predictions one step ahead.

use gyrocal_answer::{OutputFit, SimulationError};
use gyrocal_inference::Pass;
use gyrocal_statistics::mean;

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::loaded::LoadedPlant;
use crate::record::PlantRecord;

/// Sum of squares of the errors of an output over some rows, and their number.
pub(crate) fn squares(
    record: &PlantRecord,
    simulated: &[f64],
    output: usize,
    rows: impl Iterator<Item = usize>,
) -> (f64, usize) {
    let outputs = simulated.len() / record.len().max(1);
    let errors = rows.map(|row| {
        let place = row * outputs + output;
        // A missing reading is NaN; a simulation that leaves the numbers is infinitely wrong.
        let is_missing = record.outputs[place].is_nan();
        let error = record.outputs[place] - simulated[place];
        (
            is_missing,
            if error.is_nan() { f64::INFINITY } else { error },
        )
    });
    let present = errors.filter(|(is_missing, _)| !is_missing);
    present.fold((0.0, 0), |(sum, count), (_, error)| {
        (sum + error * error, count + 1)
    })
}

/// Root mean square over some parts, from their sums of squares and numbers of values.
pub(crate) fn rms(parts: &[(f64, usize)]) -> f64 {
    let sum: f64 = parts.iter().map(|(sum, _)| sum).sum();
    let count: usize = parts.iter().map(|(_, count)| count).sum();
    (sum / count.max(1) as f64).sqrt()
}

/// Outputs of each row as a pass over them expects them from the readings before; NaN where one is missing.
pub(crate) fn one_step(pass: &Pass<'_>, record: &PlantRecord) -> Result<Vec<f64>, PlantError> {
    let outputs = record.outputs.len() / record.len().max(1);
    let mut expected = vec![f64::NAN; record.outputs.len()];
    pass.reduce(|seen| {
        let place = seen.row * outputs + seen.output;
        expected[place] = record.outputs[place] - seen.deviation * seen.columns[0];
    })?;
    Ok(expected)
}

/// Errors of each output, without some rows at the beginning of the record.
pub(crate) fn output_fits(
    plant: &LoadedPlant,
    record: &PlantRecord,
    (open_loop, one_step): (&[f64], &[f64]),
    first_rows: usize,
) -> Vec<OutputFit> {
    let outputs = plant.description.outputs.iter().enumerate();
    let all = outputs.map(|(index, output)| OutputFit {
        output: output.id.clone(),
        unit: output.unit.clone(),
        open_loop: error(record, open_loop, index, first_rows),
        one_step: error(record, one_step, index, first_rows),
        left_out_rms: None,
    });
    all.collect()
}

fn error(
    record: &PlantRecord,
    simulated: &[f64],
    output: usize,
    first_rows: usize,
) -> SimulationError {
    let outputs = record.outputs.len() / record.len().max(1);
    let rows = || first_rows..record.len();
    let measured = rows().map(|row| record.outputs[row * outputs + output]);
    let measured: Vec<f64> = measured.filter(|value| !value.is_nan()).collect();
    if measured.is_empty() {
        return SimulationError {
            rms: None,
            fit_percent: None,
        };
    }
    let level = mean(&measured);
    let about = measured.iter().map(|value| (value - level).powi(2)).sum();
    let about = rms(&[(about, measured.len())]);
    let off = rms(&[squares(record, simulated, output, rows())]);
    let percent = 100.0 * (1.0 - off / about);
    SimulationError {
        rms: Some(off).filter(|rms| rms.is_finite()),
        fit_percent: Some(percent).filter(|percent| percent.is_finite()),
    }
}

impl FittedPlant {
    /// Outputs of each row of the record as the readings before tell them, in the noise of the fit: predictions one
    /// step ahead, by rows; NaN where a reading is missing. Without noise of the rates, and without correlated noise,
    /// they are [`Self::simulated`].
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub fn one_step(&self) -> Result<Vec<f64>, PlantError> {
        one_step(&self.linearised(&[])?.pass(&self.noise, &[]), self.record())
    }
}

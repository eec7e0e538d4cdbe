//! Open-loop simulation of a fitted model over its record, and its error.

use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_record::Record;
use gyrocal_statistics::rms_of_present;

/// A simulation from the first row on, without measurement updates.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoopSimulation {
    /// Specific force of the model at each row, g.
    pub simulated_g: Vec<[f64; 3]>,
    /// Measured minus simulated specific force of each axis, g.
    pub residuals_g: [Vec<f64>; 3],
    /// Values of the record that the fit leaves out: they do not count in what follows.
    pub left_out: usize,
    /// Root mean square of the residuals of each axis, g; zero of an axis without a value.
    pub axis_rms_g: [f64; 3],
    /// That of the axes together, g: root of the mean of the mean squares of those with a value.
    pub rms_g: f64,
}

impl OpenLoopSimulation {
    /// Simulates a fitted model over its record.
    ///
    /// # Errors
    /// As [`FittedPlatform::free_run_g`].
    pub fn new(fitted: &FittedPlatform<'_>, record: &Record) -> Result<Self, CalibrationError> {
        let simulated_g = fitted.free_run_g()?;
        let residuals_g: [Vec<f64>; 3] = core::array::from_fn(|axis| {
            let rows = record.accel_g.iter().zip(&simulated_g);
            rows.map(|(measured, simulated)| measured[axis] - simulated[axis])
                .collect()
        });
        let weights = fitted.noise_model().weights.as_deref();
        let is_used = |row: usize, axis: usize| weights.is_none_or(|all| all[row][axis] > 0.0);
        let of_axes = [0, 1, 2].map(|axis| {
            let all = residuals_g[axis].iter().enumerate();
            let used = all.filter(|(row, _)| is_used(*row, axis));
            rms_of_present(used.map(|(_, residual_g)| residual_g))
        });
        let present = residuals_g.iter().flatten().filter(|one| !one.is_nan());
        let used = of_axes.iter().map(|(_, values)| values);
        let known = of_axes.iter().filter(|(_, values)| *values > 0);
        Ok(Self {
            left_out: present.count() - used.sum::<usize>(),
            axis_rms_g: of_axes.map(|(rms_g, _)| rms_g),
            rms_g: rms_of_present(known.map(|(rms_g, _)| rms_g)).0,
            simulated_g,
            residuals_g,
        })
    }
}

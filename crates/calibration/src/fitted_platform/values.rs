//! What a fit says: values, noise, attitudes, outputs.

use gyrocal::trajectory::Orientation;
use gyrocal_hypothesis::ModelExtension;
use nalgebra::DMatrix;

use super::{FittedPlatform, NoiseModel};
use crate::error::CalibrationError;
use crate::law::Law;
use crate::temperature::TemperatureScale;

impl FittedPlatform<'_> {
    /// Mean over the rows of the normalised innovation squared; the number of components of a row is
    /// expected, 3 if none is missing.
    #[must_use]
    pub fn nis_mean(&self) -> f64 {
        self.solution.cost / self.solution.rows.max(1) as f64
    }

    /// The noise that the fit believes.
    #[must_use]
    pub fn noise_model(&self) -> &NoiseModel {
        &self.noise
    }

    /// The part of the model beyond the nine coefficients.
    #[must_use]
    pub fn extension(&self) -> &ModelExtension {
        &self.extension
    }

    /// Estimates: the nine coefficients, then the extension's parameters, then its further
    /// columns.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.problem.values[..self.shared]
    }

    /// Covariance of their errors; of several records those of each turn-on follow.
    #[must_use]
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.uncertainty.total
    }

    /// Standard deviations before the record, in the order of [`Self::values`].
    #[must_use]
    pub fn prior_sigma(&self) -> Vec<f64> {
        self.problem.unknowns[..self.shared]
            .iter()
            .map(|unknown| unknown.sigma)
            .collect()
    }

    /// Twice the cost: squares of all residuals, of the noise between rows and of distances from
    /// priors, over their variances. As many are expected as there are values.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.solution.cost
    }

    /// Steps that the fit took.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.solution.iterations
    }

    /// Smoothed attitude at each row.
    #[must_use]
    pub fn points(&self) -> &[Orientation] {
        match &self.several {
            Some(several) => &several.points,
            None => &self.problem.runs[0].points,
        }
    }

    /// What the model relates temperatures to, if they were logged.
    #[must_use]
    pub fn temperature_scale(&self) -> Option<TemperatureScale> {
        self.problem.runs.first()?.rows.temperature_scale()
    }

    /// All parameters of the extended model: those that are not estimated are zero. Of several records those of
    /// the first.
    #[must_use]
    pub fn parameters(&self) -> Vec<f64> {
        self.problem.parameters(0)
    }

    /// Specific force that the model gives at each row for the smoothed attitude, g.
    #[must_use]
    pub fn predicted_g(&self) -> Vec<[f64; 3]> {
        let runs = self.problem.runs.iter().enumerate();
        runs.flat_map(|(run, leg)| {
            let parameters = self.problem.parameters(run);
            self.problem.outputs(run, &leg.points, &parameters)
        })
        .collect()
    }

    /// Specific force along the axes of the instruments at each row, from that along those of the platform:
    /// the same, unless the instruments are fixed to a body.
    pub(crate) fn along_instruments(&self, mut force_g: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
        for (run, rows) in self.record_rows().into_iter().enumerate() {
            if let Some(axes) = &self.problem.runs[run].rows.gyro_axes {
                for (row, force_g) in force_g[rows].iter_mut().enumerate() {
                    *force_g = axes.along_gyros(row, force_g);
                }
            }
        }
        force_g
    }

    /// Whether the law holds in the axes of instruments that are fixed to a body.
    #[must_use]
    pub fn is_strapdown(&self) -> bool {
        self.problem.model.0 == Law::Strapdown
    }

    /// Specific force that the model gives when it runs by itself from the first attitude, with
    /// the estimated parameters and without the record, g.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn free_run_g(&self) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let mut simulated_g = Vec::with_capacity(self.points().len());
        for run in 0..self.problem.runs.len() {
            let parameters = self.problem.parameters(run);
            let points = self.problem.free_run(run, &parameters)?;
            simulated_g.extend(self.problem.outputs(run, &points, &parameters));
        }
        Ok(simulated_g)
    }
}

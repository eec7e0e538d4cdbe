//! Predicted information of a planned run.

use gyrocal::generated::catalogue;
use gyrocal::trajectory::Orientation;
use gyrocal::{Anchored, Chart};
use gyrocal_hypothesis::{Column, Covariate, ExtraColumns};
use nalgebra::DMatrix;

use crate::attitude::attitude_hypotheses;
use crate::error::CalibrationError;
use crate::fitted_platform::{NoiseModel, walks};
use crate::law::{Law, LawInputs};
use crate::options::Options;
use crate::platform::covariates;
use crate::problem::{Problem, RunProblem};
use crate::run::{Run, WeightedRows};
use crate::settings::filter_settings;
use crate::temperature::TemperatureScale;

/// A run that has not been made. Its trajectory is the noise-free solution of the model from the
/// first attitude.
#[derive(Clone, Debug)]
pub struct PlannedRun<'a> {
    /// Times, missing values and bench of the run. Accelerometer values are used only to level the
    /// platform if the bench does not declare the attitude.
    pub run: Run<'a>,
    /// Attitude at the first row.
    pub start: Orientation,
    /// All parameters of [`gyrocal::Catalogue`].
    pub parameters: &'a [f64],
    /// Onsets and time constants, as [`gyrocal::Catalogue`] takes them.
    pub shapes: [f64; catalogue::SHAPES.len()],
    /// The expected noise, with the random walks of the gyros, each from zero; weights are not used.
    pub noise: &'a NoiseModel,
    /// What the model's parameters relate temperatures to: [`crate::FittedPlatform::temperature_scale`] of the fit
    /// that they are of.
    pub temperature_scale: Option<TemperatureScale>,
}

/// Predicted information of a run, and the trajectory that it is linearised about.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictedInformation {
    /// Information matrix of the amplitudes of the columns, those of parameters first; the
    /// attitudes at all rows are eliminated.
    pub information: DMatrix<f64>,
    /// Attitude at each row.
    pub points: Vec<Orientation>,
}

impl PlannedRun<'_> {
    /// Attitude at each row without noise.
    ///
    /// # Errors
    /// As [`crate::cramer_rao_bound`].
    pub fn trajectory(&self, options: &Options) -> Result<Vec<Orientation>, CalibrationError> {
        let none = ExtraColumns::default();
        let points = vec![self.start; self.run.record.len()];
        let problem = self.problem(points, options)?;
        problem
            .with_active(0, self.parameters, &[], &none, |pass| pass.free_run())
            .map_err(|source| CalibrationError::pass(0, source))
    }

    /// Covariates at each row along a trajectory, g.
    ///
    /// # Errors
    /// As [`crate::cramer_rao_bound`].
    pub fn covariates(
        &self,
        points: &[Orientation],
        options: &Options,
    ) -> Result<Vec<Covariate>, CalibrationError> {
        let problem = self.problem(points.to_vec(), options)?;
        Ok(covariates(&problem.outputs(0, points, self.parameters)))
    }

    /// Information of the rows from `first` on, given the earlier ones, on the parameters `active`
    /// of [`gyrocal::Catalogue`] and on further columns, along the trajectory `points`. The biases of gyros that
    /// have a random walk have to be active.
    ///
    /// # Errors
    /// As [`crate::cramer_rao_bound`].
    pub fn predicted_information(
        &self,
        points: Vec<Orientation>,
        active: &[usize],
        columns: &[Column],
        first: usize,
        options: &Options,
    ) -> Result<PredictedInformation, CalibrationError> {
        let further = ExtraColumns::new(columns.to_vec());
        let count = active.len() + columns.len();
        let mut problem = self.problem(points, options)?;
        problem.runs[0].set_walks(walks(&self.noise.gyro_walk_deg_per_h_per_sqrt_h));
        let mut earlier = DMatrix::zeros(count, count);
        let reduced = problem
            .with_active(0, self.parameters, active, &further, |pass| {
                pass.reduce(|value| {
                    if value.row < first {
                        let columns = nalgebra::DVectorView::from_slice(&value.columns[1..], count);
                        earlier.ger(1.0, &columns, &columns, 1.0);
                    }
                })
            })
            .map_err(|source| CalibrationError::pass(0, source))?;
        Ok(PredictedInformation {
            information: reduced.gram.view((1, 1), (count, count)) - earlier,
            points: problem
                .runs
                .into_iter()
                .flat_map(|run| run.points)
                .collect(),
        })
    }

    fn problem(
        &self,
        points: Vec<Orientation>,
        options: &Options,
    ) -> Result<Problem<'_, Anchored<Law>, LawInputs>, CalibrationError> {
        let Run { record, bench } = self.run;
        let settings = filter_settings(bench, options.moving_chart());
        // All hypotheses have the same covariance: it does not depend on azimuth.
        let prior_covariance = attitude_hypotheses(record, bench)?
            .first()
            .map(|hypothesis| hypothesis.prior.covariance)
            .ok_or(CalibrationError::NotLevelled)?;
        let mut chart: Chart<f64, LawInputs> = Chart::for_model(settings.site);
        if let Some(field_gauss) = bench.magnetic_field_gauss {
            chart.set_field_gauss(field_gauss);
        }
        chart.inputs_mut().catalogue.shapes = self.shapes;
        let density = settings.drift_noise_density();
        let noise_g = self
            .noise
            .accel_ratio
            .map(|ratio| ratio * settings.accel_noise_g);
        let mut rows = WeightedRows::new(record, record.len(), noise_g);
        if self.temperature_scale.is_some() {
            rows.set_temperature_scale(self.temperature_scale);
        }
        Ok(Problem {
            model: Law::Platform.anchored(),
            integration: options.discretisation.integration,
            longest_step_s: options.discretisation.longest_step_s,
            unknowns: Vec::new(),
            values: Vec::new(),
            runs: vec![RunProblem {
                rows,
                chart,
                noise_density: self.noise.gyro_ratio.map(|ratio| ratio * ratio * density),
                prior: self.start,
                prior_covariance,
                points,
                parameter_unknowns: Vec::new(),
                further: ExtraColumns::default(),
                amplitudes: Vec::new(),
                walks: Vec::new(),
                walk_changes: Vec::new(),
            }],
        })
    }
}

//! Predicted information of a planned run.

use std::borrow::Cow;

use gyrocal::estimation::Manifold;
use gyrocal::generated::catalogue;
use gyrocal::scalar::Model;
use gyrocal::trajectory::Orientation;
use gyrocal::{Anchored, Chart};
use gyrocal_hypothesis::{Column, Covariate, ExtraColumns};
use gyrocal_inference::Series;
use nalgebra::{DMatrix, UnitQuaternion, Vector3};

use crate::attitude::attitude_hypotheses;
use crate::error::CalibrationError;
use crate::fitted_platform::{NoiseModel, walks};
use crate::law::{Law, LawInputs};
use crate::options::Options;
use crate::platform::covariates;
use crate::problem::{Problem, RunProblem};
use crate::run::{Conditions, Run, WeightedRows};
use crate::settings::filter_settings;
use crate::temperature::TemperatureScale;
use crate::unit_start::UnitStart;

/// Axes of the instruments along those of the platform, by rows.
const ALIGNED: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A run that has not been made. Its trajectory is the noise-free solution of the model from the
/// first attitude.
///
/// That of a strapdown unit is a log of the unit at rest on the Earth. Rows and trajectory are those of the
/// platform that is computed from it, and the axes of the instruments follow from them.
#[derive(Clone, Debug)]
pub struct PlannedRun<'a> {
    /// Times, missing values and bench of the run. Accelerometer values are used only to level the
    /// platform if the bench does not declare the attitude.
    pub run: Run<'a>,
    /// Attitude of the platform at the first row.
    pub start: Orientation,
    /// How the run of a strapdown unit begins; its covariance takes the place of the sigmas of the bench. `None` of
    /// a stabilised platform.
    pub unit: Option<UnitStart>,
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
    /// Attitude of the platform at each row without noise.
    ///
    /// # Errors
    /// As [`crate::cramer_rao_bound`].
    pub fn trajectory(&self, options: &Options) -> Result<Vec<Orientation>, CalibrationError> {
        let points = vec![self.start; self.run.record.len()];
        let problem = self.problem(points, options)?;
        if let Some(unit) = &self.unit {
            return Ok(self.trajectory_of(unit, &problem));
        }
        problem.free_run(0, self.parameters)
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

    /// Attitudes of the platform that a unit at rest computes. What its gyros err by depends on specific force,
    /// field and time along axes that rest, and not on the platform: the rate of a platform that lies along these
    /// axes is that of any, along them.
    fn trajectory_of(
        &self,
        unit: &UnitStart,
        problem: &Problem<'_, Anchored<Law>, LawInputs>,
    ) -> Vec<Orientation> {
        let run = &problem.runs[0];
        let attitude = unit.attitude(&self.start);
        let (mut chart, mut moving) = (run.chart, [0.0; 3]);
        problem.model.place(&attitude, &mut moving, &mut chart);
        let mut platform_q_gyros = unit.rotation();
        let mut points = vec![self.start];
        for (row, pair) in self.run.record.time_s.windows(2).enumerate() {
            let interval_s = pair[1] - pair[0];
            let parts = (interval_s / problem.longest_step_s).ceil().max(1.0);
            let part_s = interval_s / parts;
            for part in 0..parts as usize {
                let from_s = pair[0] + part_s * part as f64;
                run.rows.over(row, from_s, from_s + part_s, &mut chart);
                chart.inputs_mut().set_gyro_axes(&ALIGNED);
                let rate = problem.model.rates(&moving, self.parameters, &chart);
                // Axes that turn by a vector turn components by its opposite.
                let turn = Vector3::from(rate) * -part_s;
                platform_q_gyros *= UnitQuaternion::from_scaled_axis(turn);
            }
            points.push(attitude.map(|vector| (platform_q_gyros * Vector3::from(vector)).into()));
        }
        points
    }

    /// Covariance of the first attitude, along the axes of the platform, rad².
    fn prior_covariance(&self) -> Result<[[f64; 3]; 3], CalibrationError> {
        if let Some(unit) = &self.unit {
            return Ok(unit.covariance_rad2(&self.start));
        }
        // All hypotheses have the same covariance: it does not depend on azimuth.
        attitude_hypotheses(self.run.record, self.run.bench)?
            .first()
            .map(|hypothesis| hypothesis.prior.covariance)
            .ok_or(CalibrationError::NotLevelled)
    }

    fn problem(
        &self,
        points: Vec<Orientation>,
        options: &Options,
    ) -> Result<Problem<'_, Anchored<Law>, LawInputs>, CalibrationError> {
        let Run { record, bench } = self.run;
        let settings = filter_settings(bench, options.moving_chart());
        let prior_covariance = self.prior_covariance()?;
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
        let law = match &self.unit {
            Some(unit) => {
                rows.gyro_axes = Some(Cow::Owned(unit.axes(&points)));
                Law::Strapdown
            }
            None => Law::Platform,
        };
        Ok(Problem {
            model: law.anchored(),
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

#[cfg(test)]
mod tests {
    use gyrocal::Catalogue;
    use gyrocal::trajectory::rotation_between;
    use gyrocal_record::{Bench, Record};

    use super::*;

    #[test]
    fn a_unit_at_rest_computes_the_platform_that_the_law_in_its_axes_gives() {
        let bench = "[site]\nlatitude_deg = 39.1\n\n[platform]\ninitial_angles_deg = [0, 0, 0]\n\
             initial_angles_sigma_deg = [1, 1, 1]\n\n[noise]\naccel_g = 1e-5\ngyro_deg_per_h = 0.002\n";
        let bench = Bench::parse(bench, "bench.toml").unwrap();
        let rows = 2 * 288;
        let record = Record {
            time_s: (0..rows).map(|row| 300.0 * f64::from(row)).collect(),
            accel_g: vec![[0.0, 0.0, 1.0]; rows as usize],
            temperature_c: None,
        };
        let mut parameters = vec![0.0; Catalogue::PARAMETERS];
        parameters[..9].copy_from_slice(&[0.8, -0.4, 0.2, -0.5, 0.3, 0.1, 0.6, 0.7, -0.3]);
        let half = 0.4_f64;
        let planned = PlannedRun {
            run: Run {
                record: &record,
                bench: &bench,
            },
            start: [[0.0, 0.8, 0.6], [1.0, 0.0, 0.0]],
            unit: Some(UnitStart {
                platform_q_gyros: [half.cos(), half.sin(), 0.0, 0.0],
                covariance_enu_rad2: [[1e-6, 0.0, 0.0], [0.0, 1e-6, 0.0], [0.0, 0.0, 1e-6]],
            }),
            parameters: &parameters,
            shapes: [0.0; catalogue::SHAPES.len()],
            noise: &NoiseModel::default(),
            temperature_scale: None,
        };
        let options = Options::default();
        let points = planned.trajectory(&options).unwrap();
        let problem = planned.problem(points.clone(), &options).unwrap();
        let free = problem.free_run(0, planned.parameters).unwrap();
        let far = |(a, b): (&Orientation, &Orientation)| {
            let turn = rotation_between(a, b);
            turn.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let worst = points.iter().zip(&free).map(far).fold(0.0, f64::max);
        // Axes between rows turn uniformly to 2e-5, and drifts of a degree an hour turn by 0.8 rad in two days.
        assert!(worst < 5e-5, "{worst}");
        // What a platform with such gyros of its own does is another thing.
        let platform = PlannedRun {
            unit: None,
            ..planned.clone()
        };
        let platform = platform.trajectory(&options).unwrap();
        assert!(points.iter().zip(&platform).map(far).fold(0.0, f64::max) > 0.1);
    }
}

//! The nominal model with effects of the catalogue, fitted to one record.

mod budget;
mod evidence;
mod hypothesis;
mod noise_model;
mod nominal;
mod open_loop;
mod passes;
mod prediction;
mod rate_noise;
mod record_sizes;
mod several;
mod unit_start;
mod values;

use gyrocal::generated::catalogue;
use gyrocal::{Anchored, Catalogue, Discretisation};
use gyrocal_hypothesis::{ExtraColumns, ModelExtension};
use gyrocal_inference::Walk;
use gyrocal_record::{Bench, Record};

use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::law::{Law, LawInputs};
use crate::layout::SiteQuantity;
use crate::platform::PLATFORM;
use crate::problem::{Problem, RunProblem, Unknown};
use crate::settings::filter_settings;
use crate::solve::{MAX_PASSES_AGAIN, Solution};
use crate::temperature::TemperatureScale;
use crate::uncertainty::Uncertainty;

pub use noise_model::NoiseModel;
pub use open_loop::SiteBias;
pub use prediction::{Estimates, Expectation, WalkEnd};
pub use rate_noise::GYRO_NOISE_PRIOR_SIGMA;
pub use record_sizes::RecordSizes;
use several::Several;
pub use several::joined_record;

/// Axes of the platform.
const AXES: usize = 3;

/// Seconds in an hour.
const S_PER_H: f64 = 3600.0;

const SHAPES: usize = catalogue::SHAPES.len();

/// Onsets and time constants of a record as [`Catalogue`] takes them.
fn shapes(several: Option<&Several>, extension: &ModelExtension, run: usize) -> [f64; SHAPES] {
    let shapes = several::shapes_of(several, extension, run);
    core::array::from_fn(|index| shapes[index])
}

/// Site quantities with a declared standard deviation: parameters of every fit.
fn of_site(bench: &Bench) -> ModelExtension {
    ModelExtension {
        parameters: SiteQuantity::ALL
            .into_iter()
            .filter_map(|quantity| {
                let place = catalogue::PARAMETERS
                    .iter()
                    .position(|element| element.id == quantity.id())?;
                Some((place, quantity.declared_sigma(bench)?))
            })
            .collect(),
        ..ModelExtension::default()
    }
}

/// The random walks of the gyros that have one, from their size.
pub(crate) fn walks(deg_per_h_per_sqrt_h: &[f64; 3]) -> Vec<Walk> {
    let rates = PLATFORM.rates.iter().zip(deg_per_h_per_sqrt_h);
    rates
        .filter(|(_, size)| **size > 0.0)
        .map(|(rate, size)| Walk {
            parameter: rate.constant,
            density: size * size / S_PER_H,
        })
        .collect()
}

/// What a fit has beside its problem.
struct Parts {
    noise: NoiseModel,
    several: Option<Several>,
    /// Passes after which it is given up.
    most_passes: usize,
}

/// An extended model at its best fit to a record, or to several records of one platform.
///
/// Rows of several records are counted through all of them, one after the other.
#[derive(Clone)]
pub struct FittedPlatform<'a> {
    problem: Problem<'a, Anchored<Law>, LawInputs>,
    solution: Solution,
    uncertainty: Uncertainty,
    extension: ModelExtension,
    noise: NoiseModel,
    /// Number of values that all records share.
    shared: usize,
    /// `None` of one record.
    several: Option<Several>,
}

impl<'a> FittedPlatform<'a> {
    /// Fits another extension, from where this one is.
    ///
    /// # Errors
    /// [`CalibrationError::NotConverged`], [`CalibrationError::NoDescent`],
    /// [`CalibrationError::NotPositiveDefinite`], [`CalibrationError::Pass`].
    pub fn refitted(&self, extension: &ModelExtension) -> Result<Self, CalibrationError> {
        self.refitted_with(extension, |_| (), self.noise.clone())
    }

    /// The same with the play of the temperature's hysteresis in another record of the same platform.
    ///
    /// # Errors
    /// As [`Self::refitted`].
    pub fn refitted_with_play_of(
        &self,
        extension: &ModelExtension,
        other: &Record,
    ) -> Result<Self, CalibrationError> {
        let change = |run: &mut RunProblem<'a, LawInputs>| {
            let scale = TemperatureScale::with_play_of(run.rows.record(), other);
            run.rows.set_temperature_scale(scale);
        };
        self.refitted_with(extension, change, self.noise.clone())
    }

    fn refitted_with(
        &self,
        extension: &ModelExtension,
        change: impl Fn(&mut RunProblem<'a, LawInputs>),
        noise: NoiseModel,
    ) -> Result<Self, CalibrationError> {
        let before = self.parameters();
        let amplitudes = &self.problem.runs[0].amplitudes;
        let mut unknowns = self.problem.unknowns[..PARAMETERS].to_vec();
        let mut values = self.problem.values[..PARAMETERS].to_vec();
        for (parameter, sigma) in &extension.parameters {
            unknowns.push(Unknown::estimated(*sigma));
            values.push(before[*parameter]);
        }
        let further = &extension.columns;
        for (column, sigma) in further.columns().iter().zip(further.sigmas()) {
            unknowns.push(Unknown::estimated(*sigma));
            let same = self
                .extension
                .columns
                .columns()
                .iter()
                .position(|c| c == column);
            values.push(same.map_or(0.0, |same| self.problem.values[amplitudes[same]]));
        }
        // The offsets of each turn-on come last.
        values.extend_from_slice(&self.problem.values[self.shared..]);
        let mut runs = self.problem.runs.clone();
        for run in &mut runs {
            run.parameter_unknowns = Vec::new();
            run.further = ExtraColumns::default();
            run.amplitudes = Vec::new();
            change(run);
        }
        let problem = Problem {
            model: self.problem.model,
            integration: self.problem.integration,
            longest_step_s: self.problem.longest_step_s,
            unknowns,
            runs,
            values,
        };
        let several = self.several.clone();
        let parts = Parts {
            noise,
            several,
            most_passes: MAX_PASSES_AGAIN,
        };
        Self::solved(problem, extension.clone(), parts)
    }

    /// The same extension fitted with another noise.
    ///
    /// # Errors
    /// As [`Self::refitted`].
    pub fn with_noise(&self, bench: &Bench, noise: &NoiseModel) -> Result<Self, CalibrationError> {
        let density = filter_settings(bench, Discretisation::default()).drift_noise_density();
        let change = |leg: &mut RunProblem<'a, LawInputs>| {
            leg.rows
                .set_noise(noise.accel_ratio.map(|ratio| ratio * bench.accel_noise_g));
            leg.rows.weights.clone_from(&noise.weights);
            leg.noise_density = noise.gyro_ratio.map(|ratio| ratio * ratio * density);
            leg.set_walks(walks(&noise.gyro_walk_deg_per_h_per_sqrt_h));
        };
        self.refitted_with(&self.extension, change, noise.clone())
    }

    /// `problem` has the unknowns that all records share, and no run has columns yet.
    fn solved(
        mut problem: Problem<'a, Anchored<Law>, LawInputs>,
        extension: ModelExtension,
        Parts {
            noise,
            mut several,
            most_passes,
        }: Parts,
    ) -> Result<Self, CalibrationError> {
        let mut sums = vec![Vec::new(); Catalogue::PARAMETERS];
        for (parameter, sum) in sums.iter_mut().enumerate().take(PARAMETERS) {
            sum.push(parameter);
        }
        for (offset, (parameter, _)) in extension.parameters.iter().enumerate() {
            sums[*parameter].push(PARAMETERS + offset);
        }
        let first = PARAMETERS + extension.parameters.len();
        let shared = first + extension.columns.columns().len();
        let own = several.as_ref().map_or(0, Several::unknowns);
        problem.values.resize(shared + own, 0.0);
        for run in 0..problem.runs.len() {
            let mut sums = sums.clone();
            if let Some(several) = &several {
                for (parameter, sigma) in several.offsets.iter().zip(&several.offset_sigmas) {
                    sums[*parameter].push(problem.unknowns.len());
                    problem.unknowns.push(Unknown::estimated(*sigma));
                }
            }
            let columns = several::columns_of(several.as_ref(), extension.columns.columns(), run);
            let leg = &mut problem.runs[run];
            leg.chart.inputs_mut().catalogue.shapes = shapes(several.as_ref(), &extension, run);
            leg.parameter_unknowns = sums;
            leg.further = ExtraColumns::new(columns);
            leg.amplitudes = (first..shared).collect();
            leg.further
                .set_amplitudes(problem.values[first..shared].iter().copied());
        }
        let solution = problem.solve(most_passes)?;
        let uncertainty = Uncertainty::new(&problem.unknowns, &solution)
            .ok_or(CalibrationError::NotPositiveDefinite)?;
        if let Some(several) = &mut several {
            let points = problem.runs.iter().flat_map(|run| &run.points);
            several.points = points.copied().collect();
        }
        Ok(Self {
            problem,
            solution,
            uncertainty,
            extension,
            noise,
            shared,
            several,
        })
    }

    /// The same with copies of what it borrows.
    #[must_use]
    pub fn into_owned(self) -> FittedPlatform<'static> {
        let problem = self.problem;
        let runs = problem.runs.into_iter().map(|run| RunProblem {
            rows: run.rows.into_owned(),
            chart: run.chart,
            noise_density: run.noise_density,
            prior: run.prior,
            prior_covariance: run.prior_covariance,
            points: run.points,
            parameter_unknowns: run.parameter_unknowns,
            further: run.further,
            amplitudes: run.amplitudes,
            walks: run.walks,
            walk_changes: run.walk_changes,
        });
        FittedPlatform {
            problem: Problem {
                model: problem.model.0.anchored(),
                integration: problem.integration,
                longest_step_s: problem.longest_step_s,
                unknowns: problem.unknowns,
                runs: runs.collect(),
                values: problem.values,
            },
            solution: self.solution,
            uncertainty: self.uncertainty,
            extension: self.extension,
            noise: self.noise,
            shared: self.shared,
            several: self.several,
        }
    }
}

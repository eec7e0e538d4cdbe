//! A plant at its best fit to a record.

mod model;

use std::sync::Arc;

use gyrocal_answer::Starts;
use gyrocal_hypothesis::{Column, FittedModel, ModelExtension, RateNoise, Rows};
use nalgebra::DMatrix;

use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;
use crate::later_starts::eliminated;
use crate::linearised::{Linearised, reduce};
use crate::lines::of_search;
use crate::loaded::LoadedPlant;
use crate::noise::NoiseProblem;
use crate::problem::Problem;
use crate::record::PlantRecord;
use crate::solve::{Iterate, Solution, Solver};
use crate::starts;

/// Standard deviation of a parameter that nothing is known of before a record, over its declared value: an
/// estimate three times as large costs a deviance of 0.0004, and what no record determines stays finite.
const UNKNOWN: f64 = 100.0;

/// Standard deviation of a held parameter before a record, over its size: it stays where it is declared.
const HELD: f64 = 1e-6;

/// A model of a plant, with effects of its catalogue, fitted to a record.
#[derive(Clone, Debug)]
pub struct FittedPlant {
    pub(crate) problem: Arc<Problem>,
    extension: ModelExtension,
    pub(crate) noise: FittedNoise,
    pub(crate) solution: Arc<Solution>,
    /// Covariance of what the search knows: all unknowns but the initial states of later records.
    covariance: DMatrix<f64>,
    starts: Starts,
}

impl FittedPlant {
    /// Fits the nominal model; `held` are nominal parameters that stay as declared.
    ///
    /// # Errors
    /// [`PlantError::NoFit`], [`PlantError::NotFinite`], [`PlantError::Singular`].
    pub fn nominal(
        plant: &LoadedPlant,
        record: PlantRecord,
        held: &[usize],
    ) -> Result<Self, PlantError> {
        Self::nominal_from(plant, record, held, None)
    }

    /// The same from other parameters: differences of initial states and parameters from the declared
    /// ones.
    ///
    /// # Errors
    /// As [`Self::nominal`].
    pub fn nominal_from(
        plant: &LoadedPlant,
        record: PlantRecord,
        held: &[usize],
        first: Option<&[f64]>,
    ) -> Result<Self, PlantError> {
        let mut problem = Problem::new(plant, Arc::new(record), 1);
        let states = plant.description.states.len();
        for (sigma, own) in problem.prior_sigma[states..]
            .iter_mut()
            .zip(&plant.description.parameters)
        {
            if sigma.is_infinite() && own.value != 0.0 {
                *sigma = UNKNOWN * own.value.abs();
            }
        }
        for index in held {
            let size = plant.description.parameters[*index].value.abs();
            let size = if size > 0.0 { size } else { 1.0 };
            problem.prior_sigma[states + index] = HELD * size;
        }
        problem.substeps = starts::substeps(&problem, &vec![0.0; problem.nominal()]);
        let noise = problem.declared_noise();
        let (solution, starts) = starts::best(&problem, &noise, first)?;
        let problem = Arc::new(problem);
        let extension = ModelExtension::default();
        Ok(Self::of(problem, extension, noise, solution, starts))
    }

    fn of(
        problem: Arc<Problem>,
        extension: ModelExtension,
        noise: FittedNoise,
        solution: Solution,
        starts: Starts,
    ) -> Self {
        let shared = solution.at.values.len() - problem.later();
        Self {
            covariance: solution
                .covariance
                .view((0, 0), (shared, shared))
                .into_owned(),
            problem,
            extension,
            noise,
            solution: Arc::new(solution),
            starts,
        }
    }

    /// The plant.
    #[must_use]
    pub fn loaded(&self) -> &LoadedPlant {
        &self.problem.plant
    }

    /// The record.
    #[must_use]
    pub fn record(&self) -> &PlantRecord {
        &self.problem.record
    }

    /// Starts that were tried for the nominal model.
    #[must_use]
    pub fn starts(&self) -> Starts {
        self.starts
    }

    /// Standard deviations of the noise over the declared ones: outputs, then noises of rates.
    #[must_use]
    pub fn noise_ratios(&self) -> Vec<f64> {
        self.noise.ratios()
    }

    /// Twice the cost of the fit: squares of residuals, noises and distances from priors over their
    /// variances.
    #[must_use]
    pub fn deviance(&self) -> f64 {
        self.solution.cost
    }

    /// States at each row.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        &self.solution.at.points
    }

    /// Rows for a search, with states and inputs as covariates.
    #[must_use]
    pub fn rows(&self) -> Rows {
        Rows {
            covariates: self.covariates(),
            ..(*self.problem.rows).clone()
        }
    }

    /// Whitened innovations: row, output, value.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub fn whitened(&self) -> Result<Vec<(usize, usize, f64)>, PlantError> {
        let mut whitened = Vec::new();
        self.linearised(&[])?
            .pass(&self.noise, &[])
            .reduce(|seen| whitened.push((seen.row, seen.output, seen.columns[0])))?;
        Ok(whitened)
    }

    pub(crate) fn lines(&self) -> Vec<Column> {
        self.problem.lines(&self.extension)
    }

    /// The Gram matrix of some columns, the states eliminated.
    pub(crate) fn gram(&self, lines: &[Column]) -> Result<DMatrix<f64>, PlantError> {
        Ok(reduce(&self.linearised(lines)?.pass(&self.noise, lines))?.gram)
    }

    /// The model about its fit, with derivatives by the parameters of some lines.
    pub(crate) fn linearised(&self, lines: &[Column]) -> Result<&Linearised, PlantError> {
        let solution = &self.solution;
        let own = &solution.lin.rows.layout;
        let mut parameters = lines.iter().filter_map(Column::parameter);
        if parameters.all(|one| own.place(one).is_some()) {
            return Ok(&solution.lin);
        }
        if let Some(whole) = solution.whole.get() {
            return Ok(whole);
        }
        let problem = &*self.problem;
        let course =
            Solver::new(problem, &self.extension, self.noise.clone()).course(&solution.at.values);
        let mut dynamics = Dynamics::new(&problem.plant, &problem.record, problem.substeps);
        let whole = dynamics.linearise(&course, &solution.at.points)?;
        Ok(solution.whole.get_or_init(|| whole))
    }

    /// The declared noises of this model over their declared standard deviations, each with its 95 % interval.
    pub(crate) fn noise_levels(&self) -> Result<Vec<[f64; 3]>, PlantError> {
        self.with_noise_problem(|unknown| unknown.intervals(&self.noise))
    }

    /// What the noise of this model is estimated from.
    pub(crate) fn with_noise_problem<R>(
        &self,
        of: impl FnOnce(&NoiseProblem<'_>) -> Result<R, PlantError>,
    ) -> Result<R, PlantError> {
        self.with_noise_problem_of(&[], of)
    }

    /// The same without the unknowns at some places.
    fn with_noise_problem_of<R>(
        &self,
        absent: &[usize],
        of: impl FnOnce(&NoiseProblem<'_>) -> Result<R, PlantError>,
    ) -> Result<R, PlantError> {
        of(&NoiseProblem {
            problem: &self.problem,
            lin: &self.solution.lin,
            lines: &self.lines(),
            sigmas: &self.problem.sigmas(&self.extension),
            values: &self.solution.at.values,
            points: self.points(),
            absent,
        })
    }

    /// The same model in other noise.
    pub(crate) fn in_noise(&self, noise: FittedNoise) -> Result<Self, PlantError> {
        self.solved(&self.extension, noise, self.solution.at.clone())
    }

    /// The same model fitted to a record of the same rows.
    pub(crate) fn on_record(&self, record: PlantRecord) -> Result<Self, PlantError> {
        let problem = Problem {
            record: Arc::new(record),
            ..(*self.problem).clone()
        };
        let solver = Solver::new(&problem, &self.extension, self.noise.clone());
        let solution = solver.solve(self.solution.at.clone())?;
        let (extension, noise) = (self.extension.clone(), self.noise.clone());
        let starts = self.starts;
        Ok(Self::of(
            Arc::new(problem),
            extension,
            noise,
            solution,
            starts,
        ))
    }

    fn further(&self, columns: &[Column]) -> Vec<Column> {
        let (states, steps) = self.problem.shape();
        let lines = columns.iter();
        lines
            .map(|column| of_search(column, states, steps, &self.problem.record.starts))
            .collect()
    }

    fn solved(
        &self,
        extension: &ModelExtension,
        noise: FittedNoise,
        start: Iterate,
    ) -> Result<Self, PlantError> {
        let solver = Solver::new(&self.problem, extension, noise.clone());
        // A rival that steps on the trajectory do not reach keeps its score, unless the model itself needed others, or
        // bends.
        let mut own = extension.parameters.iter();
        let bends = own.any(|(parameter, _)| self.problem.sigma_of_knee(*parameter).is_some());
        let mut solution = if self.solution.is_damped || bends || !noise.is_declared() {
            solver.solve(start)?
        } else {
            solver.on_trajectory(start)?
        };
        solution.is_damped |= self.solution.is_damped;
        let problem = Arc::clone(&self.problem);
        let starts = self.starts;
        Ok(Self::of(
            problem,
            extension.clone(),
            noise,
            solution,
            starts,
        ))
    }

    /// Values of the initial states of later records, and their standard deviations before the records.
    fn later(&self) -> (&[f64], Vec<f64>) {
        let all = &self.solution.at.values;
        let sigmas = self.problem.sigmas(&self.extension);
        let first = all.len() - self.problem.later();
        (&all[first..], sigmas[first..].to_vec())
    }

    /// Initial states of each record with their standard deviations.
    #[must_use]
    pub fn initial_states(&self) -> Vec<Vec<[f64; 2]>> {
        let description = &self.problem.plant.description;
        let states = description.states.len();
        let solution = &self.solution;
        let later = solution.at.values.len() - self.problem.later();
        let firsts = core::iter::once(0).chain((later..solution.at.values.len()).step_by(states));
        firsts
            .map(|first| {
                let declared = description.states.iter().zip(first..);
                declared
                    .map(|(state, place)| {
                        let value = state.initial + solution.at.values[place];
                        [value, solution.covariance[(place, place)].sqrt()]
                    })
                    .collect()
            })
            .collect()
    }

    /// The Gram matrix of some lines, with the initial states of later records eliminated.
    pub(crate) fn shared_gram(&self, mut lines: Vec<Column>) -> Result<DMatrix<f64>, PlantError> {
        lines.extend(self.problem.later_starts());
        let (values, sigmas) = self.later();
        eliminated(self.gram(&lines)?, values, &sigmas)
    }

    /// Value of an unknown of another extension in this fit.
    fn start_of(&self, extension: &ModelExtension) -> Iterate {
        let (nominal, at) = (self.problem.nominal(), &self.solution.at);
        let mut values = at.values[..nominal].to_vec();
        let before = &self.extension;
        for (parameter, _) in &extension.parameters {
            let mut own = before.parameters.iter();
            let known = own.position(|(other, _)| other == parameter);
            values.push(known.map_or(0.0, |known| at.values[nominal + known]));
        }
        let first = nominal + before.parameters.len();
        for column in extension.columns.columns() {
            let mut own = before.columns.columns().iter();
            let known = own.position(|other| other == column);
            values.push(known.map_or(0.0, |known| at.values[first + known]));
        }
        values.extend_from_slice(self.later().0);
        Iterate {
            points: at.points.clone(),
            values,
        }
    }

    /// Noise as the search knows it: entries of the rates stay one, the unknowns of the noise follow.
    fn as_rate_noise(&self, noise: &FittedNoise) -> RateNoise {
        let rates = self.plant().rates.len();
        let mut white = vec![1.0; rates];
        white.extend(noise.unknowns());
        RateNoise {
            walk: vec![0.0; white.len()],
            white,
        }
    }
}

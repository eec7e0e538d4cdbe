//! A fitted plant as the search sees it.

use gyrocal_hypothesis::{
    Column, Covariate, FittedModel, ModelExtension, Plant, RateNoise, RateNoiseFit, StateJump,
};
use nalgebra::{DMatrix, DVector};

use super::FittedPlant;
use crate::correlation::{inflation, of_output};
use crate::error::PlantError;
use crate::lines::of_parameters;
use crate::solve::Solver;

/// Smallest range of a covariate that a dependence on it is looked for over, as a share of its size.
const LEAST_RANGE: f64 = 1e-6;

impl FittedModel for FittedPlant {
    type Error = PlantError;

    fn plant(&self) -> &'static Plant {
        self.problem.plant.tables()
    }

    fn extension(&self) -> &ModelExtension {
        &self.extension
    }

    fn covariates(&self) -> Vec<Covariate> {
        let description = &self.problem.plant.description;
        let (n, u) = (description.states.len(), description.inputs.len());
        let names = &self.problem.plant.catalogue.covariates;
        let all = names.iter().enumerate().map(|(index, name)| {
            let (from, place, count) = if index < n {
                (self.points(), index, n)
            } else {
                (&self.problem.record.inputs[..], index - n, u)
            };
            let values: Vec<f64> = from.iter().skip(place).step_by(count).copied().collect();
            let size = values
                .iter()
                .fold(0.0, |most: f64, value| most.max(value.abs()));
            Covariate {
                name,
                least_range: LEAST_RANGE * size,
                values,
            }
        });
        all.collect()
    }

    fn values(&self) -> &[f64] {
        let all = &self.solution.at.values;
        &all[..all.len() - self.problem.later()]
    }

    fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    fn prior_sigma(&self) -> Vec<f64> {
        let mut all = self.problem.sigmas(&self.extension);
        all.truncate(all.len() - self.problem.later());
        all
    }

    fn cost(&self) -> f64 {
        self.solution.cost
    }

    fn refitted(&self, extension: &ModelExtension) -> Result<Self, PlantError> {
        let mut start = self.start_of(extension);
        let solver = Solver::new(&self.problem, extension, self.noise.clone());
        let mut new = solver.searched();
        new.retain(|place| *place >= self.problem.nominal() && start.values[*place] == 0.0);
        start.values = solver.with_first_values(&start.values, &new);
        self.solved(extension, self.noise.clone(), start)
    }

    fn rate_noise(&self) -> RateNoise {
        self.as_rate_noise(&self.noise)
    }

    fn fit_rate_noise(
        &self,
        _walking: &[usize],
        absent: &[usize],
    ) -> Result<RateNoiseFit, PlantError> {
        let fit = self.with_noise_problem_of(absent, |unknown| unknown.maximise(&self.noise))?;
        let rates = self.plant().rates.len();
        // Scores of different channels are compared as they are: see `RateNoiseFit::white_sigma`, whose
        // degrees of freedom would correct those of rates alone.
        let mut white_sigma = vec![f64::INFINITY; rates];
        white_sigma.extend_from_slice(&fit.sigmas);
        white_sigma.resize(rates + fit.noise.unknowns().len(), f64::INFINITY);
        Ok(RateNoiseFit {
            noise: self.as_rate_noise(&fit.noise),
            log_likelihood: fit.log_likelihood,
            walk_sigma: vec![f64::INFINITY; white_sigma.len()],
            white_sigma,
        })
    }

    fn walk_intervals(&self) -> Result<Vec<Option<[f64; 2]>>, PlantError> {
        Ok(Vec::new())
    }

    fn with_rate_noise(&self, noise: &RateNoise) -> Result<Self, PlantError> {
        let rates = self.plant().rates.len();
        let noise = self.noise.with_unknowns(&noise.white[rates..]);
        self.in_noise(noise)
    }

    fn sets_need_fits(&self) -> bool {
        true
    }

    fn inflation(&self) -> Result<f64, PlantError> {
        let whitened = self.whitened()?;
        let outputs = 0..self.loaded().description.outputs.len();
        let each = outputs.map(|output| inflation(&of_output(&whitened, output)));
        Ok(each.fold(1.0, f64::max))
    }

    fn signatures_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, PlantError> {
        let all: Vec<usize> = (0..self.plant().parameters.len()).collect();
        let problem = &self.problem;
        let mut lines = of_parameters(
            &problem.plant,
            (&problem.record, &problem.rows),
            &self.extension,
            &all,
        );
        lines.extend(problem.columns(&self.extension));
        lines.extend(self.further(further));
        self.shared_gram(lines)
    }

    fn conditional_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, PlantError> {
        let mut lines = self.lines();
        lines.truncate(lines.len() - self.problem.later());
        lines.extend(self.further(further));
        self.shared_gram(lines)
    }

    fn state_jumps(&self) -> Result<Vec<Option<StateJump>>, PlantError> {
        let lines = self.lines();
        let (lin, covariance) = (&self.solution.lin, &self.solution.covariance);
        let n = lin.rows.layout.states;
        let mut jumps = vec![None; self.record().len()];
        lin.pass(&self.noise, &lines).jumps(|row, found| {
            let cross = DMatrix::from_fn(lines.len(), n, |i, j| found.columns[i + 1][j]);
            let projected = cross.tr_mul(&(covariance * &cross));
            jumps[row] = Some(StateJump {
                score: DVector::from_row_slice(&found.columns[0]),
                information: DMatrix::from_row_slice(n, n, &found.information) - projected,
                outputs: DVector::from_row_slice(&found.readings),
            });
        })?;
        // The states that a record begins with are free.
        for start in &self.record().starts {
            jumps[*start] = None;
        }
        Ok(jumps)
    }
}

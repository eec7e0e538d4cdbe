//! A later record predicted by a fit: the density of its outputs with the uncertainty of all parameters, and
//! errors of simulations over a horizon.

use core::ops::Range;
use std::sync::Arc;

use gyrocal_answer::OutputError;
use gyrocal_hypothesis::FittedModel as _;
use gyrocal_inference::Column;
use gyrocal_statistics::math::ln;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::catalogue::Modulation;
use crate::description::{Kind, State};
use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::linearised::reduce;
use crate::lines::{Course, initial, of_parameters, parameters_of, profile};
use crate::loaded::LoadedPlant;
use crate::play;
use crate::problem::Problem;
use crate::record::PlantRecord;
use crate::simulation::{one_step, rms, squares};
use crate::solve::{Iterate, Solver};
use crate::starts::led_by;

/// Rows of a simulation of a plant whose rates have noise; others are simulated over the whole record.
const HORIZON_ROWS: usize = 50;

/// Standard deviation of an initial state of which nothing is known, over its size.
const WIDE: f64 = 100.0;

/// Standard deviation of an initial state before a record, finite where nothing is known of it.
pub(crate) fn least_prior(state: &State, sigma: f64) -> f64 {
    sigma.min(WIDE * state.initial.abs().max(1.0))
}

/// Prediction of a later record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Prediction {
    /// Logarithm of the density of the outputs.
    pub(crate) log_density: f64,
    /// Simulated outputs, by rows.
    pub(crate) simulated: Vec<f64>,
    /// The same one step ahead: see [`FittedPlant::one_step`].
    pub(crate) one_step: Vec<f64>,
}

/// Rows that simulations go over; they begin anew with each record.
fn horizon_rows(plant: &LoadedPlant, rows: usize) -> usize {
    if plant.description.noises.is_empty() {
        rows
    } else {
        HORIZON_ROWS.min(rows)
    }
}

/// Time that simulations go over, s.
pub(crate) fn horizon_s(plant: &LoadedPlant, record: &PlantRecord) -> f64 {
    let horizon = horizon_rows(plant, record.len());
    if horizon == record.len() {
        return record.longest_s();
    }
    record.time_s[horizon - 1] - record.time_s[0]
}

/// Errors of simulations by the nominal and the extended model over some rows.
pub(crate) fn errors(
    plant: &LoadedPlant,
    record: &PlantRecord,
    (nominal, extended): (&[f64], &[f64]),
    rows: Range<usize>,
) -> Vec<OutputError> {
    let outputs = plant.description.outputs.iter().enumerate();
    let all = outputs.map(|(index, output)| {
        let of = |simulated| {
            let rms = rms(&[squares(record, simulated, index, rows.clone())]);
            Some(rms).filter(|rms| rms.is_finite())
        };
        OutputError {
            output: output.id.clone(),
            unit: output.unit.clone(),
            nominal: of(nominal),
            extended: of(extended),
        }
    });
    all.collect()
}

impl FittedPlant {
    /// Outputs of this record in simulations over the horizon, by rows.
    #[must_use]
    pub fn simulated(&self) -> Vec<f64> {
        let solver = Solver::new(&self.problem, self.extension(), self.noise.clone());
        let course = solver.course(&self.solution.at.values);
        simulated(&self.problem, &course, self.points())
    }

    /// The lines of effects and parameters in a later record, with their values, and the rows of this
    /// fit's covariance that they have.
    fn carried(&self, later: &PlantRecord) -> Vec<(Column, usize)> {
        let plant = &self.problem.plant;
        let states = plant.description.states.len();
        let nominal = states..self.problem.nominal();
        let own = self.extension().parameters.iter();
        let parameters = nominal.chain(own.map(|(parameter, _)| *parameter));
        let carried = parameters.zip(states..);
        carried
            .filter_map(|(parameter, place)| Some((self.in_later(parameter, later)?, place)))
            .collect()
    }

    /// What a parameter of the model, by its index in the table of the plant, is in a later record; `None` of an
    /// initial state.
    pub(crate) fn in_later(&self, parameter: usize, later: &PlantRecord) -> Option<Column> {
        let plant = &self.problem.plant;
        let parameter = parameter.checked_sub(plant.description.states.len())?;
        match parameter.checked_sub(plant.functions.sizes().parameters) {
            None => Some(Column::Parameter { parameter }),
            Some(modulated) => self.later_line(modulated, later),
        }
    }

    /// What a function of time is in a later record: a step stays, a drift stays where it was, and a
    /// regressor goes on.
    fn later_line(&self, modulated: usize, later: &PlantRecord) -> Option<Column> {
        let plant = &self.problem.plant;
        let own = plant.catalogue.modulated[modulated];
        if let Modulation::Play(input) = own.course {
            let inputs = &plant.description.inputs;
            let steps = play::steps(later, (inputs.len(), input), inputs[input].interpolate);
            return Some(profile(own.of, steps));
        }
        let effects = plant.description.effects.iter();
        let mut of_time = effects.filter(|effect| !effect.kind.is_of_the_model());
        let kind = of_time.nth(modulated)?.kind;
        let rows = later.len();
        let steps: Vec<f64> = match kind {
            // With each of several records a drift begins anew.
            Kind::Ramp if !self.record().starts.is_empty() => {
                let (scale, first_s) = (self.record().search_scale(), later.time_s[0]);
                let times = later.time_s.iter();
                times
                    .map(|time_s| scale * (time_s - first_s) / 3600.0)
                    .collect()
            }
            Kind::Ramp => {
                let hours = self.problem.rows.duration_s() / 3600.0;
                vec![hours; rows]
            }
            // A change stays, but not beyond the record that it happens in.
            Kind::Step if !self.acts_at_the_end(modulated) => vec![0.0; rows],
            Kind::Regressor(index) => {
                let means = (
                    self.record().regressor_means.get(index),
                    later.regressor_means.get(index),
                );
                let shift = match means {
                    (Some(first), Some(second)) => second - first,
                    _ => 0.0,
                };
                later.regressors[index]
                    .iter()
                    .map(|value| value + shift)
                    .collect()
            }
            _ => vec![1.0; rows],
        };
        Some(match own.output {
            Some(output) => Column::Output {
                output,
                change: steps.into(),
            },
            None => profile(own.of, steps.into()),
        })
    }

    /// Whether a function of time acts in the last step.
    fn acts_at_the_end(&self, modulated: usize) -> bool {
        if self.record().starts.is_empty() {
            return true;
        }
        let states = self.problem.plant.description.states.len();
        let parameters = states + self.problem.plant.functions.sizes().parameters + modulated;
        let lines = of_parameters(
            &self.problem.plant,
            (self.record(), &self.problem.rows),
            self.extension(),
            &[parameters],
        );
        lines.iter().any(|line| match line {
            Column::TimeProfile { steps, .. } | Column::Output { change: steps, .. } => {
                steps.last().is_some_and(|last| *last != 0.0)
            }
            _ => false,
        })
    }

    /// Prediction of a later record of the same plant, its initial states free.
    ///
    /// # Errors
    /// Those of a fit of its initial states.
    pub(crate) fn predict(&self, later: &Arc<PlantRecord>) -> Result<Prediction, PlantError> {
        let plant = &self.problem.plant;
        let n = plant.description.states.len();
        let problem = Problem::new(plant, Arc::clone(later), self.problem.substeps);
        let carried = self.carried(later);
        let mut base = Course::declared(plant);
        for (line, place) in &carried {
            base.add(line, self.values()[*place]);
        }
        let starts: Vec<Column> = (0..n).map(initial).collect();
        let carried_lines = carried.iter().map(|(line, _)| line.clone());
        let lines: Vec<Column> = starts.iter().cloned().chain(carried_lines).collect();
        let sigmas: Vec<f64> = problem.prior_sigma[..n]
            .iter()
            .zip(&plant.description.states)
            .map(|(sigma, state)| least_prior(state, *sigma))
            .collect();
        let solver = Solver {
            problem: &problem,
            lines: starts,
            sigmas: sigmas.clone(),
            noise: self.noise.clone(),
            base,
            parameters: parameters_of(&lines),
        };
        let solution = led_by(&solver, &self.state_sizes())?;
        let course = solver.course(&solution.at.values);
        let simulated = simulated(&problem, &course, &solution.at.points);
        let one_step = one_step(&solution.lin.pass(&solver.noise, &[]), later)?;
        let reduced = reduce(&solution.lin.pass(&solver.noise, &lines))?;
        let places: Vec<usize> = carried.iter().map(|(_, place)| *place).collect();
        let log_density = self
            .log_density(&reduced.gram, &solution.at, &sigmas, &places)
            .ok_or(PlantError::Singular)?
            - 0.5 * (reduced.log_variance + reduced.values as f64 * ln(core::f64::consts::TAU));
        Ok(Prediction {
            log_density,
            simulated,
            one_step,
        })
    }

    /// Sizes of the states in this record.
    fn state_sizes(&self) -> Vec<f64> {
        let n = self.problem.plant.description.states.len();
        let root = |index: usize| {
            let own = self.points().iter().skip(index).step_by(n);
            let squares: f64 = own.map(|value| value * value).sum();
            (squares / self.record().len() as f64).sqrt().max(1e-9)
        };
        (0..n).map(root).collect()
    }

    /// The part of a density that the Gram matrix gives, initial states and parameters integrated out.
    fn log_density(
        &self,
        gram: &DMatrix<f64>,
        at: &Iterate,
        sigmas: &[f64],
        places: &[usize],
    ) -> Option<f64> {
        let (n, count) = (sigmas.len(), gram.nrows() - 1);
        // Unknowns are a factor of their covariance times standard normal ones.
        let mut factor = DMatrix::zeros(count, count);
        for (i, sigma) in sigmas.iter().enumerate() {
            factor[(i, i)] = *sigma;
        }
        let own = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            self.covariance()[(places[i], places[j])]
        });
        let own = Cholesky::new(own)?.unpack();
        factor
            .view_mut((n, n), (places.len(), places.len()))
            .copy_from(&own);
        let information = gram.view((1, 1), (count, count)).into_owned();
        let mut inner = factor.tr_mul(&information) * &factor;
        for i in 0..count {
            inner[(i, i)] += 1.0;
        }
        let mut standard = DVector::zeros(count);
        for (i, sigma) in sigmas.iter().enumerate() {
            standard[i] = at.values[i] / sigma;
        }
        let score = DVector::from_fn(count, |i, _| -gram[(0, i + 1)]);
        let gradient = factor.tr_mul(&score) - &standard;
        let cholesky = Cholesky::new(inner)?;
        let gained = cholesky.solve(&gradient).dot(&gradient);
        let determinant: f64 = cholesky.l().diagonal().iter().map(|x| 2.0 * ln(*x)).sum();
        let cost = gram[(0, 0)] + standard.norm_squared() - gained;
        Some(-0.5 * (cost + determinant))
    }
}

/// Outputs of simulations from the trajectory over the horizon, by rows.
fn simulated(problem: &Problem, course: &Course, points: &[f64]) -> Vec<f64> {
    let n = problem.plant.description.states.len();
    let rows = problem.record.len();
    let horizon = horizon_rows(&problem.plant, rows);
    let (plant, record) = (&problem.plant, &problem.record);
    let mut dynamics = Dynamics::narrowed(plant, record, problem.substeps, (course, &[]));
    let mut all = Vec::with_capacity(problem.record.outputs.len());
    for first in (0..rows).step_by(horizon) {
        let mut here = points[first * n..(first + 1) * n].to_vec();
        for row in first..rows.min(first + horizon) {
            all.extend(dynamics.outputs(row, course, &here));
            if row + 1 < rows {
                here = dynamics.next(row, course, &here);
            }
        }
    }
    all
}

//! The best fit of a model by Gauss-Newton steps on trajectory, parameters and initial states.
//!
//! Points of the trajectory are unknowns of their own ("multiple shooting"): a model that one start leads
//! astray within a record, or that is unstable, is still led by its data at every row. What no noise
//! explains of a step is a defect, which a penalty larger than its multiplier removes.

mod damped;

use std::sync::OnceLock;

use gyrocal_hypothesis::{Column, ModelExtension};
use gyrocal_inference::Pass;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;
use crate::linearised::{Linearised, reduce};
use crate::lines::{Course, parameters_of};
use crate::problem::Problem;

/// Most Gauss-Newton steps.
const MAX_STEPS: usize = 200;

/// Most halvings of a step.
const MAX_HALVINGS: usize = 12;

/// Fall of the cost that a step promises below which it is not made: a score then differs from zero by less
/// than a ten-thousandth of its standard deviation.
const CONVERGED: f64 = 1e-8;

/// A fall that is enough after so many steps: at the kinks of a model (a level at its floor, a sign) steps
/// are many and short. A score then differs from zero by less than half a hundredth of its standard
/// deviation.
const ENOUGH: f64 = 1e-5;
const PATIENCE: usize = 15;

/// A fall below which a search along a step that finds none ends the fit, and that is enough after the last
/// step: rounding of a long record. A score then differs from zero by less than a twentieth of its standard
/// deviation.
const STALLED: f64 = 1e-3;

/// A penalty over the largest multiplier of its defects.
const PENALTY: f64 = 2.0;

/// Trajectory and unknowns of a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Iterate {
    pub(crate) points: Vec<f64>,
    pub(crate) values: Vec<f64>,
}

/// A best fit.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub(crate) at: Iterate,
    /// By the parameters of the model.
    pub(crate) lin: Linearised,
    /// By all parameters, once it is asked for.
    pub(crate) whole: OnceLock<Linearised>,
    /// Covariance of the unknowns.
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) cost: f64,
    /// Whether damped steps led to it.
    pub(crate) is_damped: bool,
}

/// A model to be fitted.
pub(crate) struct Solver<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) lines: Vec<Column>,
    pub(crate) sigmas: Vec<f64>,
    pub(crate) noise: FittedNoise,
    /// Parameters that the unknowns are added to.
    pub(crate) base: Course,
    /// Parameters that derivatives are taken by: those of the lines, in their order.
    pub(crate) parameters: Vec<usize>,
}

/// Normal equations.
struct Normal {
    information: DMatrix<f64>,
    /// Minus the derivative of half the cost.
    gradient: DVector<f64>,
    cost: f64,
}

/// A Gauss-Newton step.
struct Step {
    change: DVector<f64>,
    /// Cost at the end of the step if the model were linear.
    promised: f64,
    covariance: DMatrix<f64>,
    corrections: Vec<f64>,
    penalties: Vec<f64>,
}

impl<'a> Solver<'a> {
    pub(crate) fn new(
        problem: &'a Problem,
        extension: &ModelExtension,
        noise: FittedNoise,
    ) -> Self {
        let lines = problem.lines(extension);
        Self {
            problem,
            parameters: parameters_of(&lines),
            lines,
            sigmas: problem.sigmas(extension),
            noise,
            base: Course::declared(&problem.plant),
        }
    }

    /// The parameters along the record.
    pub(crate) fn course(&self, values: &[f64]) -> Course {
        let mut course = self.base.clone();
        for (line, value) in self.lines.iter().zip(values) {
            if *value != 0.0 {
                course.add(line, *value);
            }
        }
        course
    }

    /// The plant in this model.
    pub(crate) fn dynamics(&self) -> Dynamics<'a> {
        let problem = self.problem;
        Dynamics::narrowed(
            &problem.plant,
            &problem.record,
            problem.substeps,
            (&self.base, &self.parameters),
        )
    }

    /// Steps on trajectory and unknowns until none is promised to gain. Where these fail and the states have no noise,
    /// damped steps on simulations go on. Beside noise that the plant does not declare these serve alone: its states
    /// are no unknowns.
    pub(crate) fn solve(&self, start: Iterate) -> Result<Solution, PlantError> {
        let mut values = start.values.clone();
        values.resize(self.lines.len(), 0.0);
        if !self.noise.is_declared() && self.is_free() {
            return self.damped(&values);
        }
        match self.on_trajectory(start) {
            Err(PlantError::NoFit { .. } | PlantError::Singular) if self.is_free() => {
                self.damped(&values)
            }
            other => other,
        }
    }

    /// Without damped steps.
    pub(crate) fn on_trajectory(&self, start: Iterate) -> Result<Solution, PlantError> {
        let mut dynamics = self.dynamics();
        let mut at = start;
        at.values.resize(self.lines.len(), 0.0);
        for index in 0..=MAX_STEPS {
            let course = self.course(&at.values);
            let lin = dynamics.linearise(&course, &at.points)?;
            let step = self.step(&lin.pass(&self.noise, &self.lines), &at.values)?;
            let now = self.merit(
                &lin.rows.defects,
                &lin.rows.residuals,
                &lin,
                &at.values,
                &step.penalties,
            );
            let fall = now - 0.5 * step.promised;
            let enough = match index {
                MAX_STEPS => STALLED,
                PATIENCE.. => ENOUGH,
                _ => CONVERGED,
            };
            let next = if fall.abs() < enough {
                None
            } else {
                self.search(&mut dynamics, &lin, &at, &step, now)
            };
            match next {
                Some(next) => at = next,
                None if fall.abs() < STALLED => {
                    return Ok(Solution {
                        covariance: step.covariance,
                        cost: step.promised,
                        lin,
                        whole: OnceLock::new(),
                        is_damped: false,
                        at,
                    });
                }
                None => return Err(no_fit("no step lowers the residuals")),
            }
        }
        Err(no_fit("the steps do not end"))
    }

    fn step(&self, pass: &Pass<'_>, values: &[f64]) -> Result<Step, PlantError> {
        let Normal {
            information,
            gradient,
            cost,
        } = self.normal(pass, values)?;
        let cholesky = Cholesky::new(information).ok_or(PlantError::Singular)?;
        let change = cholesky.solve(&gradient);
        let smoothed = pass.smooth(change.as_slice())?;
        Ok(Step {
            promised: cost - change.dot(&gradient),
            covariance: cholesky.inverse(),
            corrections: smoothed.corrections,
            penalties: smoothed
                .multipliers
                .iter()
                .map(|most| PENALTY * most)
                .collect(),
            change,
        })
    }

    /// The normal equations of the unknowns at some values, their priors with them.
    fn normal(&self, pass: &Pass<'_>, values: &[f64]) -> Result<Normal, PlantError> {
        let gram = reduce(pass)?.gram;
        let count = values.len();
        let mut information = gram.view((1, 1), (count, count)).into_owned();
        let mut gradient = DVector::from_fn(count, |i, _| -gram[(0, i + 1)]);
        let mut cost = gram[(0, 0)];
        for (i, (sigma, value)) in self.sigmas.iter().zip(values).enumerate() {
            let weight = sigma.powi(-2);
            information[(i, i)] += weight;
            gradient[i] -= weight * value;
            cost += weight * value * value;
        }
        Ok(Normal {
            information,
            gradient,
            cost,
        })
    }

    /// The next iterate: the longest part of a step that lowers the cost.
    fn search(
        &self,
        dynamics: &mut Dynamics<'_>,
        lin: &Linearised,
        at: &Iterate,
        step: &Step,
        now: f64,
    ) -> Option<Iterate> {
        let mut share = 1.0;
        for _ in 0..MAX_HALVINGS {
            let moved = |(old, change): (&f64, &f64)| old + share * change;
            let values: Vec<f64> = at
                .values
                .iter()
                .zip(step.change.iter())
                .map(moved)
                .collect();
            let points: Vec<f64> = at.points.iter().zip(&step.corrections).map(moved).collect();
            let course = self.course(&values);
            let mut tried = vec![points];
            if self.is_free() {
                // Without noise a simulation is the trajectory, where it stays near.
                tried.push(dynamics.simulate(&course, &self.problem.initial(&values)));
            }
            let best = tried
                .into_iter()
                .map(|points| {
                    let (defects, residuals) = dynamics.differences(&course, &points);
                    let merit = self.merit(&defects, &residuals, lin, &values, &step.penalties);
                    (merit, points)
                })
                .filter(|(merit, _)| merit.is_finite())
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((merit, points)) = best
                && merit < now
            {
                return Some(Iterate { points, values });
            }
            share *= 0.5;
        }
        None
    }

    /// Half the cost of a trajectory, and the penalties of its defects.
    fn merit(
        &self,
        defects: &[f64],
        residuals: &[f64],
        lin: &Linearised,
        values: &[f64],
        penalties: &[f64],
    ) -> f64 {
        let factors = &self.noise.factors[..lin.rows.layout.outputs];
        let declared = residuals.iter().zip(&lin.rows.variances);
        let outputs = declared.zip(factors.iter().cycle());
        let mut cost: f64 = outputs
            .filter(|((residual, _), _)| !residual.is_nan())
            .map(|((residual, variance), factor)| residual * residual / (variance * factor))
            .sum();
        // A missing output is NaN in the record; a model that leaves the numbers is caught by its states.
        if !defects.iter().all(|defect| defect.is_finite()) {
            return f64::INFINITY;
        }
        cost += values
            .iter()
            .zip(&self.sigmas)
            .map(|(value, sigma)| (value / sigma).powi(2))
            .sum::<f64>();
        let n = penalties.len();
        let mut penalty = 0.0;
        for (row, defect) in defects.chunks_exact(n).enumerate() {
            let (own, left) = self.explained(lin, row, defect);
            cost += own;
            penalty += left
                .iter()
                .zip(penalties)
                .map(|(left, penalty)| left.abs() * penalty)
                .sum::<f64>();
        }
        0.5 * cost + penalty
    }

    /// The cost of the noise that explains a defect best, and what it leaves.
    fn explained(&self, lin: &Linearised, row: usize, defect: &[f64]) -> (f64, Vec<f64>) {
        let (n, w) = (defect.len(), lin.rows.layout.noises);
        let factors = &self.noise.factors[lin.rows.layout.outputs..];
        let by_noises = DMatrix::from_row_slice(n, w, &lin.by_noises[row * n * w..][..n * w]);
        let defect = DVector::from_row_slice(defect);
        if !self.noise.loose.is_empty() {
            let loose = DVector::from_row_slice(&self.noise.loose);
            let mut covariance = DMatrix::from_diagonal(&loose);
            for (own, factor) in by_noises.column_iter().zip(factors) {
                covariance.ger(*factor, &own, &own, 1.0);
            }
            let cost = Cholesky::new(covariance).map_or(f64::INFINITY, |cholesky| {
                cholesky.solve(&defect).dot(&defect)
            });
            return (cost, vec![0.0; n]);
        }
        // No noise leads from one record to the next.
        if by_noises.iter().all(|by| *by == 0.0) {
            return (0.0, defect.as_slice().to_vec());
        }
        let Some(cholesky) = Cholesky::new(by_noises.tr_mul(&by_noises)) else {
            return (f64::INFINITY, vec![0.0; n]);
        };
        let noise = cholesky.solve(&by_noises.tr_mul(&defect));
        let cost = noise
            .iter()
            .zip(factors)
            .map(|(noise, factor)| noise * noise / factor)
            .sum();
        let left = defect - by_noises * noise;
        (cost, left.as_slice().to_vec())
    }
}

fn no_fit(reason: &str) -> PlantError {
    PlantError::NoFit {
        reason: reason.to_owned(),
        reached: None,
    }
}

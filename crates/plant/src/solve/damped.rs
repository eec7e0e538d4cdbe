//! The fit of a plant without noise by damped steps on simulations (Levenberg, Marquardt): from where steps on
//! trajectories do not lower the cost, or a record does not determine all unknowns.

use std::sync::OnceLock;

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use super::{CONVERGED, ENOUGH, Iterate, Normal, PATIENCE, STALLED, Solution, Solver};
use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::linearised::Linearised;

/// Most steps.
const MAX_STEPS: usize = 100;

/// First damping, its changes after a step that fails and one that does not, and the largest that is tried.
const FIRST: f64 = 1e-3;
const MORE: f64 = 8.0;
const LESS: f64 = 0.1;
const MOST: f64 = 1e12;

/// Least weight of an unknown in the damping over the largest.
const FLOOR: f64 = 1e-10;

/// Longest step of a parameter, over its declared value or the present one.
const LONGEST: f64 = 2.0;

/// Information along a direction over the largest, scaled, below which there is none.
const NONE: f64 = 1e-12;

/// A fall that ends the fit where no step gains, beside process noise and of a model whose knee is estimated: the
/// covariance of the innovations moves with the trajectory, and a row that passes the knee bends the cost, which the
/// steps do not know. A score then differs from zero by less than half its standard deviation,
/// and those of effects are taken with the parameters free.
const STALLED_ROUGH: f64 = 0.1;

/// Share of the cost that rounding of a long record moves.
const ROUNDING: f64 = 1e-12;

/// The linearised problem at some values, by simulation.
struct At {
    iterate: Iterate,
    lin: Linearised,
    normal: Normal,
}

impl Solver<'_> {
    /// Whether the states have no noise, so that a simulation is the trajectory.
    pub(super) fn is_free(&self) -> bool {
        self.problem.plant.description.noises.is_empty() && self.noise.loose.is_empty()
    }

    /// Whether a knee is among the unknowns.
    fn bends(&self) -> bool {
        let knees = &self.problem.plant.description.knees;
        let mut own = self.parameters.iter();
        own.any(|own| knees.iter().any(|knee| knee.constant == *own))
    }

    /// From some values, until no step gains.
    pub(super) fn damped(&self, values: &[f64]) -> Result<Solution, PlantError> {
        let mut dynamics = self.dynamics();
        let mut at = self.simulated(&mut dynamics, values)?;
        let mut damping = FIRST;
        let stalled = if self.noise.process.is_empty() && !self.bends() {
            STALLED
        } else {
            STALLED_ROUGH
        };
        for index in 0..MAX_STEPS {
            let promised =
                0.5 * solved(&at.normal.information, &at.normal.gradient).dot(&at.normal.gradient);
            let enough = if index < PATIENCE { CONVERGED } else { ENOUGH };
            if promised < enough.max(ROUNDING * at.normal.cost) {
                return Ok(self.found(at));
            }
            let weights = weights(&at.normal.information);
            let next = loop {
                if damping > MOST {
                    break None;
                }
                let mut damped = at.normal.information.clone();
                for (i, weight) in weights.iter().enumerate() {
                    damped[(i, i)] += damping * weight;
                }
                let step =
                    Cholesky::new(damped).map(|cholesky| cholesky.solve(&at.normal.gradient));
                let moved = step.and_then(|step| {
                    let values = self.moved(&at.iterate.values, &step);
                    self.simulated(&mut dynamics, &values).ok()
                });
                if let Some(moved) = moved.filter(|moved| moved.normal.cost < at.normal.cost) {
                    damping *= LESS;
                    break Some(moved);
                }
                damping *= MORE;
            };
            match next {
                Some(next) => at = next,
                None if promised < stalled => return Ok(self.found(at)),
                None => return Err(ended("no step lowers the residuals", at)),
            }
        }
        Err(ended("the steps do not end", at))
    }

    /// Values after a step, no parameter by more than [`LONGEST`].
    fn moved(&self, values: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let description = &self.problem.plant.description;
        let first = description.states.len();
        let mut share: f64 = 1.0;
        for (index, own) in description.parameters.iter().enumerate() {
            let (Some(value), Some(change)) = (values.get(first + index), step.get(first + index))
            else {
                break;
            };
            let size = own.value.abs().max((own.value + value).abs());
            if size > 0.0 && change.abs() > LONGEST * size {
                share = share.min(LONGEST * size / change.abs());
            }
        }
        let pairs = values.iter().zip(step.iter());
        pairs
            .map(|(value, change)| value + share * change)
            .collect()
    }

    fn simulated(&self, dynamics: &mut Dynamics<'_>, values: &[f64]) -> Result<At, PlantError> {
        let course = self.course(values);
        let points = dynamics.simulate(&course, &self.problem.initial(values));
        if let Some(place) = points.iter().position(|value| !value.is_finite()) {
            let row = place / self.problem.plant.description.states.len().max(1);
            return Err(PlantError::NotFinite { row });
        }
        let lin = dynamics.linearise(&course, &points)?;
        let normal = self.normal(&lin.pass(&self.noise, &self.lines), values)?;
        Ok(At {
            iterate: Iterate {
                points,
                values: values.to_vec(),
            },
            lin,
            normal,
        })
    }

    /// The cost that the linear model about a simulation promises; `None` if that leaves the numbers.
    pub(crate) fn promised(&self, values: &[f64]) -> Option<f64> {
        let normal = self.simulated(&mut self.dynamics(), values).ok()?.normal;
        let gained = solved(&normal.information, &normal.gradient).dot(&normal.gradient);
        Some(normal.cost - gained).filter(|cost| cost.is_finite())
    }

    fn found(&self, at: At) -> Solution {
        let change = solved(&at.normal.information, &at.normal.gradient);
        Solution {
            covariance: inverse(&at.normal.information),
            cost: at.normal.cost - change.dot(&at.normal.gradient),
            lin: at.lin,
            whole: OnceLock::new(),
            is_damped: true,
            at: at.iterate,
        }
    }
}

/// A fit that ended before the least cost.
fn ended(reason: &str, at: At) -> PlantError {
    PlantError::NoFit {
        reason: reason.to_owned(),
        reached: Some(Box::new((at.normal.cost, at.iterate.values))),
    }
}

/// Weights of the unknowns in the damping: their information.
fn weights(information: &DMatrix<f64>) -> DVector<f64> {
    let diagonal = information.diagonal();
    let floor = FLOOR * diagonal.max();
    diagonal.map(|own| own.max(floor))
}

/// The step without damping.
fn solved(information: &DMatrix<f64>, gradient: &DVector<f64>) -> DVector<f64> {
    match Cholesky::new(information.clone()) {
        Some(cholesky) => cholesky.solve(gradient),
        None => inverse(information) * gradient,
    }
}

/// The inverse, in which directions without information stay where they are.
pub(super) fn inverse(information: &DMatrix<f64>) -> DMatrix<f64> {
    let scales = information
        .diagonal()
        .map(|own| if own > 0.0 { own.sqrt().recip() } else { 0.0 });
    let scaled = DMatrix::from_fn(information.nrows(), information.ncols(), |i, j| {
        scales[i] * information[(i, j)] * scales[j]
    });
    let eigen = SymmetricEigen::new(scaled);
    let most = eigen.eigenvalues.max();
    let mut inverse = DMatrix::zeros(information.nrows(), information.ncols());
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > NONE * most {
            let own = vector.component_mul(&scales);
            inverse.ger(value.recip(), &own, &own, 1.0);
        }
    }
    inverse
}

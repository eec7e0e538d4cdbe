//! Gauss-Newton on the trajectories of several records and the parameters they share.

#[cfg(test)]
mod failures;

use std::sync::Arc;

use gyrocal::estimation::batch::{Linearisation, Manifold, Tape};
use gyrocal::trajectory::{Orientation, turned};
use gyrocal::{Chart, EstimationError};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::problem::Problem;
use crate::run::Conditions;

/// Rows of a record whose steps are kept between passes, some 500 bytes each.
const LONGEST_TAPE: usize = 400_000;

/// Steps are halved at most so often when they do not lower the cost.
const MOST_HALVINGS: usize = 12;

/// The step is the last one if it is shorter than this, in standard deviations of the whole
/// problem: what is left after it is smaller by the curvature of a chart over such a step.
const LAST_STEP: f64 = 1e-4;

/// The same for records that the model does not fit, as a share of the root of the cost: a
/// shorter step lowers the cost by less than rounding of its sum does.
const LAST_SHARE: f64 = 1e-6;

/// A step this short, as a share of the root of the cost, from which no shorter one lowers the cost
/// ends the search too. Far from all noise the gradient of the linear problem is not that of the
/// cost to the last digits, and it is the cost that has a minimum: the step would have lowered it by
/// a part in 1e10.
const FLAT_SHARE: f64 = 1e-5;

/// What the records say, linearised about the solution.
#[derive(Clone)]
pub(crate) struct Solution {
    /// Information of the records on all unknowns, without their priors.
    pub(crate) information: DMatrix<f64>,
    /// Twice the cost: sum of squares of everything over its variance.
    pub(crate) cost: f64,
    pub(crate) values: usize,
    pub(crate) rows: usize,
    pub(crate) log_variance: f64,
    /// What the model gave in the last pass over each record, if it was short enough to keep.
    pub(crate) tapes: Vec<Option<Arc<Tape<3>>>>,
    /// Passes that were made.
    pub(crate) iterations: usize,
}

/// Why there is no solution.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A pass could not be made over the record of this number.
    Pass(usize, EstimationError),
    /// No shortened step lowered the cost.
    NoDescent { iterations: usize },
    /// Too many steps.
    NotConverged { iterations: usize, last_step: f64 },
    /// Information plus prior is not positive definite.
    Singular,
}

/// The problem linearised where it stands.
struct Point {
    /// Of residual and unknowns: sums over the records.
    gram: DMatrix<f64>,
    trajectory_cost: f64,
    values: usize,
    rows: usize,
    log_variance: f64,
    tapes: Vec<Option<Arc<Tape<3>>>>,
}

/// A step from a point.
struct Step {
    values: DVector<f64>,
    corrections: Vec<Vec<[f64; 3]>>,
    length: f64,
}

impl<D, I> Problem<'_, D, I>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    /// Iterates to convergence, in at most `most_iterations` steps. `progress` is called after
    /// each.
    pub(crate) fn solve(
        &mut self,
        most_iterations: usize,
        mut progress: impl FnMut(usize),
    ) -> Result<Solution, Failure> {
        let mut point = self.linearise()?;
        let mut cost = point.trajectory_cost + self.prior_cost();
        let mut iterations = 0;
        loop {
            let step = self.step(&point)?;
            iterations += 1;
            let last = step.length < LAST_STEP.max(LAST_SHARE * cost.sqrt());
            // Long records: the steps of one point at a time.
            point.tapes.clear();
            let before: Vec<_> = self.legs.iter().map(|leg| leg.points.clone()).collect();
            let values = self.values.clone();
            let mut share = 1.0;
            let mut halvings = 0;
            loop {
                self.take(&before, &values, &step, share);
                let moved = self.linearise();
                // A model may leave its domain on the way: that step was too long.
                if let Ok(moved) = moved {
                    let moved_cost = moved.trajectory_cost + self.prior_cost();
                    // The last step changes the cost by less than rounding does.
                    if moved_cost <= cost || last {
                        (point, cost) = (moved, moved_cost);
                        break;
                    }
                } else if halvings == MOST_HALVINGS {
                    return Err(moved.err().unwrap_or(Failure::Singular));
                }
                if halvings == MOST_HALVINGS {
                    if step.length > FLAT_SHARE * cost.sqrt() {
                        return Err(Failure::NoDescent { iterations });
                    }
                    self.take(&before, &values, &step, 0.0);
                    return Ok(self.solution(self.linearise()?, iterations));
                }
                halvings += 1;
                share *= 0.5;
            }
            progress(iterations);
            if last {
                return Ok(self.solution(point, iterations));
            }
            if iterations == most_iterations {
                return Err(Failure::NotConverged {
                    iterations,
                    last_step: step.length,
                });
            }
        }
    }

    fn linearise(&self) -> Result<Point, Failure> {
        let size = self.unknowns.len() + 1;
        let mut point = Point {
            gram: DMatrix::zeros(size, size),
            trajectory_cost: 0.0,
            values: 0,
            rows: 0,
            log_variance: 0.0,
            tapes: Vec::with_capacity(self.legs.len()),
        };
        for (index, leg) in self.legs.iter().enumerate() {
            let parameters = self.parameters(index);
            let (reduced, tape) = self
                .with_leg(index, &parameters, |pass| {
                    if leg.points.len() > LONGEST_TAPE {
                        return pass.reduce(|_| ()).map(|reduced| (reduced, None));
                    }
                    let (reduced, tape) = pass.reduce_and_keep(|_| ())?;
                    Ok((reduced, Some(Arc::new(tape))))
                })
                .map_err(|error| Failure::Pass(index, error))?;
            point.trajectory_cost += reduced.trajectory_cost;
            point.values += reduced.values;
            point.rows += reduced.rows;
            point.log_variance += reduced.log_variance;
            add_gram(&mut point.gram, &reduced.gram, &leg.columns());
            point.tapes.push(tape);
        }
        Ok(point)
    }

    /// The Gauss-Newton step.
    fn step(&self, point: &Point) -> Result<Step, Failure> {
        let estimated = self.estimated();
        let count = estimated.len();
        let mut information = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        for (i, a) in estimated.iter().enumerate() {
            let unknown = &self.unknowns[*a];
            let weight = unknown.sigma.powi(-2);
            // Columns are derivatives of the innovations, hence the sign.
            gradient[i] = -point.gram[(a + 1, 0)] + weight * (unknown.prior - self.values[*a]);
            for (j, b) in estimated.iter().enumerate() {
                information[(i, j)] = point.gram[(a + 1, b + 1)];
            }
            information[(i, i)] += weight;
        }
        let cholesky = Cholesky::new(information).ok_or(Failure::Singular)?;
        let change = cholesky.solve(&gradient);
        // Cost of the trajectory now, less the least cost of the linear problem.
        let decrease = point.trajectory_cost - point.gram[(0, 0)] + change.dot(&gradient);
        let mut values = DVector::zeros(self.unknowns.len());
        for (a, change) in estimated.iter().zip(change.iter()) {
            values[*a] = *change;
        }
        let corrections = (0..self.legs.len())
            .map(|index| {
                let parameters = self.parameters(index);
                let change: Vec<f64> = self.legs[index]
                    .columns()
                    .iter()
                    .map(|unknowns| unknowns.iter().map(|unknown| values[*unknown]).sum())
                    .collect();
                self.with_leg(index, &parameters, |pass| {
                    let tape = point.tapes[index].as_deref();
                    Linearisation { tape, ..*pass }.smooth(&change)
                })
                .map(|smoothed| smoothed.corrections)
                .map_err(|error| Failure::Pass(index, error))
            })
            .collect::<Result<_, _>>()?;
        Ok(Step {
            values,
            corrections,
            length: decrease.max(0.0).sqrt(),
        })
    }

    fn take(&mut self, before: &[Vec<Orientation>], values: &[f64], step: &Step, share: f64) {
        for (value, (before, change)) in self
            .values
            .iter_mut()
            .zip(values.iter().zip(step.values.iter()))
        {
            *value = before + share * change;
        }
        for leg in &mut self.legs {
            let amplitudes = leg.amplitudes.iter().map(|unknown| self.values[*unknown]);
            leg.further.set_amplitudes(amplitudes);
        }
        for (leg, (before, corrections)) in self
            .legs
            .iter_mut()
            .zip(before.iter().zip(&step.corrections))
        {
            for (point, (before, correction)) in
                leg.points.iter_mut().zip(before.iter().zip(corrections))
            {
                *point = turned(before, &correction.map(|angle| share * angle));
            }
        }
    }

    fn solution(&self, point: Point, iterations: usize) -> Solution {
        let count = self.unknowns.len();
        Solution {
            information: point.gram.view((1, 1), (count, count)).into_owned(),
            cost: point.trajectory_cost + self.prior_cost(),
            values: point.values,
            rows: point.rows,
            log_variance: point.log_variance,
            tapes: point.tapes,
            iterations,
        }
    }
}

/// Adds a record's Gram matrix, whose columns are the model's parameters, to that of the unknowns.
pub(crate) fn add_gram(total: &mut DMatrix<f64>, gram: &DMatrix<f64>, sums: &[&[usize]]) {
    let size = sums.len() + 1;
    // Column 0 is the residual in both.
    let targets = |column: usize| -> Vec<usize> {
        match column.checked_sub(1) {
            None => vec![0],
            Some(parameter) => sums[parameter].iter().map(|unknown| unknown + 1).collect(),
        }
    };
    let targets: Vec<Vec<usize>> = (0..size).map(targets).collect();
    for i in 0..size {
        for j in 0..size {
            for a in &targets[i] {
                for b in &targets[j] {
                    total[(*a, *b)] += gram[(i, j)];
                }
            }
        }
    }
}

//! Gauss-Newton iteration on the trajectories of all records and the parameters that they share:
//! equations (3) to (6) of the [crate documentation](crate).

use std::sync::Arc;

use gyrocal::Chart;
use gyrocal::estimation::Manifold;
use gyrocal::trajectory::{Orientation, turned};
use gyrocal_inference::{KeptRecord, Smoothed};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::error::CalibrationError;
use crate::problem::Problem;
use crate::run::Conditions;

/// Passes over the records after which an estimate that still moves is given up: one for each step, and one
/// for each halving of it.
pub(crate) const MAX_PASSES: usize = 40;

/// The same of an estimate that starts from one of nearly the same model. Effects of some hundred standard
/// deviations need a dozen.
pub(crate) const MAX_PASSES_AGAIN: usize = 30;

/// Longest record that is kept linearised between passes, in rows of some 800 bytes each.
const LONGEST_KEPT: usize = 400_000;

/// Most halvings of a step that does not lower the cost.
const MAX_HALVINGS: usize = 12;

/// Length of a step, in standard deviations of the whole problem, below which it is the last one:
/// the error left after it is smaller by the curvature of a chart over such a step.
const LAST_STEP: f64 = 1e-4;

/// The same limit for records that the model does not fit, as a share of the root of the cost: a
/// shorter step lowers the cost by less than the rounding error of its sum.
const LAST_SHARE: f64 = 1e-6;

/// Length of a step, as a share of the root of the cost, below which the iteration ends if no
/// shortened step lowers the cost. Where residuals are far larger than the noise, the gradient of the
/// linearised problem differs from that of the cost in the last digits; such a step would lower the
/// cost by a part in 1e10.
const FLAT_SHARE: f64 = 1e-5;

/// The same length, in standard deviations of the whole problem: a hundredth of one changes no result. Along
/// directions that only the prior determines, as most are of a strapdown unit in one attitude, the slope of
/// the cost is smaller than the error of the linearised one.
const FLAT_STEP: f64 = 0.01;

/// Length of a step over that of the step before, above which steps shrink too slowly for the curvature of a
/// chart to be the cause: they then end at the flat length already.
const SLOW: f64 = 0.3;

/// Noise of the gyros over that of the fit in the stages of [`Problem::solve_in_stages`]. With the first the
/// trajectory follows the samples whatever the model lacks; from one to the next the minimum moves little.
const STAGES: [f64; 6] = [1e5, 1e4, 1e3, 100.0, 10.0, 3.0];

/// The records linearised about the solution.
#[derive(Clone)]
pub(crate) struct Solution {
    /// Information matrix of all unknowns from the records, priors not included.
    pub(crate) information: DMatrix<f64>,
    /// Gradient of half the records' cost by all unknowns, priors not included.
    pub(crate) gradient: DVector<f64>,
    /// Twice the cost (1): the sum of all squares over their variances.
    pub(crate) cost: f64,
    /// Number of accelerometer values used.
    pub(crate) values: usize,
    /// Number of rows with at least one of them.
    pub(crate) rows: usize,
    /// Sum of the logarithms of the innovation variances.
    pub(crate) log_variance: f64,
    /// Each record that is short enough, linearised about the solution.
    pub(crate) kept: Vec<Option<Arc<KeptRecord>>>,
    /// Gauss-Newton steps made.
    pub(crate) iterations: usize,
}

/// The problem linearised about its present values.
struct Linearised {
    /// Gram matrix (3) of residual and unknowns, summed over the records.
    gram: DMatrix<f64>,
    trajectory_cost: f64,
    values: usize,
    rows: usize,
    log_variance: f64,
    kept: Vec<Option<Arc<KeptRecord>>>,
}

/// A Gauss-Newton step.
struct Step {
    /// Change of every unknown.
    values: DVector<f64>,
    /// Correction of the attitude, rad, and of the walks at every row of every record.
    corrections: Vec<Smoothed>,
    /// Length (6), in standard deviations of the whole problem.
    length: f64,
}

impl<D, I> Problem<'_, D, I>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    /// The same as [`Self::solve`] with gyros of far more noise first, then less and less, each stage from the
    /// solution before it: of records that a large effect leads far from the start.
    pub(crate) fn solve_in_stages(
        &mut self,
        max_passes: usize,
    ) -> Result<Solution, CalibrationError> {
        let own: Vec<_> = self.runs.iter().map(|run| run.noise_density).collect();
        for ratio in STAGES {
            for (run, own) in self.runs.iter_mut().zip(&own) {
                run.noise_density = own.map(|density| ratio * ratio * density);
            }
            self.solve(max_passes)?;
        }
        for (run, own) in self.runs.iter_mut().zip(own) {
            run.noise_density = own;
        }
        self.solve(max_passes)
    }

    /// Iterates to convergence in at most `max_passes` passes; steps that do not lower the cost are halved.
    pub(crate) fn solve(&mut self, max_passes: usize) -> Result<Solution, CalibrationError> {
        let mut point = self.linearise()?;
        let mut cost = point.trajectory_cost + self.prior_cost();
        let (mut iterations, mut passes) = (0, 0);
        let mut before_length = f64::INFINITY;
        loop {
            let step = self.step(&point)?;
            iterations += 1;
            let is_flat = step.length <= FLAT_STEP.max(FLAT_SHARE * cost.sqrt());
            let last = step.length < LAST_STEP.max(LAST_SHARE * cost.sqrt())
                || (is_flat && step.length > SLOW * before_length);
            before_length = step.length;
            // Long records: one linearisation at a time.
            point.kept.clear();
            let before: Vec<_> = self
                .runs
                .iter()
                .map(|run| (run.points.clone(), run.walk_changes.clone()))
                .collect();
            let values = self.values.clone();
            let mut share = 1.0;
            let mut halvings = 0;
            loop {
                self.apply(&step, share, &before, &values);
                let moved = self.linearise();
                passes += 1;
                // A model may leave its domain on the way: that step was too long.
                if let Ok(moved) = moved {
                    let moved_cost = moved.trajectory_cost + self.prior_cost();
                    // The last step changes the cost by less than rounding does, or than 1e-4.
                    if moved_cost <= cost || last {
                        (point, cost) = (moved, moved_cost);
                        break;
                    }
                } else if halvings == MAX_HALVINGS {
                    return Err(moved.err().unwrap_or(CalibrationError::NotPositiveDefinite));
                }
                if halvings == MAX_HALVINGS {
                    if !is_flat {
                        return Err(CalibrationError::NoDescent { iterations });
                    }
                    self.apply(&step, 0.0, &before, &values);
                    return Ok(self.solution(self.linearise()?, iterations));
                }
                halvings += 1;
                share *= 0.5;
            }
            if last {
                return Ok(self.solution(point, iterations));
            }
            if passes >= max_passes {
                return Err(CalibrationError::NotConverged {
                    iterations,
                    last_step: step.length,
                });
            }
        }
    }

    /// One pass over each record: equation (3).
    fn linearise(&self) -> Result<Linearised, CalibrationError> {
        let size = self.unknowns.len() + 1;
        let mut point = Linearised {
            gram: DMatrix::zeros(size, size),
            trajectory_cost: 0.0,
            values: 0,
            rows: 0,
            log_variance: 0.0,
            kept: Vec::with_capacity(self.runs.len()),
        };
        for (index, run) in self.runs.iter().enumerate() {
            let parameters = self.parameters(index);
            let (reduced, kept) = self
                .with_run(index, &parameters, |pass| {
                    let is_short = run.points.len() <= LONGEST_KEPT;
                    let kept = is_short.then(|| KeptRecord::new(pass.record)).transpose()?;
                    let reduced = pass.on(kept.as_ref()).reduce_with_cost(|_| ())?;
                    Ok((reduced, kept.map(Arc::new)))
                })
                .map_err(|error| CalibrationError::pass(index, error))?;
            point.trajectory_cost += reduced.trajectory_cost;
            point.values += reduced.values;
            point.rows += reduced.rows;
            point.log_variance += reduced.log_variance;
            add_gram(&mut point.gram, &reduced.gram, &run.column_unknowns());
            point.kept.push(kept);
        }
        Ok(point)
    }

    /// The Gauss-Newton step: equations (4) to (6).
    fn step(&self, point: &Linearised) -> Result<Step, CalibrationError> {
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
        let cholesky = Cholesky::new(information).ok_or(CalibrationError::NotPositiveDefinite)?;
        let change = cholesky.solve(&gradient);
        // Cost of the present trajectory less the least cost of the linearised problem.
        let decrease = point.trajectory_cost - point.gram[(0, 0)] + change.dot(&gradient);
        let mut values = DVector::zeros(self.unknowns.len());
        for (a, change) in estimated.iter().zip(change.iter()) {
            values[*a] = *change;
        }
        let corrections = (0..self.runs.len())
            .map(|index| {
                let parameters = self.parameters(index);
                let change: Vec<f64> = self.runs[index]
                    .column_unknowns()
                    .iter()
                    .map(|unknowns| unknowns.iter().map(|unknown| values[*unknown]).sum())
                    .collect();
                self.with_run(index, &parameters, |pass| {
                    pass.on(point.kept[index].as_deref()).smooth(&change)
                })
                .map_err(|error| CalibrationError::pass(index, error))
            })
            .collect::<Result<_, _>>()?;
        Ok(Step {
            values,
            corrections,
            length: decrease.max(0.0).sqrt(),
        })
    }

    /// Applies a share of a step to the trajectories and values before it.
    fn apply(
        &mut self,
        step: &Step,
        share: f64,
        before: &[(Vec<Orientation>, Vec<f64>)],
        values: &[f64],
    ) {
        for (value, (before, change)) in self
            .values
            .iter_mut()
            .zip(values.iter().zip(step.values.iter()))
        {
            *value = before + share * change;
        }
        for run in &mut self.runs {
            let amplitudes = run.amplitudes.iter().map(|unknown| self.values[*unknown]);
            run.further.set_amplitudes(amplitudes);
        }
        for (run, ((points, walks), smoothed)) in self
            .runs
            .iter_mut()
            .zip(before.iter().zip(&step.corrections))
        {
            for (point, (before, correction)) in run
                .points
                .iter_mut()
                .zip(points.iter().zip(smoothed.corrections.chunks_exact(3)))
            {
                let turn = core::array::from_fn(|axis| share * correction[axis]);
                *point = turned(before, &turn);
            }
            run.walk_changes.resize(smoothed.walks.len(), 0.0);
            for (index, (change, correction)) in
                run.walk_changes.iter_mut().zip(&smoothed.walks).enumerate()
            {
                *change = walks.get(index).unwrap_or(&0.0) + share * correction;
            }
        }
    }

    fn solution(&self, point: Linearised, iterations: usize) -> Solution {
        let count = self.unknowns.len();
        Solution {
            information: point.gram.view((1, 1), (count, count)).into_owned(),
            gradient: point.gram.column(0).rows(1, count).into_owned(),
            cost: point.trajectory_cost + self.prior_cost(),
            values: point.values,
            rows: point.rows,
            log_variance: point.log_variance,
            kept: point.kept,
            iterations,
        }
    }
}

/// Rows of the residual and `count` unknowns, from rows of the residual and columns of a pass; `unknowns` has for
/// each column the unknowns whose sum it is.
pub(crate) fn rows_of_unknowns(
    of_columns: &[f64],
    unknowns: &[&[usize]],
    count: usize,
) -> Vec<f64> {
    let own = of_columns.chunks_exact(unknowns.len() + 1);
    let mut rows = vec![0.0; own.len() * (count + 1)];
    for (row, own) in rows.chunks_exact_mut(count + 1).zip(own) {
        row[0] = own[0];
        for (of_column, value) in unknowns.iter().zip(&own[1..]) {
            for unknown in *of_column {
                row[unknown + 1] += value;
            }
        }
    }
    rows
}

/// Adds a record's Gram matrix, whose columns are parameters of the model, to that of the unknowns;
/// `unknowns` has for each column the unknowns whose sum it is.
pub(crate) fn add_gram(total: &mut DMatrix<f64>, gram: &DMatrix<f64>, unknowns: &[&[usize]]) {
    let size = unknowns.len() + 1;
    // Column 0 is the residual in both.
    let targets = |column: usize| -> Vec<usize> {
        match column.checked_sub(1) {
            None => vec![0],
            Some(parameter) => unknowns[parameter].iter().map(|index| index + 1).collect(),
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

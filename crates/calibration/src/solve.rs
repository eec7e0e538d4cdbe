//! Gauss-Newton on the trajectories of several records and the parameters they share.

use gyrocal::estimation::batch::{Columns, Linearisation, Manifold, Series, Tape};
use gyrocal::trajectory::{Orientation, turned};
use gyrocal::{Chart, EstimationError, Integration};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::further::Further;
use crate::run::{Conditions, Rows};

/// Rows of a record whose steps are kept between passes, some 700 bytes each.
const LONGEST_TAPE: usize = 100_000;

/// Steps are halved at most so often when they do not lower the cost.
const MOST_HALVINGS: usize = 12;

/// The step is the last one if it is shorter than this, in standard deviations of the whole
/// problem: what is left after it is smaller by the curvature of a chart over such a step.
const LAST_STEP: f64 = 1e-4;

/// The same for records that the model does not fit, as a share of the root of the cost: a
/// shorter step lowers the cost by less than rounding of its sum does.
const LAST_SHARE: f64 = 1e-6;

/// One parameter of the joint problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknown {
    /// Mean of its prior.
    pub(crate) prior: f64,
    /// Standard deviation of its prior.
    pub(crate) sigma: f64,
    /// Whether it keeps its prior mean and only widens the covariance of the others.
    pub(crate) considered: bool,
}

impl Unknown {
    /// Estimated from zero.
    pub(crate) fn estimated(sigma: f64) -> Self {
        Self {
            prior: 0.0,
            sigma,
            considered: false,
        }
    }

    /// Held at zero; 0 is the sigma of what counts as known.
    pub(crate) fn considered(sigma: Option<f64>) -> Self {
        Self {
            prior: 0.0,
            sigma: sigma.unwrap_or(0.0),
            considered: true,
        }
    }
}

/// One record within the joint problem.
#[derive(Clone)]
pub(crate) struct Leg<'a, I> {
    pub(crate) rows: Rows<'a>,
    pub(crate) chart: Chart<f64, I>,
    pub(crate) noise_density: [f64; 3],
    /// Attitude that the bench declares for the first row.
    pub(crate) prior: Orientation,
    pub(crate) prior_covariance: [[f64; 3]; 3],
    /// Attitude at each row.
    pub(crate) points: Vec<Orientation>,
    /// For each parameter of the model the unknowns whose sum it is; none if it is zero for
    /// good.
    pub(crate) sums: Vec<Vec<usize>>,
    /// Columns beside the model's parameters, and the unknown that is the amplitude of each.
    pub(crate) further: Further,
    pub(crate) amplitudes: Vec<usize>,
}

impl<I> Leg<'_, I> {
    /// For each column the unknowns whose sum it is.
    fn columns(&self) -> Vec<&[usize]> {
        let parameters = self.sums.iter().filter(|unknowns| !unknowns.is_empty());
        parameters
            .map(Vec::as_slice)
            .chain(self.amplitudes.iter().map(core::slice::from_ref))
            .collect()
    }
}

/// All records, and what they have in common.
#[derive(Clone)]
pub(crate) struct Problem<'a, D, I> {
    pub(crate) model: &'a D,
    pub(crate) integration: Integration,
    pub(crate) longest_step_s: f64,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) legs: Vec<Leg<'a, I>>,
    /// Every unknown's present value.
    pub(crate) values: Vec<f64>,
}

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
    pub(crate) tapes: Vec<Option<Tape<Orientation, 3>>>,
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
    tapes: Vec<Option<Tape<Orientation, 3>>>,
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
                    return Err(Failure::NoDescent { iterations });
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

    /// The parameters of the model in one record.
    pub(crate) fn parameters(&self, leg: usize) -> Vec<f64> {
        self.legs[leg]
            .sums
            .iter()
            .map(|unknowns| unknowns.iter().map(|index| self.values[*index]).sum())
            .collect()
    }

    /// Outputs that the model gives at each row of a record for these attitudes.
    pub(crate) fn outputs(&self, leg: usize, points: &[Orientation]) -> Vec<[f64; 3]> {
        let parameters = self.parameters(leg);
        let leg = &self.legs[leg];
        let (mut chart, mut moving) = (leg.chart, [0.0; 3]);
        points
            .iter()
            .enumerate()
            .map(|(row, point)| {
                self.model.place(point, &mut moving, &mut chart);
                Series::<Chart<f64, I>, 3>::at(&leg.rows, row, &mut chart);
                let mut outputs_g = self.model.output(&moving, &parameters, &chart);
                for (output, reading_g) in outputs_g.iter_mut().enumerate() {
                    *reading_g += leg.further.reading_g(row, output);
                }
                outputs_g
            })
            .collect()
    }

    fn prior_cost(&self) -> f64 {
        self.unknowns
            .iter()
            .zip(&self.values)
            .filter(|(unknown, _)| !unknown.considered)
            .map(|(unknown, value)| ((value - unknown.prior) / unknown.sigma).powi(2))
            .sum()
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
                    pass.reduce_and_keep(|_| ())
                        .map(|(reduced, tape)| (reduced, Some(tape)))
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

    pub(crate) fn with_leg<R>(
        &self,
        index: usize,
        parameters: &[f64],
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, Further, 3, 3>) -> R,
    ) -> R {
        self.with_columns(index, parameters, &self.legs[index].further, pass)
    }

    /// A pass over a record with these columns beside those of its parameters.
    pub(crate) fn with_columns<R, C: Columns<3, 3>>(
        &self,
        index: usize,
        parameters: &[f64],
        further: &C,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, C, 3, 3>) -> R,
    ) -> R {
        let active: Vec<usize> = (0..parameters.len())
            .filter(|parameter| !self.legs[index].sums[*parameter].is_empty())
            .collect();
        self.with_active(index, parameters, &active, further, pass)
    }

    /// A pass over a record as if some of its rows had no value.
    pub(crate) fn without_rows<R>(
        &self,
        index: usize,
        parameters: &[f64],
        left_out: core::ops::Range<usize>,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, Further, 3, 3>) -> R,
    ) -> R {
        let mut rows = self.legs[index].rows.again();
        rows.leave_out(left_out);
        let active: Vec<usize> = (0..parameters.len())
            .filter(|parameter| !self.legs[index].sums[*parameter].is_empty())
            .collect();
        let further = &self.legs[index].further;
        self.with_active(index, parameters, &active, further, |all| {
            pass(&Linearisation {
                series: &rows,
                ..*all
            })
        })
    }

    /// A pass over a record with any parameters as columns.
    pub(crate) fn with_active<R, C: Columns<3, 3>>(
        &self,
        index: usize,
        parameters: &[f64],
        active: &[usize],
        further: &C,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, C, 3, 3>) -> R,
    ) -> R {
        let leg = &self.legs[index];
        pass(&Linearisation {
            model: self.model,
            inputs: leg.chart,
            series: &leg.rows,
            integration: self.integration,
            longest_step_s: self.longest_step_s,
            noise_density: leg.noise_density,
            prior: leg.prior,
            prior_covariance: leg.prior_covariance,
            points: &leg.points,
            parameters,
            active,
            further,
            tape: None,
        })
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
                    let tape = point.tapes[index].as_ref();
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

    /// Indices of the unknowns that are estimated.
    pub(crate) fn estimated(&self) -> Vec<usize> {
        (0..self.unknowns.len())
            .filter(|index| !self.unknowns[*index].considered)
            .collect()
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
fn add_gram(total: &mut DMatrix<f64>, gram: &DMatrix<f64>, sums: &[&[usize]]) {
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

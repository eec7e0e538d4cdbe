//! The two passes over a record: elimination of the moving states, and their smoothing.

use alloc::vec;
use alloc::vec::Vec;

use gyrocal_scalar::Scalar;
use nalgebra::{Cholesky, DMatrix, DVector};

use super::gram::Gram;
use super::noise::{NoiseFilter, NoiseScore};
use super::pass::{NOT_DRIVEN, Pass};
use super::tape::Tape;
use super::walk::{Joint, WalkStep, Walks};
use super::{Columns, Manifold, Series};
use crate::error::EstimationError;
use crate::transition::Integration;

/// Inputs of a pass over a record, linearised about a trajectory.
pub struct Linearisation<'a, D, S, C, const M: usize, const Y: usize>
where
    D: Manifold<M, Y>,
{
    /// The model.
    pub model: &'a D,
    /// Its inputs; chart and held values are set row by row.
    pub inputs: D::Inputs,
    /// The record.
    pub series: &'a S,
    /// Integration rule of the rates.
    pub integration: Integration,
    /// Longest interval integrated in one step, s; longer ones are divided.
    pub longest_step_s: f64,
    /// Spectral densities of the noise inputs: unit squared times seconds.
    pub noise_density: [f64; M],
    /// Mean of the prior of the first point.
    pub prior: D::Point,
    /// Covariance of its error, as a correction of that point.
    pub prior_covariance: [[f64; M]; M],
    /// The trajectory, one point a row.
    pub points: &'a [D::Point],
    /// All parameters of the model.
    pub parameters: &'a [f64],
    /// Indices of those that are columns.
    pub active: &'a [usize],
    /// Further columns, after those of the parameters.
    pub further: &'a C,
    /// Active parameters that walk at random about their values.
    pub walks: Walks<'a>,
    /// Steps kept by an earlier pass about the same trajectory with the same active parameters.
    pub tape: Option<&'a Tape<M>>,
}

/// Result of the first pass over a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced<const M: usize> {
    /// [`Gram`] matrix of residual and columns. The columns are derivatives of the innovations:
    /// minus those of the predictions.
    pub gram: DMatrix<f64>,
    /// Number of output values used.
    pub values: usize,
    /// Number of rows with at least one of them.
    pub rows: usize,
    /// Sum of the natural logarithms of the innovations' variances.
    pub log_variance: f64,
    /// Twice the cost of the trajectory itself: squares of output residuals, of the noise between
    /// points, and of the first point's distance from its prior, each over its covariance.
    pub trajectory_cost: f64,
    /// Deviation of the last point and then of the walks there, each with its derivatives by columns:
    /// rows of 1 + columns.
    pub last: Vec<f64>,
    /// Covariance of the last point given the parameters.
    pub last_covariance: [[f64; M]; M],
    /// Covariance of the walks at the last row given the parameters, by rows.
    pub last_walks: Vec<f64>,
}

/// One output of one row, whitened.
#[derive(Clone, Copy, Debug)]
pub struct Whitened<'a> {
    /// The row.
    pub row: usize,
    /// Index of the output.
    pub output: usize,
    /// Standard deviation of the innovation given the outputs before it.
    pub deviation: f64,
    /// Innovation and columns over [`Self::deviation`].
    pub columns: &'a [f64],
}

/// Result of the second pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed<const M: usize> {
    /// Correction of every point of the trajectory.
    pub corrections: Vec<[f64; M]>,
    /// Correction of the change of every walk at every row, by rows.
    pub walks: Vec<f64>,
}

/// Sees an output, its Jacobian and its covariance with moving states and walks.
type OutputWatch<'a, const M: usize> = dyn FnMut(&Whitened<'_>, &[f64; M], &[f64; M], &[f64]) + 'a;

/// Sees the transition of the moving states over a step, and the walks.
type StepWatch<'a, const M: usize> = dyn FnMut(&[[f64; M]; M], &[WalkStep<M>]) + 'a;

impl<D, S, C, const M: usize, const Y: usize> Clone for Linearisation<'_, D, S, C, M, Y>
where
    D: Manifold<M, Y>,
{
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, S, C, const M: usize, const Y: usize> Copy for Linearisation<'_, D, S, C, M, Y> where
    D: Manifold<M, Y>
{
}

impl<D, S, C, const M: usize, const Y: usize> Linearisation<'_, D, S, C, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
    C: Columns<M, Y>,
{
    /// Eliminates the moving states. `watch` sees every whitened output value in the order of
    /// the filter.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if there is not one point for each row, times do not
    /// rise, or the noise does not drive every moving state;
    /// [`EstimationError::NotFinite`] if the model left the numbers.
    pub fn reduce(
        &self,
        mut watch: impl FnMut(&Whitened<'_>),
    ) -> Result<Reduced<M>, EstimationError> {
        self.reduce_onto(None, &mut watch)
    }

    /// As [`Self::reduce`], and keeps the linearised steps for later passes.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn reduce_and_keep(
        &self,
        mut watch: impl FnMut(&Whitened<'_>),
    ) -> Result<(Reduced<M>, Tape<M>), EstimationError> {
        let mut tape = Tape::new(self.points.len().saturating_sub(1), self.active.len());
        let reduced = self.reduce_onto(Some(&mut tape), &mut watch)?;
        Ok((reduced, tape))
    }

    fn reduce_onto(
        &self,
        mut tape: Option<&mut Tape<M>>,
        watch: &mut dyn FnMut(&Whitened<'_>),
    ) -> Result<Reduced<M>, EstimationError> {
        let count = self.active.len() + self.further.count();
        let mut gram = Gram::new(count);
        let mut pass = Pass::new(self, count, None)?;
        let mut reduced = Reduced {
            gram: DMatrix::zeros(0, 0),
            values: 0,
            rows: 0,
            log_variance: 0.0,
            trajectory_cost: pass.prior_cost,
            last: Vec::new(),
            last_covariance: [[0.0; M]; M],
            last_walks: Vec::new(),
        };
        for row in 0..self.points.len() {
            let before = reduced.values;
            pass.observe(row, &mut |whitened, taken| {
                gram.add(whitened.columns);
                reduced.values += 1;
                reduced.log_variance += 2.0 * Scalar::ln(whitened.deviation);
                reduced.trajectory_cost += taken.cost;
                watch(whitened);
            })?;
            reduced.rows += usize::from(reduced.values > before);
            if row + 1 < self.points.len() {
                let advanced = pass.advance(row)?;
                reduced.trajectory_cost += advanced.cost;
                if let Some(tape) = &mut tape {
                    tape.push(&pass.last, &advanced.jump, &pass.own);
                }
            }
        }
        reduced.gram = gram.finish();
        reduced.last = pass.filter.columns;
        reduced.last_covariance = pass.filter.covariance.moving;
        reduced.last_walks = pass.filter.covariance.walks;
        Ok(reduced)
    }

    /// A pass that hands each output's Jacobian and covariance with the moving states to `output`,
    /// and each step's transition to `step`.
    pub(crate) fn forward(
        &self,
        output: &mut OutputWatch<'_, M>,
        step: &mut StepWatch<'_, M>,
    ) -> Result<(), EstimationError> {
        let count = self.active.len() + self.further.count();
        let mut pass = Pass::new(self, count, None)?;
        for row in 0..self.points.len() {
            pass.observe(row, &mut |whitened, taken| {
                output(whitened, &taken.jacobian, &taken.cross, taken.walk_cross);
            })?;
            if row + 1 < self.points.len() {
                pass.advance(row)?;
                step(&pass.last.moving, &pass.walk_steps);
            }
        }
        Ok(())
    }

    /// Open-loop simulation: the trajectory of the model from the first point, without measurements
    /// and without noise; further columns enter with their amplitudes. Parameters that walk stay as
    /// they are at the first row.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn free_run(&self) -> Result<Vec<D::Point>, EstimationError> {
        self.free_run_over(0..self.points.len())
    }

    /// The same over some rows, from the point at the first of them.
    ///
    /// # Errors
    /// As [`Self::reduce`], and [`EstimationError::InvalidArgument`] if there are no such rows.
    pub fn free_run_over(
        &self,
        rows: core::ops::Range<usize>,
    ) -> Result<Vec<D::Point>, EstimationError> {
        if rows.is_empty() || rows.end > self.points.len() {
            return Err(EstimationError::InvalidArgument {
                expected: "rows of the record, and at least one",
            });
        }
        let none = vec![0.0; self.active.len() + self.further.count()];
        let mut pass = Pass::new(self, 0, Some(&none))?;
        let mut points = Vec::with_capacity(rows.len());
        let mut point = self.points[rows.start];
        points.push(point);
        let mut parameters = self.parameters.to_vec();
        for (index, walk) in self.walks.walks.iter().enumerate() {
            parameters[walk.parameter] += self.walks.change(rows.start, index);
        }
        let further = self.further.count();
        for row in rows.start..rows.end - 1 {
            let (_, predicted) = pass
                .stepper
                .advance(self.series, row, &point, &parameters)?;
            let mut turn = [0.0; M];
            let jump = pass.drive(row);
            for i in 0..M {
                for (column, drive) in jump[i * further..(i + 1) * further].iter().enumerate() {
                    turn[i] += drive * self.further.amplitude(column);
                }
            }
            let mut moving = [0.0; M];
            self.model.place(&predicted, &mut moving, &mut pass.inputs);
            self.model.correct(&mut moving, &mut pass.inputs, &turn);
            point = self.model.point(&moving, &pass.inputs);
            points.push(point);
        }
        Ok(points)
    }

    /// Likelihood of the noise with its derivatives, all columns held fixed. `factors` multiply the
    /// declared variances: first those of the outputs, then those of the noise inputs, then those of
    /// the walks.
    ///
    /// # Errors
    /// As [`Self::reduce`], and [`EstimationError::InvalidArgument`] if there is not one factor
    /// for each output, noise input and walk.
    pub fn noise_score(&self, factors: &[f64]) -> Result<NoiseScore, EstimationError> {
        let none = vec![0.0; self.active.len() + self.further.count()];
        self.noise_pass(factors, 0, Some(&none), (0, &[]))
    }

    /// The same with the columns free, for a likelihood that they are to be eliminated from, and with
    /// derivatives by the noises from `first` on only; those by the others are zero. The information is
    /// that where the columns have changed by `change`; by nothing if that is empty.
    ///
    /// # Errors
    /// As [`Self::noise_score`], and [`EstimationError::InvalidArgument`] if there is not one change for
    /// each column.
    pub fn noise_score_of_columns(
        &self,
        factors: &[f64],
        first: usize,
        change: &[f64],
    ) -> Result<NoiseScore, EstimationError> {
        let count = self.active.len() + self.further.count();
        if !change.is_empty() && change.len() != count {
            return Err(EstimationError::InvalidArgument {
                expected: "one change for each column",
            });
        }
        self.noise_pass(factors, count, None, (first, change))
    }

    fn noise_pass(
        &self,
        factors: &[f64],
        count: usize,
        change: Option<&[f64]>,
        (first, of_columns): (usize, &[f64]),
    ) -> Result<NoiseScore, EstimationError> {
        let walks = self.walks.walks.len();
        if factors.len() != M + Y + walks {
            return Err(EstimationError::InvalidArgument {
                expected: "one factor for each output, each noise input and each walk",
            });
        }
        let (outputs, rest) = factors.split_at(Y);
        let (inputs, own) = rest.split_at(M);
        let mut pass = Pass::new(self, count, change)?;
        pass.factors.copy_from_slice(outputs);
        pass.input_factors.copy_from_slice(inputs);
        pass.walk_factors.copy_from_slice(own);
        let mut filter = NoiseFilter::<M>::new(Y, count, walks, first);
        filter.change_columns(of_columns);
        for row in 0..self.points.len() {
            pass.observe(row, &mut |whitened, taken| filter.take(whitened, taken))?;
            if row + 1 < self.points.len() {
                pass.advance(row)?;
                filter.predict(&pass.last, &pass.walk_steps);
            }
        }
        Ok(filter.finish())
    }

    /// The correction of every point when the columns change by `change`.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn smooth(&self, change: &[f64]) -> Result<Smoothed<M>, EstimationError> {
        let rows = self.points.len();
        let size = M + self.walks.walks.len();
        let mut pass = Pass::new(self, 0, Some(change))?;
        let mut corrections: Vec<DVector<f64>> = Vec::with_capacity(rows);
        let mut gains: Vec<DMatrix<f64>> = Vec::with_capacity(rows.saturating_sub(1));
        for row in 0..rows {
            pass.observe(row, &mut |_, _| ())?;
            corrections.push(DVector::from_vec(pass.filter.whole_mean()));
            if row + 1 < rows {
                let filtered = pass.filter.covariance.clone();
                pass.advance(row)?;
                let steps = &pass.walk_steps;
                let transition = whole_transition(&pass.last.moving, steps);
                let gain = smoother_gain(&filtered, &transition, &pass.filter.covariance)
                    .ok_or(NOT_DRIVEN)?;
                let predicted = DVector::from_vec(pass.filter.whole_mean());
                corrections[row].gemv(-1.0, &gain, &predicted, 1.0);
                gains.push(gain);
            }
        }
        for row in (0..rows.saturating_sub(1)).rev() {
            let (before, after) = corrections.split_at_mut(row + 1);
            before[row].gemv(1.0, &gains[row], &after[0], 1.0);
        }
        Ok(Smoothed {
            corrections: corrections
                .iter()
                .map(|all| core::array::from_fn(|i| all[i]))
                .collect(),
            walks: corrections
                .iter()
                .flat_map(|all| (M..size).map(|i| all[i]))
                .collect(),
        })
    }
}

/// Transition of moving states and walks.
fn whole_transition<const M: usize>(moving: &[[f64; M]; M], steps: &[WalkStep<M>]) -> DMatrix<f64> {
    let size = M + steps.len();
    DMatrix::from_fn(size, size, |i, j| match (i < M, j.checked_sub(M)) {
        (true, None) => moving[i][j],
        (true, Some(walk)) => steps[walk].effect[i],
        (false, _) => f64::from(u8::from(i == j)),
    })
}

/// P⁺ Φᵀ (P⁻)⁻¹.
fn smoother_gain<const M: usize>(
    filtered: &Joint<M>,
    transition: &DMatrix<f64>,
    predicted: &Joint<M>,
) -> Option<DMatrix<f64>> {
    let size = transition.nrows();
    let whole = |joint: &Joint<M>| DMatrix::from_fn(size, size, |i, j| joint.whole(i, j));
    // The transpose of the gain: both covariances are symmetric.
    let gain = Cholesky::new(whole(predicted))?.solve(&(transition * whole(filtered)));
    Some(gain.transpose())
}

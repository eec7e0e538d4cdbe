//! The two passes over a record: elimination of the moving states, and their smoothing.

use alloc::vec;
use alloc::vec::Vec;

use gyrocal_scalar::Scalar;
use nalgebra::DMatrix;

use super::filter::{Conditional, backward, cholesky, forward};
use super::gram::Gram;
use super::noise::{NoiseFilter, NoiseScore};
use super::step::{Step, Stepper, add, map_columns, sandwich};
use super::tape::Tape;
use super::{Columns, Manifold, Series};
use crate::error::EstimationError;
use crate::transition::Integration;

/// Everything that a pass over a record is made from.
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
    /// How the rates are integrated.
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
    /// What an earlier pass about the same trajectory, with the same parameters active, kept.
    pub tape: Option<&'a Tape<D::Point, M>>,
}

/// What the first pass leaves of a record.
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
    /// Twice the cost of the trajectory itself: squares of output residuals, of what the noise
    /// must have done between points, and of the first point's distance from its prior, each
    /// over its covariance.
    pub trajectory_cost: f64,
    /// Deviation of the last point, then its derivatives by columns: M rows of 1 + columns.
    pub last: Vec<f64>,
    /// Covariance of the last point given the parameters.
    pub last_covariance: [[f64; M]; M],
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

/// What the second pass gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed<const M: usize> {
    /// Correction of every point of the trajectory.
    pub corrections: Vec<[f64; M]>,
}

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
    pub fn reduce(&self, watch: impl FnMut(&Whitened<'_>)) -> Result<Reduced<M>, EstimationError> {
        self.reduce_onto(None, watch)
    }

    /// As [`Self::reduce`], and keeps what the model gave for later passes.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn reduce_and_keep(
        &self,
        watch: impl FnMut(&Whitened<'_>),
    ) -> Result<(Reduced<M>, Tape<D::Point, M>), EstimationError> {
        let mut tape = Tape::new(self.points.len().saturating_sub(1), self.active.len());
        let reduced = self.reduce_onto(Some(&mut tape), watch)?;
        Ok((reduced, tape))
    }

    fn reduce_onto(
        &self,
        mut tape: Option<&mut Tape<D::Point, M>>,
        mut watch: impl FnMut(&Whitened<'_>),
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
        };
        for row in 0..self.points.len() {
            let before = reduced.values;
            pass.observe(row, |whitened, taken| {
                gram.add(whitened.columns);
                reduced.values += 1;
                reduced.log_variance += 2.0 * Scalar::ln(whitened.deviation);
                reduced.trajectory_cost += taken.cost;
                watch(whitened);
            })?;
            reduced.rows += usize::from(reduced.values > before);
            if row + 1 < self.points.len() {
                let (step, cost) = pass.advance(row)?;
                reduced.trajectory_cost += cost;
                if let Some(tape) = &mut tape {
                    tape.steps.push(step);
                    tape.columns.extend_from_slice(&pass.own);
                }
            }
        }
        reduced.gram = gram.finish();
        reduced.last = pass.filter.columns;
        reduced.last_covariance = pass.filter.covariance;
        Ok(reduced)
    }

    /// A pass that tells of each output its Jacobian and its covariance with the moving states,
    /// and of each step its transition.
    pub(crate) fn forward(
        &self,
        mut output: impl FnMut(&Whitened<'_>, &[f64; M], [f64; M]),
        mut step: impl FnMut(&[[f64; M]; M]),
    ) -> Result<(), EstimationError> {
        let count = self.active.len() + self.further.count();
        let mut pass = Pass::new(self, count, None)?;
        for row in 0..self.points.len() {
            pass.observe(row, |whitened, taken| {
                let mut cross = [0.0; M];
                for i in 0..M {
                    for j in 0..M {
                        cross[i] += taken.covariance[i][j] * taken.jacobian[j];
                    }
                }
                output(whitened, &taken.jacobian, cross);
            })?;
            if row + 1 < self.points.len() {
                let (advanced, _) = pass.advance(row)?;
                step(&advanced.moving);
            }
        }
        Ok(())
    }

    /// Where the model goes by itself from the first point: the trajectory without measurements
    /// and without noise, further columns with their amplitudes included.
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
        let further = self.further.count();
        for row in rows.start..rows.end - 1 {
            let step = pass
                .stepper
                .advance(self.series, row, &point, self.parameters)?;
            let mut turn = [0.0; M];
            let jump = pass.drive(row);
            for i in 0..M {
                for (column, drive) in jump[i * further..(i + 1) * further].iter().enumerate() {
                    turn[i] += drive * self.further.amplitude(column);
                }
            }
            let mut moving = [0.0; M];
            self.model
                .place(&step.predicted, &mut moving, &mut pass.inputs);
            self.model.correct(&mut moving, &mut pass.inputs, &turn);
            point = self.model.point(&moving, &pass.inputs);
            points.push(point);
        }
        Ok(points)
    }

    /// What the record says of its noise: gradient and information of the likelihood, the
    /// trajectory and all columns held where they are. `factors` multiply the declared
    /// variances: first those of the outputs, then those of the noise inputs.
    ///
    /// # Errors
    /// As [`Self::reduce`], and [`EstimationError::InvalidArgument`] if there is not one factor
    /// for each output and each noise input.
    pub fn noise_score(&self, factors: &[f64]) -> Result<NoiseScore, EstimationError> {
        if factors.len() != M + Y {
            return Err(EstimationError::InvalidArgument {
                expected: "one factor for each output and each noise input",
            });
        }
        let (outputs, inputs) = factors.split_at(Y);
        let none = vec![0.0; self.active.len() + self.further.count()];
        let mut pass = Pass::new(self, 0, Some(&none))?;
        pass.factors.copy_from_slice(outputs);
        pass.input_factors.copy_from_slice(inputs);
        let mut filter = NoiseFilter::<M>::new(Y);
        for row in 0..self.points.len() {
            pass.observe(row, |whitened, taken| filter.take(whitened, taken))?;
            if row + 1 < self.points.len() {
                let (step, _) = pass.advance(row)?;
                filter.predict(&step);
            }
        }
        Ok(filter.score)
    }

    /// The correction of every point when the columns change by `change`.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn smooth(&self, change: &[f64]) -> Result<Smoothed<M>, EstimationError> {
        let rows = self.points.len();
        let mut pass = Pass::new(self, 0, Some(change))?;
        let mut corrections = vec![[0.0; M]; rows];
        let mut gains = vec![[[0.0; M]; M]; rows.saturating_sub(1)];
        for row in 0..rows {
            pass.observe(row, |_, _| ())?;
            corrections[row] = pass.filter.mean();
            if row + 1 < rows {
                let filtered = pass.filter.covariance;
                let (step, _) = pass.advance(row)?;
                let gain = smoother_gain(&filtered, &step.moving, &pass.filter.covariance)
                    .ok_or(NOT_DRIVEN)?;
                let predicted = pass.filter.mean();
                for i in 0..M {
                    for j in 0..M {
                        corrections[row][i] -= gain[i][j] * predicted[j];
                    }
                }
                gains[row] = gain;
            }
        }
        for row in (0..rows.saturating_sub(1)).rev() {
            let next = corrections[row + 1];
            for i in 0..M {
                for j in 0..M {
                    corrections[row][i] += gains[row][i][j] * next[j];
                }
            }
        }
        Ok(Smoothed { corrections })
    }
}

const NOT_DRIVEN: EstimationError = EstimationError::InvalidArgument {
    expected: "noise that drives every moving state, and a positive definite prior",
};

/// P⁺ Φᵀ (P⁻)⁻¹.
fn smoother_gain<const M: usize>(
    filtered: &[[f64; M]; M],
    transition: &[[f64; M]; M],
    predicted: &[[f64; M]; M],
) -> Option<[[f64; M]; M]> {
    let lower = cholesky(predicted)?;
    let mut gain = [[0.0; M]; M];
    for i in 0..M {
        let mut cross = [0.0; M];
        for (j, value) in cross.iter_mut().enumerate() {
            for l in 0..M {
                *value += filtered[i][l] * transition[j][l];
            }
        }
        gain[i] = backward(&lower, &forward(&lower, &cross));
    }
    Some(gain)
}

/// vᵀ A⁻¹ v.
fn squared<const M: usize>(matrix: &[[f64; M]; M], vector: &[f64; M]) -> Option<f64> {
    let lower = cholesky(matrix)?;
    Some(forward(&lower, vector).iter().map(|x| x * x).sum())
}

/// How an output was taken: what the filter does not keep.
pub(crate) struct Taken<const M: usize> {
    /// Square of the residual at the linearisation point over the output's noise variance.
    cost: f64,
    pub(crate) jacobian: [f64; M],
    /// Of the output's noise.
    pub(crate) variance: f64,
    /// Of the moving states, before.
    pub(crate) covariance: [[f64; M]; M],
}

/// A pass in progress.
struct Pass<'a, D, S, C, const M: usize, const Y: usize>
where
    D: Manifold<M, Y>,
{
    of: &'a Linearisation<'a, D, S, C, M, Y>,
    stepper: Stepper<'a, D, D::Inputs, M, Y>,
    filter: Conditional<M>,
    /// Inputs at the rows.
    inputs: D::Inputs,
    prior_cost: f64,
    /// What the declared variances of the outputs are multiplied by.
    factors: [f64; Y],
    /// What the densities of the noise inputs are multiplied by.
    input_factors: [f64; M],
    /// Active parameter columns of the last step, M rows of them.
    own: Vec<f64>,
    /// Change of the columns; all are then folded into column 0.
    change: Option<&'a [f64]>,
    d_parameters: Vec<f64>,
    drive: Vec<f64>,
    direct: Vec<f64>,
}

impl<'a, D, S, C, const M: usize, const Y: usize> Pass<'a, D, S, C, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
    C: Columns<M, Y>,
{
    fn new(
        of: &'a Linearisation<'a, D, S, C, M, Y>,
        count: usize,
        change: Option<&'a [f64]>,
    ) -> Result<Self, EstimationError> {
        let further = of.further.count();
        if of.points.is_empty()
            || of.points.len() != of.series.rows()
            || of.parameters.len() != of.model.parameters()
            || of.active.iter().any(|index| *index >= of.parameters.len())
            || of.tape.is_some_and(|tape| {
                tape.steps.len() + 1 != of.points.len()
                    || tape.columns.len() != tape.steps.len() * M * of.active.len()
            })
            || change.is_some_and(|change| change.len() != of.active.len() + further)
        {
            return Err(EstimationError::InvalidArgument {
                expected: "one point a row, all parameters of the model, and one change a column",
            });
        }
        let mut mean = of.model.difference(&of.points[0], &of.prior);
        // The prior is of a correction of its own mean; here it counts as one of the first point.
        let covariance = match of.model.corrected(&mean.map(|component| -component)) {
            Some(corrected) => sandwich(&corrected.correction, &of.prior_covariance),
            None => of.prior_covariance,
        };
        let mut filter = Conditional::new(count, covariance);
        for column in 0..further {
            let amplitude = of.further.amplitude(column);
            let start = of.further.start(column);
            let changed = change.map_or(0.0, |change| change[of.active.len() + column]);
            for i in 0..M {
                mean[i] += start[i] * amplitude;
                if count > 0 {
                    filter.row_mut(i)[1 + of.active.len() + column] = start[i];
                }
                filter.row_mut(i)[0] += start[i] * changed;
            }
        }
        for i in 0..M {
            filter.row_mut(i)[0] += mean[i];
        }
        let prior_cost = squared(&of.prior_covariance, &mean).ok_or(NOT_DRIVEN)?;
        Ok(Self {
            of,
            stepper: Stepper::new(
                of.model,
                of.inputs,
                of.integration,
                of.longest_step_s,
                of.noise_density,
            ),
            filter,
            inputs: of.inputs,
            prior_cost,
            factors: [1.0; Y],
            input_factors: [1.0; M],
            own: vec![0.0; M * of.active.len()],
            change,
            d_parameters: vec![0.0; Y * of.model.output_parameters()],
            drive: vec![0.0; M * further],
            direct: vec![0.0; further],
        })
    }

    /// Takes the outputs of a row; `used` gets each of them, and how it was taken.
    fn observe(
        &mut self,
        row: usize,
        mut used: impl FnMut(&Whitened<'_>, &Taken<M>),
    ) -> Result<(), EstimationError> {
        let of = self.of;
        let measured = of.series.measured(row);
        if measured.iter().all(|value| value.is_nan()) {
            return Ok(());
        }
        let mut moving = [0.0; M];
        of.model
            .place(&of.points[row], &mut moving, &mut self.inputs);
        of.series.at(row, &mut self.inputs);
        let q = of.model.output_parameters();
        let mut d_moving = [[0.0; M]; Y];
        let predicted = if of.model.has_chart() {
            of.model.output_jacobian_at_origin(
                of.parameters,
                &self.inputs,
                &mut d_moving,
                &mut self.d_parameters,
            )
        } else {
            of.model.output_jacobian(
                &moving,
                of.parameters,
                &self.inputs,
                &mut d_moving,
                &mut self.d_parameters,
            )
        };
        let mut variance = of.series.noise_variance(row);
        for (variance, factor) in variance.iter_mut().zip(self.factors) {
            *variance *= factor;
        }
        let active = of.active.len();
        for output in 0..Y {
            if measured[output].is_nan() {
                continue;
            }
            if !(variance[output] > 0.0 && variance[output].is_finite()) {
                return Err(EstimationError::InvalidNoise { output });
            }
            let mut residual = measured[output] - predicted[output];
            self.direct.fill(0.0);
            of.further.output(row, output, &mut self.direct);
            for (column, direct) in self.direct.iter().enumerate() {
                residual -= direct * of.further.amplitude(column);
            }
            let taken = Taken {
                cost: residual * residual / variance[output],
                jacobian: d_moving[output],
                variance: variance[output],
                covariance: self.filter.covariance,
            };
            let direct_parameters = &self.d_parameters[output * q..(output + 1) * q];
            let whitened = &mut self.filter.whitened;
            whitened[0] = residual;
            if let Some(change) = self.change {
                for (index, change) in of.active.iter().zip(change) {
                    whitened[0] -= direct_parameters.get(*index).unwrap_or(&0.0) * change;
                }
                for (direct, change) in self.direct.iter().zip(&change[active..]) {
                    whitened[0] -= direct * change;
                }
            } else {
                for (value, index) in whitened[1..].iter_mut().zip(of.active) {
                    *value = -direct_parameters.get(*index).unwrap_or(&0.0);
                }
                for (value, direct) in whitened[1 + active..].iter_mut().zip(&self.direct) {
                    *value = -direct;
                }
            }
            let deviation = self.filter.update(&d_moving[output], variance[output])?;
            let seen = Whitened {
                row,
                output,
                deviation,
                columns: &self.filter.whitened,
            };
            used(&seen, &taken);
        }
        Ok(())
    }

    /// What a unit of each further column does over the step just made.
    fn drive(&mut self, row: usize) -> &[f64] {
        let further = self.of.further.count();
        if further > 0 {
            self.drive.fill(0.0);
            let mut rest = self.drive.as_mut_slice();
            let rows = core::array::from_fn(|_| {
                let (head, tail) = core::mem::take(&mut rest).split_at_mut(further);
                rest = tail;
                head
            });
            let stride = self.of.parameters.len();
            self.of
                .further
                .drive(row, &self.stepper.columns, stride, rows);
        }
        &self.drive
    }

    /// The step after a row, from the tape or from the model; leaves its active columns in
    /// [`Self::own`].
    fn step(&mut self, row: usize) -> Result<Step<D::Point, M>, EstimationError> {
        let of = self.of;
        let active = of.active.len();
        if let Some(tape) = of.tape {
            let first = row * M * active;
            self.own
                .copy_from_slice(&tape.columns[first..first + M * active]);
            // Further columns may follow a parameter that is active.
            let p = of.parameters.len();
            for i in 0..M {
                for (own, index) in self.own[i * active..].iter().zip(of.active) {
                    self.stepper.columns[i * p + index] = *own;
                }
            }
            return Ok(tape.steps[row]);
        }
        let mut step = self
            .stepper
            .advance(of.series, row, &of.points[row], of.parameters)?;
        let jump = of.model.difference(&step.predicted, &of.points[row + 1]);
        let p = of.parameters.len();
        if let Some(corrected) = of.model.corrected(&jump) {
            step.correct(&corrected);
            map_columns(&corrected.point, &mut self.stepper.columns, p);
        }
        for i in 0..M {
            for (own, index) in self.own[i * active..].iter_mut().zip(of.active) {
                *own = self.stepper.columns[i * p + index];
            }
        }
        Ok(step)
    }

    /// Goes on to the next row; returns the transition and what the noise's part adds to the
    /// cost of the trajectory.
    fn advance(&mut self, row: usize) -> Result<(Step<D::Point, M>, f64), EstimationError> {
        let of = self.of;
        let mut step = self.step(row)?;
        let mut jump = of.model.difference(&step.predicted, &of.points[row + 1]);
        if self.input_factors != [1.0; M] {
            step.noise = [[0.0; M]; M];
            for (share, factor) in step.shares.iter_mut().zip(self.input_factors) {
                for element in share.as_flattened_mut() {
                    *element *= factor;
                }
                add(&mut step.noise, share);
            }
        }
        self.filter.predict(&step.moving, &step.noise);
        let (active, further) = (of.active.len(), of.further.count());
        self.drive(row);
        for i in 0..M {
            let own = &self.own[i * active..(i + 1) * active];
            let drive = &self.drive[i * further..(i + 1) * further];
            let mut mean = 0.0;
            for (column, drive) in drive.iter().enumerate() {
                jump[i] -= drive * of.further.amplitude(column);
            }
            let target = self.filter.row_mut(i);
            if let Some(change) = self.change {
                for (own, change) in own.iter().zip(change) {
                    mean += own * change;
                }
                for (drive, change) in drive.iter().zip(&change[active..]) {
                    mean += drive * change;
                }
            } else {
                for (value, own) in target[1..].iter_mut().zip(own) {
                    *value += own;
                }
                for (value, drive) in target[1 + active..].iter_mut().zip(drive) {
                    *value += drive;
                }
            }
            target[0] += mean - jump[i];
        }
        let cost = squared(&step.noise, &jump).ok_or(NOT_DRIVEN)?;
        Ok((step, cost))
    }
}

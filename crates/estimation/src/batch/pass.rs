//! A pass over a record in progress: one row after the other, with the columns carried along.

mod walks;

use alloc::vec;
use alloc::vec::Vec;

use super::filter::{Conditional, cholesky, forward};
use super::linearisation::{Linearisation, Whitened};
use super::step::{Step, Stepper, map_columns, sandwich};
use super::walk::WalkStep;
use super::{Columns, Manifold, Series};
use crate::error::EstimationError;

pub(super) const NOT_DRIVEN: EstimationError = EstimationError::InvalidArgument {
    expected: "noise that drives every moving state, and a positive definite prior",
};

/// vᵀ A⁻¹ v.
fn squared<const M: usize>(matrix: &[[f64; M]; M], vector: &[f64; M]) -> Option<f64> {
    let lower = cholesky(matrix)?;
    Some(forward(&lower, vector).iter().map(|x| x * x).sum())
}

/// Quantities of an update.
pub(crate) struct Taken<'a, const M: usize> {
    /// Square of the residual at the linearisation point over the output's noise variance.
    pub(super) cost: f64,
    pub(crate) jacobian: [f64; M],
    /// Variance of the output's noise.
    pub(crate) variance: f64,
    /// Covariance of the moving states with the output before the update, and of the walks.
    pub(crate) cross: [f64; M],
    pub(crate) walk_cross: &'a [f64],
}

/// A step to the next row.
pub(super) struct Advanced<const M: usize> {
    /// Difference from the predicted point to the next one.
    pub(super) jump: [f64; M],
    /// Part of the trajectory's cost that the noise of the step adds.
    pub(super) cost: f64,
}

/// A pass in progress.
pub(super) struct Pass<'a, D, S, C, const M: usize, const Y: usize>
where
    D: Manifold<M, Y>,
{
    of: &'a Linearisation<'a, D, S, C, M, Y>,
    pub(super) stepper: Stepper<'a, D, D::Inputs, M, Y>,
    pub(super) filter: Conditional<M>,
    /// Inputs at the rows.
    pub(super) inputs: D::Inputs,
    pub(super) prior_cost: f64,
    /// Factors of the declared variances of the outputs.
    pub(super) factors: [f64; Y],
    /// Factors of the densities of the noise inputs.
    pub(super) input_factors: [f64; M],
    /// Factors of the densities of the walks.
    pub(super) walk_factors: Vec<f64>,
    /// The last step.
    pub(super) last: Step<M>,
    /// The walks over it.
    pub(super) walk_steps: Vec<WalkStep<M>>,
    /// Place of the parameter of each walk among the active ones.
    walk_places: Vec<usize>,
    /// All parameters, those that walk with their change at the row.
    parameters: Vec<f64>,
    /// Active parameter columns of the last step, M rows of them.
    pub(super) own: Vec<f64>,
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
    pub(super) fn new(
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
                tape.steps() + 1 < of.points.len() || tape.active() != of.active.len()
            })
            || change.is_some_and(|change| change.len() != of.active.len() + further)
        {
            return Err(EstimationError::InvalidArgument {
                expected: "one point a row, all parameters of the model, and one change a column",
            });
        }
        let walk_places = Self::walk_places(of)?;
        let walks = of.walks.walks;
        let mut mean = of.model.difference(&of.points[0], &of.prior);
        // The prior is of a correction of its own mean; here it counts as one of the first point.
        let covariance = match of.model.corrected(&mean.map(|component| -component)) {
            Some(corrected) => sandwich(&corrected.correction, &of.prior_covariance),
            None => of.prior_covariance,
        };
        let mut filter = Conditional::new(count, covariance, walks.len());
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
            walk_factors: vec![1.0; walks.len()],
            last: Step::still(),
            walk_steps: Vec::with_capacity(walks.len()),
            walk_places,
            parameters: of.parameters.to_vec(),
            own: vec![0.0; M * of.active.len()],
            change,
            d_parameters: vec![0.0; Y * of.model.output_parameters()],
            drive: vec![0.0; M * further],
            direct: vec![0.0; further],
        })
    }

    /// Updates with the outputs of a row; `used` gets each of them and its quantities. It is called
    /// through a pointer, so that the pass is compiled once for all callers.
    pub(super) fn observe(
        &mut self,
        row: usize,
        used: &mut dyn FnMut(&Whitened<'_>, &Taken<'_, M>),
    ) -> Result<(), EstimationError> {
        let of = self.of;
        let measured = of.series.measured(row);
        if measured.iter().all(|value| value.is_nan()) {
            return Ok(());
        }
        let mut d_moving = [[0.0; M]; Y];
        let predicted = self.predicted(row, &mut d_moving);
        let mut variance = of.series.noise_variance(row);
        for (variance, factor) in variance.iter_mut().zip(self.factors) {
            *variance *= factor;
        }
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
            self.set_direct_derivatives(output, residual);
            if self.walk_is_seen(output) {
                return Err(EstimationError::InvalidArgument {
                    expected: "walks of parameters that no output depends on",
                });
            }
            let deviation = self.filter.update(&d_moving[output], variance[output])?;
            let taken = Taken {
                cost: residual * residual / variance[output],
                jacobian: d_moving[output],
                variance: variance[output],
                cross: self.filter.cross,
                walk_cross: &self.filter.walk_cross,
            };
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

    /// Predicted outputs of a row, with their derivatives by the moving states in `d_moving` and by
    /// the parameters in [`Self::d_parameters`].
    fn predicted(&mut self, row: usize, d_moving: &mut [[f64; M]; Y]) -> [f64; Y] {
        let of = self.of;
        let mut moving = [0.0; M];
        of.model
            .place(&of.points[row], &mut moving, &mut self.inputs);
        of.series.at(row, &mut self.inputs);
        if of.model.has_chart() {
            of.model.output_jacobian_at_origin(
                of.parameters,
                &self.inputs,
                d_moving,
                &mut self.d_parameters,
            )
        } else {
            of.model.output_jacobian(
                &moving,
                of.parameters,
                &self.inputs,
                d_moving,
                &mut self.d_parameters,
            )
        }
    }

    /// Sets residual and direct derivatives of an output, from which the filter makes a whitened
    /// row.
    fn set_direct_derivatives(&mut self, output: usize, residual: f64) {
        let of = self.of;
        let q = of.model.output_parameters();
        let active = of.active.len();
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
    }

    /// Change of the moving states by a unit of each further column over the step just made.
    pub(super) fn drive(&mut self, row: usize) -> &[f64] {
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

    /// Makes the step after a row, from the tape or from the model: sets [`Self::last`], and
    /// [`Self::own`] to its active columns. Returns the difference from the predicted point to the next
    /// one.
    fn step(&mut self, row: usize) -> Result<[f64; M], EstimationError> {
        let of = self.of;
        let active = of.active.len();
        if let Some(tape) = of.tape {
            let (jump, columns) = tape.step(row, &mut self.last);
            self.own.copy_from_slice(columns);
            // Further columns may follow a parameter that is active.
            let p = of.parameters.len();
            for i in 0..M {
                for (own, index) in self.own[i * active..].iter().zip(of.active) {
                    self.stepper.columns[i * p + index] = *own;
                }
            }
            return Ok(jump);
        }
        for (index, walk) in of.walks.walks.iter().enumerate() {
            self.parameters[walk.parameter] =
                of.parameters[walk.parameter] + of.walks.change(row, index);
        }
        let predicted;
        (self.last, predicted) =
            self.stepper
                .advance(of.series, row, &of.points[row], &self.parameters)?;
        let jump = of.model.difference(&predicted, &of.points[row + 1]);
        let p = of.parameters.len();
        if let Some(corrected) = of.model.corrected(&jump) {
            self.last.correct(&corrected);
            map_columns(&corrected.point, &mut self.stepper.columns, p);
        }
        for i in 0..M {
            for (own, index) in self.own[i * active..].iter_mut().zip(of.active) {
                *own = self.stepper.columns[i * p + index];
            }
        }
        Ok(jump)
    }

    /// Predicts to the next row.
    pub(super) fn advance(&mut self, row: usize) -> Result<Advanced<M>, EstimationError> {
        let of = self.of;
        let predicted_jump = self.step(row)?;
        let mut jump = predicted_jump;
        if self.input_factors != [1.0; M] {
            for (share, factor) in self.last.shares.iter_mut().zip(self.input_factors) {
                for element in share.as_flattened_mut() {
                    *element *= factor;
                }
            }
        }
        let noise = self.last.noise();
        self.set_walk_steps(row);
        let steps = &self.walk_steps;
        self.filter.predict(&self.last.moving, &noise, steps);
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
        Ok(Advanced {
            jump: predicted_jump,
            cost: self.step_cost(row, noise, jump).ok_or(NOT_DRIVEN)?,
        })
    }
}

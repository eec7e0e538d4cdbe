//! Scores of a jump of the moving states, for every step in one backward pass.

use alloc::vec;
use alloc::vec::Vec;

use super::linearisation::{Linearisation, Whitened};
use super::walk::{WalkStep, transposed};
use super::{Columns, Manifold, Series};
use crate::error::EstimationError;

/// Score and information of a jump of the moving states in the step before a row (auxiliary
/// residuals: de Jong, Penzer, J. Amer. Statist. Assoc. 93, 1998).
#[derive(Clone, Debug, PartialEq)]
pub struct JumpScore<const M: usize> {
    /// Score of the jump: sum of products of the innovations with their derivatives by the jump. Then,
    /// for each column, the sum of products of its innovations with those derivatives.
    pub columns: Vec<[f64; M]>,
    /// Information on the jump if all columns were known.
    pub information: [[f64; M]; M],
    /// Score of a change of each reading of the row; zero for a missing one.
    pub readings: Vec<f64>,
}

/// Quantities of one output for the backward pass.
struct Seen<const M: usize> {
    /// Jacobian over the standard deviation of the innovation.
    jacobian: [f64; M],
    row: usize,
    output: usize,
    /// Reciprocal of that deviation.
    reciprocal: f64,
}

/// Score and information of a change of the moving states and walks, going backward.
struct Adjoint {
    /// Moving states and walks.
    size: usize,
    /// A change's score, then its products with each column.
    columns: Vec<f64>,
    /// By rows.
    information: Vec<f64>,
}

impl Adjoint {
    fn new(size: usize, columns: usize) -> Self {
        Self {
            size,
            columns: vec![0.0; size * columns],
            information: vec![0.0; size * size],
        }
    }

    /// Goes back over an output. Later innovations see what its update leaves, (I - g h)ᵀ; `gain` is
    /// that of moving states and walks times the deviation of the innovation.
    fn update<const M: usize>(&mut self, jacobian: &[f64; M], gain: &[f64], innovations: &[f64]) {
        let size = self.size;
        let along = |vector: &[f64]| -> f64 { vector.iter().zip(gain).map(|(a, b)| a * b).sum() };
        for (sum, value) in self.columns.chunks_exact_mut(size).zip(innovations) {
            let left = value - along(sum);
            for (sum, jacobian) in sum.iter_mut().zip(jacobian) {
                *sum += jacobian * left;
            }
        }
        for row in self.information.chunks_exact_mut(size) {
            let left = along(row);
            for (value, jacobian) in row.iter_mut().zip(jacobian) {
                *value -= left * jacobian;
            }
        }
        for column in 0..size {
            let mut left = 0.0;
            for (row, gain) in gain.iter().enumerate() {
                left += gain * self.information[row * size + column];
            }
            for (row, jacobian) in jacobian.iter().enumerate() {
                self.information[row * size + column] -= left * jacobian;
            }
        }
        for (i, one) in jacobian.iter().enumerate() {
            for (j, other) in jacobian.iter().enumerate() {
                self.information[i * size + j] += one * other;
            }
        }
    }

    /// Goes back over a step.
    fn predict<const M: usize>(&mut self, transition: &[[f64; M]; M], steps: &[WalkStep<M>]) {
        let size = self.size;
        for sum in self.columns.chunks_exact_mut(size) {
            transposed(transition, steps, sum);
        }
        for row in self.information.chunks_exact_mut(size) {
            transposed(transition, steps, row);
        }
        for i in 0..size {
            for j in 0..i {
                self.information.swap(i * size + j, j * size + i);
            }
        }
        for row in self.information.chunks_exact_mut(size) {
            transposed(transition, steps, row);
        }
    }
}

impl<D, S, C, const M: usize, const Y: usize> Linearisation<'_, D, S, C, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
    C: Columns<M, Y>,
{
    /// Passes forward and backward over the record. `watch` gets each row but the first, in falling
    /// order, with the score of a jump in the step before it.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn jumps(
        &self,
        mut watch: impl FnMut(usize, &JumpScore<M>),
    ) -> Result<(), EstimationError> {
        let rows = self.points.len();
        let count = 1 + self.active.len() + self.further.count();
        let size = M + self.walks.walks.len();
        let mut seen: Vec<Seen<M>> = Vec::with_capacity(rows * Y);
        let mut gains: Vec<f64> = Vec::with_capacity(rows * Y * size);
        let mut innovations: Vec<f64> = Vec::with_capacity(rows * Y * count);
        let mut transitions = Vec::with_capacity(rows);
        let mut walks: Vec<WalkStep<M>> = Vec::with_capacity(rows * (size - M));
        self.forward(
            &mut |whitened: &Whitened<'_>, jacobian, cross, walk_cross| {
                let reciprocal = 1.0 / whitened.deviation;
                seen.push(Seen {
                    jacobian: jacobian.map(|element| element * reciprocal),
                    row: whitened.row,
                    output: whitened.output,
                    reciprocal,
                });
                let all = cross.iter().chain(walk_cross);
                gains.extend(all.map(|element| element * reciprocal));
                innovations.extend_from_slice(whitened.columns);
            },
            &mut |transition, steps| {
                transitions.push(*transition);
                walks.extend_from_slice(steps);
            },
        )?;
        let mut adjoint = Adjoint::new(size, count);
        let mut score = JumpScore {
            columns: vec![[0.0; M]; count],
            information: [[0.0; M]; M],
            readings: vec![0.0; Y],
        };
        for row in (1..rows).rev() {
            score.readings.fill(0.0);
            while let Some(output) = seen.pop_if(|seen| seen.row == row) {
                let columns = &innovations[seen.len() * count..][..count];
                let gain = &gains[seen.len() * size..][..size];
                let along: f64 = gain.iter().zip(&adjoint.columns).map(|(a, b)| a * b).sum();
                score.readings[output.output] = (columns[0] - along) * output.reciprocal;
                adjoint.update(&output.jacobian, gain, columns);
            }
            let all = adjoint.columns.chunks_exact(size);
            for (target, sum) in score.columns.iter_mut().zip(all) {
                target.copy_from_slice(&sum[..M]);
            }
            for i in 0..M {
                score.information[i].copy_from_slice(&adjoint.information[i * size..][..M]);
            }
            watch(row, &score);
            let steps = &walks[(row - 1) * (size - M)..row * (size - M)];
            adjoint.predict(&transitions[row - 1], steps);
        }
        Ok(())
    }
}

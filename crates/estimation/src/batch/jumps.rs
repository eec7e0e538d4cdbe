//! Scores of a jump of the moving states, for every step in one backward pass.

use alloc::vec;
use alloc::vec::Vec;

use super::linearisation::{Linearisation, Whitened};
use super::step::sandwich;
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
    /// Gain times that deviation.
    gain: [f64; M],
    row: usize,
    output: usize,
    /// Reciprocal of that deviation.
    reciprocal: f64,
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
        let mut seen: Vec<Seen<M>> = Vec::with_capacity(rows * Y);
        let mut innovations: Vec<f64> = Vec::with_capacity(rows * Y * count);
        let mut transitions = Vec::with_capacity(rows);
        self.forward(
            &mut |whitened: &Whitened<'_>, jacobian, cross| {
                let reciprocal = 1.0 / whitened.deviation;
                seen.push(Seen {
                    jacobian: jacobian.map(|element| element * reciprocal),
                    gain: cross.map(|element| element * reciprocal),
                    row: whitened.row,
                    output: whitened.output,
                    reciprocal,
                });
                innovations.extend_from_slice(whitened.columns);
            },
            &mut |transition| transitions.push(*transition),
        )?;
        let mut score = JumpScore {
            columns: vec![[0.0; M]; count],
            information: [[0.0; M]; M],
            readings: vec![0.0; Y],
        };
        for row in (1..rows).rev() {
            score.readings.fill(0.0);
            while let Some(output) = seen.pop_if(|seen| seen.row == row) {
                let columns = &innovations[seen.len() * count..][..count];
                // Later innovations see what this update leaves: (I - g h)ᵀ.
                let mut left = [[0.0; M]; M];
                for i in 0..M {
                    for j in 0..M {
                        left[i][j] =
                            f64::from(u8::from(i == j)) - output.jacobian[i] * output.gain[j];
                    }
                }
                score.information = sandwich(&left, &score.information);
                for i in 0..M {
                    for j in 0..M {
                        score.information[i][j] += output.jacobian[i] * output.jacobian[j];
                    }
                }
                let along: f64 = (0..M).map(|j| output.gain[j] * score.columns[0][j]).sum();
                score.readings[output.output] = (columns[0] - along) * output.reciprocal;
                for (sum, value) in score.columns.iter_mut().zip(columns) {
                    let along: f64 = (0..M).map(|j| output.gain[j] * sum[j]).sum();
                    for i in 0..M {
                        sum[i] += output.jacobian[i] * (value - along);
                    }
                }
            }
            watch(row, &score);
            let transition = &transitions[row - 1];
            let mut transposed = [[0.0; M]; M];
            for i in 0..M {
                for j in 0..M {
                    transposed[i][j] = transition[j][i];
                }
            }
            score.information = sandwich(&transposed, &score.information);
            for sum in &mut score.columns {
                let before = *sum;
                for i in 0..M {
                    sum[i] = (0..M).map(|j| transposed[i][j] * before[j]).sum();
                }
            }
        }
        Ok(())
    }
}

//! Backward passes: corrections of a trajectory (Bryson and Frazier, whose form needs no inverse of a
//! covariance) and scores of a sudden change in every step.

use gyrocal_hypothesis::StateJump;
use nalgebra::{DMatrix, DVector};

use crate::dynamics::Linearised;
use crate::pass::Kept;

/// Corrections of a trajectory.
pub(crate) struct Smoothed {
    /// Of the states at every row.
    pub(crate) corrections: Vec<f64>,
    /// Largest multiplier of a defect of each state.
    pub(crate) multipliers: Vec<f64>,
}

/// Corrections of all states for a change of the columns.
pub(crate) fn smooth(lin: &Linearised, kept: &Kept, change: &[f64]) -> Option<Smoothed> {
    let sizes = lin.sizes?;
    let (n, y) = (sizes.states, sizes.outputs);
    let width = 1 + change.len();
    let rows = kept.covariances.len() / (n * n);
    let mut smoothed = Smoothed {
        corrections: vec![0.0; rows * n],
        multipliers: vec![0.0; n],
    };
    let whole = |values: &[f64]| -> f64 {
        let moved = values[1..]
            .iter()
            .zip(change)
            .map(|(by, change)| by * change);
        values[0] + moved.sum::<f64>()
    };
    let mut adjoint = vec![0.0; n];
    let mut seen = kept.seen.iter().rev().peekable();
    for row in (0..rows).rev() {
        while let Some(own) = seen.next_if(|seen| seen.row == row) {
            let by_states = &lin.out_by_states[(row * y + own.output) * n..][..n];
            let along: f64 = own.gain.iter().zip(&adjoint).map(|(a, b)| a * b).sum();
            let left = whole(&own.innovation) / own.variance - along;
            for (adjoint, by) in adjoint.iter_mut().zip(by_states) {
                *adjoint += by * left;
            }
        }
        let covariance = &kept.covariances[row * n * n..(row + 1) * n * n];
        let deviations = &kept.deviations[row * n * width..(row + 1) * n * width];
        for i in 0..n {
            let pulled: f64 = (0..n).map(|j| covariance[i * n + j] * adjoint[j]).sum();
            smoothed.corrections[row * n + i] =
                whole(&deviations[i * width..(i + 1) * width]) + pulled;
        }
        if row > 0 {
            for (most, own) in smoothed.multipliers.iter_mut().zip(&adjoint) {
                *most = most.max(own.abs());
            }
            adjoint = transposed(lin, row - 1, n, &adjoint);
        }
    }
    Some(smoothed)
}

/// Transposed derivative of a step times a vector.
fn transposed(lin: &Linearised, row: usize, n: usize, vector: &[f64]) -> Vec<f64> {
    let by_states = &lin.by_states[row * n * n..(row + 1) * n * n];
    (0..n)
        .map(|j| (0..n).map(|i| by_states[i * n + j] * vector[i]).sum())
        .collect()
}

/// Score and information of a change of the states in each step, by the row that ends it; `covariance` is
/// that of the columns of the pass.
pub(crate) fn jumps(
    lin: &Linearised,
    kept: &Kept,
    covariance: &DMatrix<f64>,
) -> Option<Vec<Option<StateJump>>> {
    let sizes = lin.sizes?;
    let (n, y) = (sizes.states, sizes.outputs);
    let width = 1 + covariance.nrows();
    let rows = kept.covariances.len() / (n * n);
    let mut found = vec![None; rows];
    // A vector for each column, and the information.
    let mut columns = DMatrix::<f64>::zeros(n, width);
    let mut information = DMatrix::<f64>::zeros(n, n);
    let mut seen = kept.seen.iter().rev().peekable();
    for row in (1..rows).rev() {
        let mut outputs = DVector::zeros(y);
        while let Some(own) = seen.next_if(|seen| seen.row == row) {
            let place = row * y + own.output;
            let by_states = DVector::from_row_slice(&lin.out_by_states[place * n..][..n]);
            let gain = DVector::from_row_slice(&own.gain);
            let innovation = DVector::from_row_slice(&own.innovation) / own.variance;
            let left = innovation - columns.tr_mul(&gain);
            outputs[own.output] = left[0];
            columns.ger(1.0, &by_states, &left, 1.0);
            // (I − K h)ᵀ N (I − K h) + hᵀ h / s
            let along = &information * &gain;
            let own = gain.dot(&along) + own.variance.recip();
            information.ger(-1.0, &by_states, &along, 1.0);
            information.ger(-1.0, &along, &by_states, 1.0);
            information.ger(own, &by_states, &by_states, 1.0);
        }
        let cross = columns.columns(1, width - 1).transpose();
        let projected = covariance * &cross;
        found[row] = Some(StateJump {
            score: columns.column(0).into_owned(),
            information: &information - cross.tr_mul(&projected),
            outputs,
        });
        let by_states =
            DMatrix::from_row_slice(n, n, &lin.by_states[(row - 1) * n * n..row * n * n]);
        columns = by_states.tr_mul(&columns);
        information = by_states.tr_mul(&information) * &by_states;
    }
    Some(found)
}

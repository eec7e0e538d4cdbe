//! The second pass: corrections of the whole trajectory (Bryson and Frazier, whose form needs no inverse of
//! a covariance).

use gyrocal_estimation::EstimationError;

use crate::error::PassError;
use crate::filter::Filter;
use crate::pass::{Made, Pass, Taken, Watch};
use crate::small::{apply, apply_transposed, dot};

/// Corrections of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Of the states at every row, by rows.
    pub corrections: Vec<f64>,
    /// Of the change of every walk at every row, by rows.
    pub walks: Vec<f64>,
    /// Largest multiplier of a defect of each state.
    pub multipliers: Vec<f64>,
}

/// What the backward pass needs of the forward one.
#[derive(Default)]
struct Kept {
    /// For each row the deviation of the states before its outputs.
    means: Vec<f64>,
    /// And its covariance.
    covariances: Vec<f64>,
    transitions: Vec<f64>,
    /// For each output its row and the whitened innovation over the standard deviation.
    seen: Vec<(usize, f64)>,
    /// Its Jacobian, then the gain of the states.
    vectors: Vec<f64>,
}

impl Watch for Kept {
    fn at(&mut self, _row: usize, filter: &Filter) {
        self.means.extend(filter.mean());
        self.covariances.extend_from_slice(&filter.covariance);
    }

    fn take(&mut self, taken: &Taken<'_>) {
        let whitened = &taken.whitened;
        let reciprocal = 1.0 / whitened.deviation;
        self.seen
            .push((whitened.row, whitened.columns[0] * reciprocal));
        self.vectors.extend_from_slice(taken.jacobian);
        let variance = reciprocal * reciprocal;
        self.vectors
            .extend(taken.cross.iter().map(|cross| cross * variance));
    }

    fn step(&mut self, made: &Made<'_>) -> Result<(), EstimationError> {
        self.transitions.extend_from_slice(made.by_states);
        Ok(())
    }
}

impl Pass<'_> {
    /// The correction of every point when the columns change by `change`.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn smooth(&self, change: &[f64]) -> Result<Smoothed, PassError> {
        let mut kept = Kept::default();
        self.run(Some(change), &mut kept)?;
        let (n, _) = self.sizes();
        let own = self.record.layout().states;
        let rows = self.count();
        let mut corrections = vec![0.0; rows * own];
        let count = self.further.walks.walks.len();
        let mut walks = vec![0.0; rows * count];
        let mut multipliers = vec![0.0; own];
        let (mut adjoint, mut pulled) = (vec![0.0; n], vec![0.0; n]);
        for row in (0..rows).rev() {
            while let Some((_, innovation)) = kept.seen.pop_if(|(of, _)| *of == row) {
                let vectors = kept.vectors.len() - 2 * n;
                let (jacobian, gain) = kept.vectors[vectors..].split_at(n);
                let left = innovation - dot(gain, &adjoint);
                for (adjoint, by) in adjoint.iter_mut().zip(jacobian) {
                    *adjoint += by * left;
                }
                kept.vectors.truncate(vectors);
            }
            apply(
                &kept.covariances[row * n * n..(row + 1) * n * n],
                &adjoint,
                &mut pulled,
            );
            for (sum, mean) in pulled.iter_mut().zip(&kept.means[row * n..]) {
                *sum += mean;
            }
            corrections[row * own..(row + 1) * own].copy_from_slice(&pulled[..own]);
            walks[row * count..(row + 1) * count].copy_from_slice(&pulled[own..own + count]);
            if row > 0 {
                for (most, own) in multipliers.iter_mut().zip(&adjoint) {
                    *most = f64::max(*most, own.abs());
                }
                let transition = &kept.transitions[(row - 1) * n * n..row * n * n];
                apply_transposed(transition, &mut adjoint, &mut pulled);
            }
        }
        Ok(Smoothed {
            corrections,
            walks,
            multipliers,
        })
    }
}

//! The steps of a pass, kept for passes about the same trajectory.

use alloc::vec::Vec;

use super::step::Step;

/// Linearised steps along a trajectory, kept for further passes about the same trajectory with the
/// same active parameters. Further columns may follow active parameters only.
#[derive(Clone)]
pub struct Tape<const M: usize> {
    /// Difference from the predicted point to the next one, for each step.
    jumps: Vec<[f64; M]>,
    moving: Vec<[[f64; M]; M]>,
    /// Lower triangles of the covariances that the noise inputs add.
    shares: Vec<f64>,
    /// Active parameter columns of each step, M rows of them.
    columns: Vec<f64>,
    active: usize,
}

impl<const M: usize> core::fmt::Debug for Tape<M> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Tape")
            .field("steps", &self.steps())
            .field("active", &self.active)
            .finish()
    }
}

impl<const M: usize> Tape<M> {
    /// Elements of a lower triangle.
    const TRIANGLE: usize = M * (M + 1) / 2;

    pub(crate) fn new(steps: usize, active: usize) -> Self {
        Self {
            jumps: Vec::with_capacity(steps),
            moving: Vec::with_capacity(steps),
            shares: Vec::with_capacity(steps * M * Self::TRIANGLE),
            columns: Vec::with_capacity(steps * M * active),
            active,
        }
    }

    pub(crate) fn steps(&self) -> usize {
        self.jumps.len()
    }

    /// Number of parameters that were active.
    pub(crate) fn active(&self) -> usize {
        self.active
    }

    pub(crate) fn push(&mut self, step: &Step<M>, jump: &[f64; M], columns: &[f64]) {
        self.jumps.push(*jump);
        self.moving.push(step.moving);
        for share in &step.shares {
            for (i, row) in share.iter().enumerate() {
                self.shares.extend_from_slice(&row[..=i]);
            }
        }
        self.columns.extend_from_slice(columns);
    }

    /// Sets `step` to that after a row. Returns the difference from the predicted point to the next one,
    /// and the parameter columns.
    pub(crate) fn step(&self, row: usize, step: &mut Step<M>) -> ([f64; M], &[f64]) {
        let size = M * Self::TRIANGLE;
        let mut kept = self.shares[row * size..(row + 1) * size].iter();
        for share in &mut step.shares {
            for i in 0..M {
                for j in 0..=i {
                    let element = kept.next().copied().unwrap_or(0.0);
                    (share[i][j], share[j][i]) = (element, element);
                }
            }
        }
        step.moving = self.moving[row];
        let width = M * self.active;
        (
            self.jumps[row],
            &self.columns[row * width..(row + 1) * width],
        )
    }
}

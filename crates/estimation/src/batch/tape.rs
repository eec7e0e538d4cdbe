//! The steps of a pass, kept for passes about the same trajectory.

use alloc::vec::Vec;

use super::step::Step;

/// What the model gave along a trajectory, so that further passes about the same trajectory with
/// the same parameters need not ask it again. Further columns may follow active parameters only.
#[derive(Clone)]
pub struct Tape<P, const M: usize> {
    pub(crate) steps: Vec<Step<P, M>>,
    /// Active parameter columns of each step, M rows of them.
    pub(crate) columns: Vec<f64>,
}

impl<P, const M: usize> core::fmt::Debug for Tape<P, M> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Tape")
            .field("steps", &self.steps.len())
            .finish()
    }
}

impl<P, const M: usize> Tape<P, M> {
    pub(crate) fn new(steps: usize, columns: usize) -> Self {
        Self {
            steps: Vec::with_capacity(steps),
            columns: Vec::with_capacity(steps * M * columns),
        }
    }
}

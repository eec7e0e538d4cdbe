//! Batch estimation: whole records at once, by Gauss-Newton steps about a trajectory.
//!
//! # How it works
//!
//! A record is a chain of points of the moving states ([`Manifold`]), tied by the model and
//! its noise, and read by its outputs. Linearised about a trajectory and given the constant
//! parameters, the moving states are a small Kalman filter by themselves; what they do when a
//! parameter changes is one *sensitivity column* of that filter. So one pass over the record
//! ([`Linearisation::reduce`]) eliminates the moving states and leaves the Gram matrix of
//! whitened innovation columns: the information on all parameters at once, with any number of
//! further columns ([`Columns`]) at the cost of one matrix-vector product a step. A second pass
//! ([`Linearisation::smooth`]) gives the correction of every point for a given change of the
//! parameters (Rauch, Tung, Striebel, AIAA Journal 3(8), 1965). Repeated to convergence this is
//! the iterated Kalman smoother (Bell, SIAM J. Optim. 4(3), 1994), the Gauss-Newton method on
//! all points and parameters.
//!
//! A parameter may walk at random along the record ([`Walk`]): it is then one more state of that
//! filter, which moves the others as its sensitivity column says, and its variance is a noise like
//! the others ([`Linearisation::noise_score`]).
//!
//! Memory grows with the moving states only: a point, a correction and one M × M gain a row.

mod columns;
mod filter;
mod gram;
mod jumps;
mod linearisation;
mod noise;
mod pass;
mod step;
mod tape;
mod walk;

pub use crate::manifold::{Corrected, Manifold};
pub use columns::{Columns, NoColumns};
pub use gram::Gram;
pub use jumps::JumpScore;
pub use linearisation::{Linearisation, Reduced, Smoothed, Whitened};
pub use noise::NoiseScore;
pub use tape::Tape;
pub use walk::{Walk, Walks};

/// The rows of a record, and the model's inputs over and at them.
pub trait Series<I, const Y: usize> {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Time of a row, s; rises with the rows.
    fn time_s(&self, row: usize) -> f64;

    /// Measured outputs, NaN where one is missing.
    fn measured(&self, row: usize) -> [f64; Y];

    /// Noise variance of the outputs of a row.
    fn noise_variance(&self, row: usize) -> [f64; Y];

    /// Sets the inputs that are held over an interval, which begins in the step after `row`.
    fn over(&self, row: usize, from_s: f64, to_s: f64, inputs: &mut I) {
        let _ = (row, from_s, to_s, inputs);
    }

    /// Sets the inputs that hold at a row.
    fn at(&self, row: usize, inputs: &mut I) {
        let _ = (row, inputs);
    }
}

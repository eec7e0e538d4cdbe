//! Inference from a record that is linearised about a trajectory.
//!
//! # How it works
//!
//! A record is a chain of points of the moving states, tied by the model and its noise, and read by its
//! outputs. Linearised about a trajectory it is a table of numbers ([`LinearisedRecord`]): for each step
//! the derivatives of the next states by the states and by the parameters, the covariance that each noise
//! adds, and what the trajectory differs from the model by (the *defects* of multiple shooting: Bock,
//! *Recent advances in parameter identification techniques*, 1983); for each row residuals of the outputs
//! and their derivatives. Sizes are known at run time. Three things make such tables: a generated model in
//! its moving chart ([`Trajectory`]), a generated plant, an interpreted program.
//!
//! What follows knows no model and no chart. Given the parameters, the states are a small Kalman filter;
//! what they do when a parameter changes is one *sensitivity column* of it. So one pass
//! ([`Pass::reduce`]) eliminates the states and leaves the Gram matrix of whitened innovation columns: the
//! information on all parameters at once, with any number of further [`Column`]s at the cost of one
//! matrix-vector product a step. A second one ([`Pass::smooth`]) gives the correction of every point for a
//! given change of the parameters (Bryson, Frazier, 1963, whose form needs no inverse of a covariance).
//! Repeated to convergence this is the Gauss-Newton method on all points and parameters, the iterated
//! Kalman smoother (Bell, SIAM J. Optim. 4(3), 1994). [`Pass::jumps`] has the score of a sudden change of
//! the states in every step, [`Pass::noise_score`] the likelihood of the noise with its exact derivatives.
//!
//! A parameter may walk at random along the record ([`Walk`]), and noise of an output may be correlated
//! ([`Correlated`]): each is then one more state. States may have process noise ([`Process`]).
//!
//! # What it does not do
//!
//! It chooses no parameters, has no priors but that of the first point, and takes no steps.

#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

mod augmented;
mod column;
mod error;
mod filter;
mod gram;
mod jumps;
mod noise;
mod pass;
mod profile;
mod record;
mod restricted;
mod series;
mod small;
mod smooth;
mod step;
pub mod stop;
mod trajectory;

pub use augmented::{Correlated, FurtherNoise, Process, Walk, Walks};
pub use column::{Column, ExtraColumns};
pub use error::{PassError, Singular};
pub use gram::Gram;
pub use jumps::JumpScore;
pub use noise::NoiseScore;
pub use pass::{Pass, Reduced, Whitened};
pub use profile::Maximum;
pub use record::{KeptRecord, Layout, LinearisedRecord, LinearisedRows, Start};
pub use restricted::{Asked, Restricted, RestrictedAt, UnknownNoise};
pub use series::Series;
pub use smooth::Smoothed;
pub use stop::{Stop, Stopped};
pub use trajectory::Trajectory;

//! Errors of inference.

use gyrocal_estimation::EstimationError;

use crate::stop::Stopped;

/// An information matrix that is not positive definite: some unknowns are not observable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the information matrix is not positive definite: some unknowns are not observable")]
pub struct Singular;

/// A pass over a record that fails.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PassError {
    /// Model, noise or columns do not allow it.
    #[error(transparent)]
    Estimation(#[from] EstimationError),
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

//! Errors of inference.

/// An information matrix that is not positive definite: some unknowns are not observable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the information matrix is not positive definite: some unknowns are not observable")]
pub struct Singular;

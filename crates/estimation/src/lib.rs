//! Kalman filters on generated models.
//!
//! # What it is
//!
//! [`Filter`] is a continuous-discrete extended Kalman filter for models whose state is a few
//! *moving* states and any number of *constant* parameters: navigation errors and sensor
//! coefficients, a plant and its unknown constants. It knows a model only through
//! [`gyrocal_scalar::Model`], and it is built on that structure: the transition is
//! non-trivial in the moving rows only.
//!
//! The covariance is carried as P = U D Uᵀ (Bierman, *Factorization Methods for Discrete
//! Sequential Estimation*, 1977), so it is symmetric and positive definite by construction.
//! What rounding cannot break needs no repair; a pivot that is not positive or a number that
//! is not finite is an [`EstimationError`].
//!
//! # Glossary
//!
//! | letter | meaning |
//! |---|---|
//! | n, M, Y | states, moving states, outputs |
//! | Φ, Γ | transition of the state, effect of the noise held over a step |
//! | P, U, D | error covariance and its factors: unit upper triangular, diagonal |
//! | H, R, S | output Jacobian, output noise, innovation covariance |
//! | K | gain |
//! | NIS | normalised innovation squared, νᵀ S⁻¹ ν; Y expected |
//!
//! # Features
//!
//! - `std` (default): fused multiply-add where the target has it. Nothing else needs it.
//! - `alloc`: [`VecStorage`], for a number of states known at run time.
//! - `nalgebra`: `dense`, the textbook filter on dense matrices, as a reference.
//!
//! # What it does not do
//!
//! It never repairs a covariance, never allocates in a step, and never looks into a model.

#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "nalgebra")]
pub mod dense;
mod covariance;
mod error;
mod filter;
mod innovation;
mod lanes4;
mod storage;
mod transition;

pub use error::EstimationError;
pub use filter::{Filter, Recentring};
pub use innovation::Innovation;
#[cfg(feature = "alloc")]
pub use storage::VecStorage;
pub use storage::{ArrayStorage, Buffers, Storage, View};
pub use transition::Integration;

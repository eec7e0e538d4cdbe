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
//! The covariance is carried in one of two forms ([`form`]). [`Covariance`], the default, is P
//! itself: symmetric to the last bit by the order of operations, the moving block in Joseph form
//! where a measurement removes nearly all of a wide prior. [`Factors`] are U and D of
//! P = U D Uᵀ (Bierman, *Factorization Methods for Discrete Sequential Estimation*, 1977), which
//! rounding cannot make indefinite: the form for single precision and for wide priors.
//! A variance that is not positive, digits that would cancel, or a number that is not finite is
//! an [`EstimationError`]; nothing is ever repaired.
//!
//! # Glossary
//!
//! | letter | meaning |
//! |---|---|
//! | n, M, Y | states, moving states, outputs |
//! | Φ, Γ | transition of the state, effect of the noise held over a step |
//! | P | error covariance |
//! | H, R, S | output Jacobian, output noise, innovation covariance |
//! | K, V | gain; whitened gain, Vᵀ V being what an update takes from P |
//! | NIS | normalised innovation squared, νᵀ S⁻¹ ν; Y expected |
//!
//! # Features
//!
//! - `std` (default): fused multiply-add where the target has it. Nothing else needs it.
//! - `alloc`: [`VecStorage`], for a number of states known at run time.
//! - `batch`: estimation from whole records; matrix products then use the standard library.
//! - `nalgebra`: `dense`, the textbook filter on dense matrices, as a reference.
//!
//! # What it does not do
//!
//! It never repairs a covariance, never allocates in a step, and never looks into a model.

#![no_std]
#![allow(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "batch")]
pub mod batch;
mod covariance;
#[cfg(feature = "nalgebra")]
pub mod dense;
mod error;
mod factor;
mod filter;
pub mod form;
mod innovation;
mod manifold;
mod observe;
mod projection;
mod recentring;
mod storage;
mod transition;
mod unrolled;
mod zeros;

pub use covariance::Covariance;
pub use error::EstimationError;
pub use factor::Factors;
pub use filter::Filter;
pub use innovation::Innovation;
pub use manifold::{Corrected, Manifold};
pub use recentring::Recentring;
#[cfg(feature = "alloc")]
pub use storage::VecStorage;
pub use storage::{ArrayStorage, Buffers, Storage, View};
pub use transition::Integration;

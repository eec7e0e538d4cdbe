//! Kalman filters on generated models.
//!
//! # What it is
//!
//! [`Filter`] is a continuous-discrete extended Kalman filter for models whose state is a few
//! *moving* states and any number of *constant* parameters: navigation errors and sensor
//! coefficients, a plant and its unknown constants. It uses a model only through
//! [`gyrocal_scalar::Model`], and uses this structure: the transition is non-trivial in the moving
//! rows only.
//!
//! The covariance is carried in one of two forms ([`form`]); [`Precision`] says which one a number
//! type has by default. [`Covariance`], that of `f64`, is P itself: symmetric to the last bit by the order of operations, the moving block in Joseph form
//! where a measurement removes nearly all of a wide prior. [`Factors`] are U and D of
//! P = U D Uᵀ (Bierman, *Factorization Methods for Discrete Sequential Estimation*, 1977), which
//! rounding cannot make indefinite: that of `f32`, and the one for wide priors.
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
//! # Example
//!
//! A position that drifts at an unknown constant rate, and is measured:
//!
//! ```
//! use gyrocal_estimation::{ArrayStorage, EstimationError, Filter, Integration, Recentring};
//! use gyrocal_scalar::{Model, RatesJacobian, Recentre};
//!
//! #[derive(Clone, Copy)]
//! struct Drift;
//!
//! impl Model<f64, 1, 1> for Drift {
//!     type Inputs = ();
//!     fn parameters(&self) -> usize {
//!         1
//!     }
//!     fn output_parameters(&self) -> usize {
//!         0
//!     }
//!     fn noise_parameters(&self) -> Option<[usize; 1]> {
//!         Some([0]) // noise enters the rate as the parameter does
//!     }
//!     fn rates(&self, _: &[f64; 1], parameters: &[f64], _: &()) -> [f64; 1] {
//!         [parameters[0]]
//!     }
//!     fn rates_jacobian(
//!         &self,
//!         moving: &[f64; 1],
//!         parameters: &[f64],
//!         inputs: &(),
//!         jacobian: &mut RatesJacobian<'_, f64, 1>,
//!     ) -> [f64; 1] {
//!         jacobian.parameters[0] = 1.0;
//!         jacobian.noise[0][0] = 1.0;
//!         self.rates(moving, parameters, inputs)
//!     }
//!     fn output(&self, moving: &[f64; 1], _: &[f64], _: &()) -> [f64; 1] {
//!         *moving
//!     }
//!     fn output_jacobian(
//!         &self,
//!         moving: &[f64; 1],
//!         _: &[f64],
//!         _: &(),
//!         d_moving: &mut [[f64; 1]; 1],
//!         _: &mut [f64],
//!     ) -> [f64; 1] {
//!         d_moving[0][0] = 1.0;
//!         *moving
//!     }
//! }
//! impl Recentre<f64, 1, 1> for Drift {}
//!
//! # fn main() -> Result<(), EstimationError> {
//! let storage = ArrayStorage::<f64, 1, 1, 2>::new();
//! let (rule, chart) = (Integration::RK4, Recentring::Never);
//! // Position 0 ± 1, rate 0 ± 1.
//! let mut filter = Filter::<f64, Drift, (), _, 1, 1>::new(
//!     Drift, (), rule, chart, storage, &[0.0, 0.0], &[1.0, 1.0],
//! )?;
//! for step in 1..=100 {
//!     filter.predict(1.0, &[1e-8])?; // 1 s, spectral density of the noise of the rate
//!     filter.update(&[0.5 * f64::from(step)], &[1e-4])?; // sample, variance of its noise
//! }
//! assert!((filter.state()[1] - 0.5).abs() < 4.0 * filter.sigma(1));
//! assert!(filter.sigma(1) < 1e-3);
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! - `std` (default): fused multiply-add where the target has it. Nothing else needs it.
//! - `alloc`: [`VecStorage`], for a number of states known at run time.
//! - `nalgebra`: `dense`, the textbook filter on dense matrices, as a reference.
//!
//! # What it does not do
//!
//! It never repairs a covariance, never allocates in a step, and is independent of the model.

#![no_std]
#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

#[cfg(feature = "alloc")]
extern crate alloc;

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
mod precision;
mod projection;
mod recentring;
mod storage;
mod transition;
mod unrolled;
mod zeros;

#[cfg(feature = "source")]
pub mod source;

pub use covariance::Covariance;
pub use error::EstimationError;
pub use factor::Factors;
pub use filter::Filter;
pub use innovation::Innovation;
pub use manifold::{Corrected, Manifold};
pub use precision::Precision;
pub use recentring::Recentring;
#[cfg(feature = "alloc")]
pub use storage::VecStorage;
pub use storage::{ArrayStorage, Buffers, Storage, View};
pub use transition::{Derivatives, Integration, Integrator};

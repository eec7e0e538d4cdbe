//! A filter that finds the friction of a cart with a hanging pole. README.md shows the way here.

gyrocal_scalar::generated! {
    /// The model, with exact Jacobians.
    pub mod cart_pole
}
pub mod random;
pub mod simulation;

use gyrocal_estimation::{ArrayStorage, EstimationError, Filter, Integration, Recentring};

use cart_pole::{CartPole, CartPoleInputs};

/// Four moving states, two parameters, two outputs.
pub type CartPoleFilter =
    Filter<f64, CartPole, CartPoleInputs<f64>, ArrayStorage<f64, 4, 2, 6>, 4, 2>;

/// Variances of the noise of the sensors: 1 mm and 2 mrad.
pub const SENSORS: [f64; 2] = [1e-6, 4e-6];
/// Spectral densities of force, N² s, and torque, N² m² s; there are no others.
pub const GUSTS: [f64; 4] = [1e-4, 1e-8, 0.0, 0.0];
/// Mean of the prior: rest, and friction of 1 N s/m and 0.01 N m s.
pub const MEAN: [f64; 6] = [0.0, 0.0, 0.0, 0.0, 1.0, 0.01];
/// Its standard deviations.
pub const PRIOR: [f64; 6] = [0.01, 0.02, 0.02, 0.05, 0.5, 0.005];

/// A filter at rest.
///
/// # Errors
/// As [`Filter::new`].
pub fn filter() -> Result<CartPoleFilter, EstimationError> {
    let (storage, inputs) = (ArrayStorage::new(), CartPoleInputs { drive: [0.0] });
    let (rule, chart) = (Integration::RK4, Recentring::Never);
    Filter::new(CartPole, inputs, rule, chart, storage, &MEAN, &PRIOR)
}

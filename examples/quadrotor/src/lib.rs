//! A filter for the attitude of a quadrotor and the biases of its gyros. README.md shows the way here.

gyrocal_scalar::generated! {
    /// The model, with exact Jacobians.
    pub mod quadrotor
}
pub mod random;
pub mod simulation;

use gyrocal_estimation::{ArrayStorage, EstimationError, Filter, Integration, Recentring};

use quadrotor::{Quadrotor, QuadrotorInputs};

/// Three moving states, three parameters, six outputs.
pub type AttitudeFilter =
    Filter<f64, Quadrotor, QuadrotorInputs<f64>, ArrayStorage<f64, 3, 6, 6>, 3, 6>;

/// Variances of the noise of accelerometers, (0.02 g)², and magnetometer, (0.03 of the field)².
pub const SENSORS: [f64; 6] = [4e-4, 4e-4, 4e-4, 9e-4, 9e-4, 9e-4];
/// Spectral densities of the noise of the gyros, rad²/s.
pub const GYROS: [f64; 3] = [1e-6; 3];
/// Standard deviations of the prior: angles, rad, and biases, rad/s.
pub const PRIOR: [f64; 6] = [0.05, 0.05, 0.1, 0.02, 0.02, 0.02];

/// A filter of a quadrotor that is level and heads north.
///
/// # Errors
/// As [`Filter::new`].
pub fn filter() -> Result<AttitudeFilter, EstimationError> {
    let (storage, inputs) = (ArrayStorage::new(), QuadrotorInputs { omega: [0.0; 3] });
    let (rule, chart) = (Integration::RK4, Recentring::Never);
    Filter::new(Quadrotor, inputs, rule, chart, storage, &[0.0; 6], &PRIOR)
}

//! Number and indices of the drift coefficients.

use gyrocal::generated::surveyed::parameters_index as index;

/// Number of drift coefficients.
pub(crate) const PARAMETERS: usize = gyrocal::Platform::PARAMETERS;

/// Indices of the constant drifts of gyros x, y, z among the coefficients.
pub const BIASES: [usize; 3] = [index::GYRO_X_BIAS, index::GYRO_Y_BIAS, index::GYRO_Z_BIAS];

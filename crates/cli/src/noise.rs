//! Advice on declared noise.

/// Advice if a fit does not converge because of such a noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

//! The noise that is believed of a record.

/// The noise that is believed of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseModel {
    /// Standard deviation of the accelerometers over the declared one.
    pub accel_ratio: [f64; 3],
    /// Standard deviation of the gyros' white noise over the declared one.
    pub gyro_ratio: [f64; 3],
    /// Random walk of the gyros' constant drift, deg/h/√h; zero for none.
    pub gyro_walk_deg_per_h_per_sqrt_h: [f64; 3],
    /// Weight of each value, if some are not trusted: 0 leaves a value out.
    pub weights: Option<Vec<[f64; 3]>>,
}

impl Default for NoiseModel {
    /// As declared.
    fn default() -> Self {
        Self {
            accel_ratio: [1.0; 3],
            gyro_ratio: [1.0; 3],
            gyro_walk_deg_per_h_per_sqrt_h: [0.0; 3],
            weights: None,
        }
    }
}

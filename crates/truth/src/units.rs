//! Units whose axes are not those of a platform: their noise at rest, their tests, their records in motion.

pub mod position_test;
pub mod sensor_noise;
pub mod strapdown;

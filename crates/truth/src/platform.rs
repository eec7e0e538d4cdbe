//! A platform on a bench.

use libm::{cos, sin};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;

/// Rotation rate of the Earth (WGS 84).
pub const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;

/// A platform on a bench at one site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Platform {
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Specific force at rest in the accelerometers' unit; 1 if that is local gravity.
    pub specific_force_at_rest_g: f64,
    /// Drift coefficients of its gyros.
    pub coefficients: Coefficients,
    /// Platform against local east, north, up at time zero.
    pub initial_platform_c_enu: Attitude,
}

impl Platform {
    /// The Earth's rate in local east, north, up \[rad/s\].
    #[must_use]
    pub fn earth_rate_enu_rad_per_s(&self) -> [f64; 3] {
        let latitude_rad = self.latitude_deg.to_radians();
        [0.0, cos(latitude_rad), sin(latitude_rad)].map(|part| EARTH_RATE_RAD_PER_S * part)
    }
}

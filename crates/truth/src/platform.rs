//! The platform without noise.

use libm::{cos, sin};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;
use crate::motion::Motion;

/// Rotation rate of the Earth (WGS 84).
pub const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;

/// A platform on a bench at one site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Platform {
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Specific force at rest in the accelerometers' unit; 1 if that is local gravity.
    pub specific_force_at_rest_g: f64,
    /// What its gyros do.
    pub coefficients: Coefficients,
    /// Platform against local east, north, up at time zero.
    pub initial_platform_c_enu: Attitude,
}

impl Platform {
    /// What ideal accelerometers read in platform axes \[g\] at times since time zero.
    ///
    /// Times that rise are simulated in one pass; a time that goes back starts another.
    #[must_use]
    pub fn specific_force_g(&self, times_s: &[f64]) -> Vec<[f64; 3]> {
        self.at_times(times_s, |motion| motion.moment().accel_g)
    }

    /// The platform against local east, north, up at times since time zero.
    ///
    /// Times that rise are simulated in one pass; a time that goes back starts another.
    #[must_use]
    pub fn platform_c_enu(&self, times_s: &[f64]) -> Vec<Attitude> {
        self.at_times(times_s, |motion| motion.platform_c_enu())
    }

    /// The Earth's rate in local east, north, up \[rad/s\].
    #[must_use]
    pub fn earth_rate_enu_rad_per_s(&self) -> [f64; 3] {
        let latitude_rad = self.latitude_deg.to_radians();
        [
            0.0,
            EARTH_RATE_RAD_PER_S * cos(latitude_rad),
            EARTH_RATE_RAD_PER_S * sin(latitude_rad),
        ]
    }

    fn at_times<T>(&self, times_s: &[f64], see: impl Fn(&Motion<'_>) -> T) -> Vec<T> {
        let mut motion = Motion::new(self);
        let advance = |time_s: &f64| {
            if *time_s < motion.moment().time_s {
                motion = Motion::new(self);
            }
            motion.advance_to(*time_s, [0.0; 3], 0.0);
            see(&motion)
        };
        times_s.iter().map(advance).collect()
    }
}

use gyrocal_scalar::Scalar;

/// Sidereal rotation rate of the Earth in rad/s (WGS 84, NIMA TR8350.2).
pub const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;

/// Site of the platform: latitude, Earth rate and gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site<T> {
    /// Astronomic latitude in rad, north positive.
    pub latitude_rad: T,
    /// Sidereal rotation rate of the Earth in rad/s.
    pub earth_rate_rad_per_s: T,
    /// Local gravity in the unit of the accelerometer data: 1 if that is local gravity.
    pub gravity_g: T,
}

impl<T: Scalar> Site<T> {
    /// A site at the given astronomic latitude in rad whose data are in units of local gravity: for
    /// a latitude that is known at run time where `f64` is slow.
    #[must_use]
    pub fn at_latitude_rad(latitude_rad: T) -> Self {
        Self {
            latitude_rad,
            earth_rate_rad_per_s: T::from_f64(EARTH_RATE_RAD_PER_S),
            gravity_g: T::from_f64(1.0),
        }
    }

    /// A site at the given astronomic latitude whose data are in units of local gravity.
    #[must_use]
    pub fn at_latitude_deg(latitude_deg: f64) -> Self {
        Self::at_latitude_rad(T::from_f64(latitude_deg.to_radians()))
    }
}

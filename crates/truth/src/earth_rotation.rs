//! Rotation of the Earth: vectors fixed to the bench, in inertial space.

use libm::{cos, sin, sincos};

use crate::attitude::{Attitude, cross, dot};

/// Rotation of the bench about the Earth's axis since time zero, when the inertial frame was its
/// east, north, up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EarthRotation {
    axis_enu: [f64; 3],
    half_rate_rad_per_s: f64,
    up: RotatingVector,
    field: Option<RotatingVector>,
}

/// Sine and cosine of half the Earth's rotation angle since time zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EarthAngle {
    sin_half: f64,
    cos_half: f64,
}

/// A vector that turns with the Earth: `still + across cos + ahead sin`.
#[derive(Debug, Clone, Copy)]
struct RotatingVector {
    still: [f64; 3],
    across: [f64; 3],
    ahead: [f64; 3],
}

impl EarthRotation {
    pub(crate) fn new(
        latitude_deg: f64,
        earth_rate_rad_per_s: f64,
        specific_force_at_rest_g: f64,
        field_enu_gauss: Option<[f64; 3]>,
    ) -> Self {
        let latitude_rad = latitude_deg.to_radians();
        let axis_enu = [0.0, cos(latitude_rad), sin(latitude_rad)];
        Self {
            axis_enu,
            half_rate_rad_per_s: 0.5 * earth_rate_rad_per_s,
            up: RotatingVector::new([0.0, 0.0, specific_force_at_rest_g], axis_enu),
            field: field_enu_gauss.map(|field| RotatingVector::new(field, axis_enu)),
        }
    }

    pub(crate) fn angle_at(&self, time_s: f64) -> EarthAngle {
        let (sin_half, cos_half) = sincos(self.half_rate_rad_per_s * time_s);
        EarthAngle { sin_half, cos_half }
    }

    /// Local east, north, up against the inertial frame.
    pub(crate) fn enu_c_inertial(&self, earth_angle: EarthAngle) -> Attitude {
        Attitude::from_axis(self.axis_enu, earth_angle.cos_half, earth_angle.sin_half)
    }

    /// Specific force at rest, in the inertial frame.
    pub(crate) fn up_inertial_g(&self, earth_angle: EarthAngle) -> [f64; 3] {
        self.up.at(earth_angle)
    }

    /// The Earth's field in the inertial frame, if it is known.
    pub(crate) fn field_inertial_gauss(&self, earth_angle: EarthAngle) -> Option<[f64; 3]> {
        self.field.map(|field| field.at(earth_angle))
    }
}

impl RotatingVector {
    fn new(vector: [f64; 3], axis: [f64; 3]) -> Self {
        let along = dot(vector, axis);
        let still = axis.map(|component| component * along);
        Self {
            still,
            across: core::array::from_fn(|i| vector[i] - still[i]),
            ahead: cross(axis, vector),
        }
    }

    fn at(&self, earth_angle: EarthAngle) -> [f64; 3] {
        let cosine = 1.0 - 2.0 * earth_angle.sin_half * earth_angle.sin_half;
        let sine = 2.0 * earth_angle.sin_half * earth_angle.cos_half;
        core::array::from_fn(|i| self.still[i] + cosine * self.across[i] + sine * self.ahead[i])
    }
}

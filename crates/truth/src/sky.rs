//! The turn of the Earth: what is fixed to the bench, seen in inertial space.

use libm::{cos, sin, sincos};

use crate::attitude::{Attitude, cross, dot};

/// The bench's turn about the Earth's axis since time zero, when the inertial frame was its
/// east, north, up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sky {
    axis_enu: [f64; 3],
    half_rate_rad_per_s: f64,
    up: Swept,
    field: Option<Swept>,
}

/// Where the Earth stands at one time: half the angle that it has turned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hand {
    sin_half: f64,
    cos_half: f64,
}

/// A vector that turns with the Earth: `still + across cos + ahead sin`.
#[derive(Debug, Clone, Copy)]
struct Swept {
    still: [f64; 3],
    across: [f64; 3],
    ahead: [f64; 3],
}

impl Sky {
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
            up: Swept::new([0.0, 0.0, specific_force_at_rest_g], axis_enu),
            field: field_enu_gauss.map(|field| Swept::new(field, axis_enu)),
        }
    }

    pub(crate) fn hand_at(&self, time_s: f64) -> Hand {
        let (sin_half, cos_half) = sincos(self.half_rate_rad_per_s * time_s);
        Hand { sin_half, cos_half }
    }

    /// Local east, north, up against the inertial frame.
    pub(crate) fn enu_c_inertial(&self, hand: Hand) -> Attitude {
        Attitude::from_axis(self.axis_enu, hand.cos_half, hand.sin_half)
    }

    /// Specific force at rest, in the inertial frame.
    pub(crate) fn up_inertial_g(&self, hand: Hand) -> [f64; 3] {
        self.up.at(hand)
    }

    /// The Earth's field in the inertial frame, if it is known.
    pub(crate) fn field_inertial_gauss(&self, hand: Hand) -> Option<[f64; 3]> {
        self.field.map(|field| field.at(hand))
    }
}

impl Swept {
    fn new(vector: [f64; 3], axis: [f64; 3]) -> Self {
        let along = dot(vector, axis);
        let still = axis.map(|component| component * along);
        Self {
            still,
            across: [0, 1, 2].map(|i| vector[i] - still[i]),
            ahead: cross(axis, vector),
        }
    }

    fn at(&self, hand: Hand) -> [f64; 3] {
        let cosine = 1.0 - 2.0 * hand.sin_half * hand.sin_half;
        let sine = 2.0 * hand.sin_half * hand.cos_half;
        [0, 1, 2].map(|i| self.still[i] + cosine * self.across[i] + sine * self.ahead[i])
    }
}

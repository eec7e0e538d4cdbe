//! Units of the sensors of a log.

use serde::{Deserialize, Serialize};

use super::names::named_units;

/// Names of the units of a rate.
pub(super) const RAD_PER_S: &[&str] = &["rad/s", "rad/sec"];
pub(super) const DEG_PER_S: &[&str] = &["deg/s", "deg/sec", "°/s", "º/s", "dps"];
pub(super) const DEG_PER_H: &[&str] = &["deg/h", "deg/hr", "°/h", "º/h", "dph"];

named_units! {
    /// Units of a rate.
    GyroUnit {
        /// rad/s
        RadPerS = RAD_PER_S,
        /// deg/s
        DegPerS = DEG_PER_S,
        /// deg/h
        DegPerH = DEG_PER_H,
        /// Raw counts.
        Counts = &["counts"],
    }
}

named_units! {
    /// Units of specific force.
    AccelUnit {
        /// m/s²
        MetrePerS2 = &["m/s2", "m/s²", "m/s^2", "m/s/s"],
        /// ft/s²
        FootPerS2 = &["ft/s2", "ft/s²", "ft/s^2", "ft/s/s"],
        /// Local gravity.
        G = &["g", "G"],
        /// Thousandths of local gravity.
        MilliG = &["mg"],
        /// Millionths of local gravity.
        MicroG = &["ug", "µg", "μg"],
        /// Raw counts.
        Counts = &["counts"],
    }
}

/// Scale of raw counts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum CountScale {
    /// Counts per unit, the same for all axes.
    Same(f64),
    /// Counts per unit of each axis.
    Each([f64; 3]),
    /// Estimated from the recording.
    Estimate(Estimate),
}

/// Source of an estimated scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Estimate {
    /// Turns between stops.
    #[serde(rename = "from-turns")]
    FromTurns,
    /// The norm of specific force at rest.
    #[serde(rename = "from-stops")]
    FromStops,
}

/// Metres in a foot (international foot of 1959).
const METRES_PER_FOOT: f64 = 0.3048;

impl AccelUnit {
    /// Whether local gravity takes part in the conversion to g.
    #[must_use]
    pub fn needs_gravity(self) -> bool {
        matches!(self, Self::MetrePerS2 | Self::FootPerS2)
    }

    /// One unit in local g, where local gravity is this \[m/s²\]; `None` of counts.
    #[must_use]
    pub fn in_g(self, gravity_m_per_s2: f64) -> Option<f64> {
        match self {
            Self::MetrePerS2 => Some(1.0 / gravity_m_per_s2),
            Self::FootPerS2 => Some(METRES_PER_FOOT / gravity_m_per_s2),
            Self::G => Some(1.0),
            Self::MilliG => Some(1e-3),
            Self::MicroG => Some(1e-6),
            Self::Counts => None,
        }
    }
}

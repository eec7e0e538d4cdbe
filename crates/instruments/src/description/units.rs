//! Units of the sensors of a log.

use serde::{Deserialize, Serialize};

/// Units of a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum GyroUnit {
    /// rad/s
    #[serde(rename = "rad/s", alias = "rad/sec")]
    RadPerS,
    /// deg/s
    #[serde(
        rename = "deg/s",
        alias = "deg/sec",
        alias = "°/s",
        alias = "º/s",
        alias = "dps"
    )]
    DegPerS,
    /// deg/h
    #[serde(
        rename = "deg/h",
        alias = "deg/hr",
        alias = "°/h",
        alias = "º/h",
        alias = "dph"
    )]
    DegPerH,
    /// Raw counts.
    #[serde(rename = "counts")]
    Counts,
}

/// Units of specific force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum AccelUnit {
    /// m/s²
    #[serde(rename = "m/s2", alias = "m/s²", alias = "m/s^2", alias = "m/s/s")]
    MetrePerS2,
    /// ft/s²
    #[serde(rename = "ft/s2", alias = "ft/s²", alias = "ft/s^2", alias = "ft/s/s")]
    FootPerS2,
    /// Local gravity.
    #[serde(rename = "g", alias = "G")]
    G,
    /// Thousandths of local gravity.
    #[serde(rename = "mg")]
    MilliG,
    /// Millionths of local gravity.
    #[serde(rename = "ug", alias = "µg", alias = "μg")]
    MicroG,
    /// Raw counts.
    #[serde(rename = "counts")]
    Counts,
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

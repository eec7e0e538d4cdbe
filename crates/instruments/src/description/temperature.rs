//! Temperature of a record.

use serde::{Deserialize, Serialize};

/// A column of temperature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Temperature {
    /// The column. Empty cells are interpolated between their neighbours in time: temperature is often
    /// logged more slowly.
    pub column: String,
    /// Its unit.
    #[serde(default)]
    pub unit: TemperatureUnit,
}

/// Units of temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum TemperatureUnit {
    /// °C
    #[default]
    #[serde(
        rename = "C",
        alias = "degC",
        alias = "°C",
        alias = "ºC",
        alias = "Celsius"
    )]
    Celsius,
    /// K
    #[serde(rename = "K", alias = "Kelvin")]
    Kelvin,
    /// °F
    #[serde(
        rename = "F",
        alias = "degF",
        alias = "°F",
        alias = "ºF",
        alias = "Fahrenheit"
    )]
    Fahrenheit,
}

impl TemperatureUnit {
    /// A temperature of this unit in °C.
    #[must_use]
    pub fn celsius(self, value: f64) -> f64 {
        match self {
            Self::Celsius => value,
            Self::Kelvin => value - 273.15,
            Self::Fahrenheit => (value - 32.0) / 1.8,
        }
    }
}

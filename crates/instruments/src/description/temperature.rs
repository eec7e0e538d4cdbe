//! Temperature of a record.

use serde::{Deserialize, Serialize};

use super::names::named_units;

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

named_units! {
    /// Units of temperature.
    TemperatureUnit {
        /// °C
        Celsius = &["C", "degC", "°C", "ºC", "Celsius"],
        /// K
        Kelvin = &["K", "Kelvin"],
        /// °F
        Fahrenheit = &["F", "degF", "°F", "ºF", "Fahrenheit"],
    }
}

#[expect(clippy::derivable_impls, reason = "units of a table derive no default")]
impl Default for TemperatureUnit {
    fn default() -> Self {
        Self::Celsius
    }
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

//! Rate or angle of a turntable.

use serde::{Deserialize, Serialize};

use super::names::named_units;
use super::units::{DEG_PER_H, DEG_PER_S, RAD_PER_S};

/// Rate or angle of the turntable that carries the unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TableColumn {
    /// The column: mean rate over the interval that ends at its time stamp, or the angle at its end.
    pub column: String,
    /// Its unit. An angle may begin again after a turn.
    pub unit: TableUnit,
    /// Axis of the table in body axes, right-handed, of any length; along specific force, up, if it is not
    /// given.
    pub axis: Option<[f64; 3]>,
}

named_units! {
    /// Units of the rate or the angle of a turntable.
    TableUnit {
        /// rad/s
        RadPerS = RAD_PER_S,
        /// deg/s
        DegPerS = DEG_PER_S,
        /// deg/h
        DegPerH = DEG_PER_H,
        /// Radians.
        Rad = &["rad"],
        /// Degrees.
        Deg = &["deg", "°", "º"],
    }
}

impl TableColumn {
    pub(crate) fn has_axis(&self) -> bool {
        let finite = |axis: [f64; 3]| axis.iter().all(|component| component.is_finite());
        self.axis
            .is_none_or(|axis| finite(axis) && axis.iter().any(|component| *component != 0.0))
    }

    /// Mean rates over the intervals of the samples \[rad/s\], from values of the column.
    pub(crate) fn rates(&self, values: &[f64], time_s: &[f64]) -> Vec<f64> {
        let factor = match self.unit {
            TableUnit::RadPerS | TableUnit::Rad => 1.0,
            TableUnit::DegPerS | TableUnit::Deg => 1.0_f64.to_radians(),
            TableUnit::DegPerH => 1.0_f64.to_radians() / 3600.0,
        };
        if !matches!(self.unit, TableUnit::Rad | TableUnit::Deg) {
            return values.iter().map(|value| factor * value).collect();
        }
        let turn = core::f64::consts::TAU;
        let rate = |sample: usize| {
            // The first sample has no angle before it: the rate of the next stands for it.
            let sample = sample.max(1);
            let step = factor * (values[sample] - values[sample - 1]);
            let step = step - turn * (step / turn).round();
            step / (time_s[sample] - time_s[sample - 1])
        };
        (0..values.len()).map(rate).collect()
    }
}

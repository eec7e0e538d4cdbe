//! Columns of a log beside those of the sensors: temperature, and rate or angle of a turntable.

use gyrocal_record::InputErrorKind;
use serde::{Deserialize, Serialize};

use crate::columns::FileColumns;
use crate::description::Temperature;
use crate::description::temperature::TemperatureUnit;
use crate::error::{InstrumentError, Unfit};

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

/// Units of the rate or the angle of a turntable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum TableUnit {
    /// rad/s
    #[serde(rename = "rad/s")]
    RadPerS,
    /// deg/s
    #[serde(rename = "deg/s")]
    DegPerS,
    /// deg/h
    #[serde(rename = "deg/h")]
    DegPerH,
    /// Radians.
    #[serde(rename = "rad")]
    Rad,
    /// Degrees.
    #[serde(rename = "deg")]
    Deg,
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

/// Temperatures of units at work \[degrees Celsius\].
const PLAUSIBLE_C: core::ops::RangeInclusive<f64> = -100.0..=250.0;

/// Units and their names in a description.
const UNITS: [(TemperatureUnit, &str); 3] = [
    (TemperatureUnit::Celsius, "C"),
    (TemperatureUnit::Kelvin, "K"),
    (TemperatureUnit::Fahrenheit, "F"),
];

/// Temperatures of a laboratory or a vehicle, by which another unit is recognised.
const USUAL_C: core::ops::RangeInclusive<f64> = -60.0..=130.0;

/// Temperatures of a column \[degrees Celsius\].
pub(crate) fn temperatures_c(
    file: &FileColumns,
    values: &[f64],
    column: &Temperature,
) -> Result<Vec<f64>, InstrumentError> {
    let of = |value: &f64| column.unit.celsius(*value);
    let celsius: Vec<f64> = values.iter().map(of).collect();
    let Some(row) = celsius
        .iter()
        .position(|value| !PLAUSIBLE_C.contains(value))
    else {
        return Ok(celsius);
    };
    let others = UNITS
        .iter()
        .filter(|(unit, _)| *unit != column.unit && USUAL_C.contains(&unit.celsius(values[row])));
    let others: Vec<String> = others
        .map(|(_, name)| format!("`unit = \"{name}\"`"))
        .collect();
    let advice = match &others[..] {
        [] => "check `column` and `unit` in `[temperature]`".to_owned(),
        others => format!(
            "the unit may be another: {} in `[temperature]`",
            others.join(" or ")
        ),
    };
    let found = format!("a temperature of {:.2} degrees Celsius", celsius[row]);
    let expected = "-100 to 250";
    Err(file.error_at(
        row,
        InputErrorKind::OutOfRange,
        Unfit::Temperature,
        [&found, expected, &advice],
    ))
}

/// Samples in a row at the end of the range of a gyro that are no chance.
const SATURATED_SAMPLES: usize = 10;

/// Fewest different values of a column that moves through a range; a gyro at rest in coarse steps has few.
const FEWEST_VALUES: usize = 64;

/// Refuses a gyro that stays at the end of its range.
pub(crate) fn refuse_saturated(
    file: &FileColumns,
    values: &[f64],
    name: &str,
) -> Result<(), InstrumentError> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for end in [low, high] {
        let at_end = |window: &[f64]| window.iter().all(|value| *value == end);
        let Some(row) = values.windows(SATURATED_SAMPLES).position(at_end) else {
            continue;
        };
        let mut different: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        different.sort_unstable();
        different.dedup();
        if different.len() < FEWEST_VALUES {
            return Ok(());
        }
        let count = values.iter().filter(|value| **value == end).count();
        let found = format!("{count} samples of `{name}` at the end of its range, {end}");
        return Err(file.error_at(
            row,
            InputErrorKind::OutOfRange,
            Unfit::Saturated,
            [
                &found,
                "rates within the range of the gyro",
                "cut the log where the gyro is saturated, turn more slowly, or choose a larger range",
            ],
        ));
    }
    Ok(())
}

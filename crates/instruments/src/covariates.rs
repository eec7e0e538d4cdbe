//! Checks of the columns of a log: temperatures in another unit, saturated gyros.

use core::ops::Range;

use gyrocal_record::InputErrorKind;

use crate::columns::FileColumns;
use crate::description::Temperature;
use crate::description::temperature::TemperatureUnit;
use crate::error::{InstrumentError, Unfit};

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
    let expected = format!("{} to {}", PLAUSIBLE_C.start(), PLAUSIBLE_C.end());
    Err(file.error_at(
        row,
        InputErrorKind::OutOfRange,
        Unfit::Temperature,
        [&found, &expected, &advice],
    ))
}

/// Samples in a row at the end of the range of a gyro that are no chance.
const SATURATED_SAMPLES: usize = 10;

/// Fewest different values of a column that moves through a range; a gyro at rest in coarse steps has few.
const FEWEST_VALUES: usize = 64;

/// Samples in a row of a gyro at the end of its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Saturated {
    /// Name of the column.
    pub column: String,
    /// The end of the range, in the unit of the column.
    pub end: f64,
    /// The samples.
    pub samples: Range<usize>,
}

/// Stretches of a gyro that stays at an end of its range: all samples there, if so many follow one another that this is
/// no chance.
pub(crate) fn saturated(values: &[f64], column: &str) -> Vec<Saturated> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut all = Vec::new();
    for end in [low, high] {
        let mut runs = Vec::new();
        let mut from = 0;
        for run in values.chunk_by(|one, next| (*one == end) == (*next == end)) {
            if run[0] == end {
                runs.push(from..from + run.len());
            }
            from += run.len();
        }
        if runs.iter().any(|run| run.len() >= SATURATED_SAMPLES) {
            all.extend(runs.into_iter().map(|samples| Saturated {
                column: column.to_owned(),
                end,
                samples,
            }));
        }
    }
    let mut different: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
    different.sort_unstable();
    different.dedup();
    if different.len() < FEWEST_VALUES {
        all.clear();
    }
    all
}

/// Refuses gyros that stay at the end of their range.
pub(crate) fn refuse_saturated(
    file: &FileColumns,
    saturated: &[Saturated],
) -> Result<(), InstrumentError> {
    let mut stretches = saturated.iter();
    let Some(first) = stretches.find(|one| one.samples.len() >= SATURATED_SAMPLES) else {
        return Ok(());
    };
    let (column, end) = (&first.column, first.end);
    let same = saturated
        .iter()
        .filter(|one| one.column == *column && one.end == end);
    let count: usize = same.map(|one| one.samples.len()).sum();
    let found = format!("{count} samples of `{column}` at the end of its range, {end}");
    Err(file.error_at(
        first.samples.start,
        InputErrorKind::OutOfRange,
        Unfit::Saturated,
        [
            &found,
            "rates within the range of the gyro",
            "cut the log where the gyro is saturated, turn more slowly, or choose a larger range",
        ],
    ))
}

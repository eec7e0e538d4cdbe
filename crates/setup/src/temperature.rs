//! Unit of the temperature, and values that cannot be temperatures.

use gyrocal_statistics::quantile;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::text::{number, row, rows, span};

/// Temperatures of instruments at work \[°C\].
const PLAUSIBLE_C: core::ops::RangeInclusive<f64> = -100.0..=250.0;

/// Those of a laboratory or a vehicle, by which kelvins are recognised. Below 250 K (-23 °C) kelvins are plausible
/// in °C and are left; so are most degrees Fahrenheit, others read as kelvins.
const USUAL_C: core::ops::RangeInclusive<f64> = -60.0..=130.0;

/// 0 °C in kelvins.
const ZERO_C_K: f64 = 273.15;

/// Values that cannot be temperatures in °C: kelvins are converted, what is left is interpolated.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let Some(column) = &mut samples.temperature_c else {
        return Vec::new();
    };
    let wrong = implausible(column);
    if wrong.is_empty() {
        return Vec::new();
    }
    let first = column[wrong[0]];
    let evidence = format!(
        "{} in row {}; {} outside of {} to {}",
        number(first),
        row(wrong[0]),
        rows(wrong.len()),
        PLAUSIBLE_C.start(),
        PLAUSIBLE_C.end()
    );
    // The unit is that of all rows.
    if 2 * wrong.len() > column.len() && is_in_kelvins(column) {
        let description = "Temperature is not in degrees Celsius. It seems to be in K, from which it was \
                           converted. Write the column in degrees Celsius (subtract 273.15), or give its unit in \
                           a map (--columns MAP.toml)."
            .to_owned();
        for value in column.iter_mut() {
            *value -= ZERO_C_K;
        }
        let rest = implausible(column);
        interpolate(column, &rest);
        let finding = SetupFinding::new(SetupKind::Temperature, description, evidence);
        return vec![finding.at(span(&wrong))];
    }
    let left_out = wrong.len() == column.len();
    let done = if left_out {
        samples.temperature_c = None;
        "The column was left out"
    } else {
        interpolate(column, &wrong);
        "They were interpolated"
    };
    let description = format!(
        "Values that cannot be temperatures in °C. {done}. Check the sensor and the column, and leave its codes \
         of missing values out."
    );
    let finding = SetupFinding::new(SetupKind::Temperature, description, evidence);
    vec![finding.at(span(&wrong))]
}

fn implausible(column: &[f64]) -> Vec<usize> {
    let rows = column.iter().enumerate();
    rows.filter(|(_, value)| !PLAUSIBLE_C.contains(*value))
        .map(|(row, _)| row)
        .collect()
}

/// Whether the middle of a column is a usual temperature in kelvins.
fn is_in_kelvins(column: &[f64]) -> bool {
    let finite = column.iter().copied().filter(|value| value.is_finite());
    let finite: Vec<f64> = finite.collect();
    !finite.is_empty() && USUAL_C.contains(&(quantile(&finite, 0.5) - ZERO_C_K))
}

/// Replaces some rows by the values between those beside them.
fn interpolate(column: &mut [f64], wrong: &[usize]) {
    let good: Vec<usize> = (0..column.len())
        .filter(|row| wrong.binary_search(row).is_err())
        .collect();
    for row in wrong {
        let after = good.partition_point(|other| other < row);
        let next = good.get(after).copied();
        let last = after.checked_sub(1).map(|before| good[before]);
        column[*row] = match (last, next) {
            (Some(last), Some(next)) => {
                let share = (row - last) as f64 / (next - last) as f64;
                column[last] + share * (column[next] - column[last])
            }
            (Some(beside), None) | (None, Some(beside)) => column[beside],
            (None, None) => continue,
        };
    }
}

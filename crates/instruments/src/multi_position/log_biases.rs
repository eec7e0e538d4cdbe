//! Biases of the gyros that differ between the logs of one test.

use gyrocal_statistics::f_tail;
use nalgebra::DMatrix;
use serde::Serialize;

use super::positions::Positions;
use super::regression::{Fit, WeightedStops};
use super::report::FTest;
use super::terms::Term;

/// Biases of one gyro in the logs of a test, less that in the first log.
///
/// A bias changes from turn-on to turn-on; that of another unit is another bias. No stops tell these two
/// apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LogBiases {
    /// Name of the gyro.
    pub gyro: String,
    /// F test of one bias in all logs, beside all determined terms of the catalogue.
    pub test: FTest,
    /// Bias in each log after the first, less that in the first \[deg/h\].
    pub differences_deg_per_h: Vec<f64>,
    /// Their standard deviations \[deg/h\], scatter of the stops included.
    pub sigmas_deg_per_h: Vec<f64>,
}

/// Tests whether a gyro has one bias in all logs, beside the terms of a law that stops and logs determine
/// together; `None` of one log, and where the stops are too few.
pub(super) fn log_biases(
    positions: &Positions,
    data: &WeightedStops,
    law: &[Term],
    name: &str,
) -> Option<LogBiases> {
    let logs = positions.logs().len().saturating_sub(1);
    if logs == 0 {
        return None;
    }
    let data = data.with_excess_of(law);
    let columns = with_biases(&data, law, positions);
    let one_bias = data.fit(law)?;
    let many = Fit::of(&columns, &data.rates)?;
    let f = (one_bias.chi_square - many.chi_square) / logs as f64 / many.scale();
    let freedom = [logs as f64, many.freedom];
    let places = law.len()..law.len() + logs;
    Some(LogBiases {
        gyro: name.to_owned(),
        test: FTest {
            f,
            degrees_of_freedom: freedom,
            p_value: f_tail(f, freedom).unwrap_or(f64::NAN),
        },
        differences_deg_per_h: places.clone().map(|place| many.estimates[place]).collect(),
        sigmas_deg_per_h: places
            .map(|place| (many.cofactors[(place, place)] * many.scale()).sqrt())
            .collect(),
    })
}

/// Columns of a law, and of a bias of each log after the first.
pub(super) fn with_biases(
    data: &WeightedStops,
    law: &[Term],
    positions: &Positions,
) -> DMatrix<f64> {
    let (terms, logs) = (data.columns(law), positions.logs());
    let count = logs.len().saturating_sub(1);
    DMatrix::from_fn(data.len(), law.len() + count, |stop, place| {
        match place.checked_sub(law.len()) {
            None => terms[(stop, place)],
            Some(log) if positions.log[stop] == logs[log + 1] => data.sigma[stop].recip(),
            Some(_) => 0.0,
        }
    })
}

/// Positions whose rates have the biases of the first log.
pub(super) fn with_one_bias(positions: &Positions, biases: &[(usize, LogBiases)]) -> Positions {
    let mut one = positions.clone();
    let logs = positions.logs();
    for (gyro, found) in biases {
        for (rate, log) in one.rate_deg_per_h.iter_mut().zip(&positions.log) {
            let place = logs.iter().position(|own| own == log);
            if let Some(place) = place.and_then(|place| place.checked_sub(1)) {
                rate[*gyro] -= found.differences_deg_per_h[place];
            }
        }
    }
    one
}

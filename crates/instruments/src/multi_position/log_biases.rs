//! Biases of the gyros that differ between the logs of one test.

use gyrocal::generated::catalogue::RATES;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::between_stops::{BetweenStops, LawEstimate};
use super::positions::Positions;
use super::regression::WeightedStops;
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
    /// Probability of as different biases, beside the law and the noise between stops, of a gyro of one bias.
    pub p_value: f64,
    /// Bias in each log after the first, less that in the first \[deg/h\].
    pub differences_deg_per_h: Vec<f64>,
    /// Their standard deviations \[deg/h\], noise between stops included.
    pub sigmas_deg_per_h: Vec<f64>,
}

/// The gyros whose biases differ between logs, with a family-wise false alarm of `probability`; `None` without biases of
/// logs in the laws.
pub(super) fn differing_biases(
    between: &BetweenStops,
    laws: &[Vec<Term>],
    estimates: &[LawEstimate],
    probability: f64,
) -> Vec<LogBiases> {
    let of_gyro = |(gyro, law): (usize, &LawEstimate)| {
        let p_value = between.one_bias(gyro, laws)?;
        let places = laws[gyro].len()..law.estimates.len();
        let sigma = |place: usize| law.covariance[(place, place)].sqrt();
        (3.0 * p_value <= probability).then(|| LogBiases {
            gyro: RATES[gyro].id.to_owned(),
            p_value,
            differences_deg_per_h: places.clone().map(|place| law.estimates[place]).collect(),
            sigmas_deg_per_h: places.map(sigma).collect(),
        })
    };
    if between.biases == 0 {
        return Vec::new();
    }
    estimates.iter().enumerate().filter_map(of_gyro).collect()
}

/// Whitened columns of a law, and of a bias of each log after the first, at some stops.
pub(super) fn with_biases(
    data: &WeightedStops,
    which: &[usize],
    law: &[Term],
    positions: &Positions,
) -> DMatrix<f64> {
    let (terms, logs) = (data.columns(law), positions.logs());
    let count = logs.len().saturating_sub(1);
    DMatrix::from_fn(data.len(), law.len() + count, |stop, place| {
        match place.checked_sub(law.len()) {
            None => terms[(stop, place)],
            Some(log) if positions.log[which[stop]] == logs[log + 1] => data.sigma[stop].recip(),
            Some(_) => 0.0,
        }
    })
}

/// Rates of some stops less a law, with biases of logs if there are estimates of them \[deg/h\].
pub(super) fn residuals(
    positions: &Positions,
    data: &WeightedStops,
    which: &[usize],
    law: &[Term],
    estimates: &DVector<f64>,
) -> DVector<f64> {
    let columns = with_biases(data, which, law, positions);
    let left = &data.rates - columns.columns(0, estimates.len()) * estimates;
    left.component_mul(&data.sigma)
}

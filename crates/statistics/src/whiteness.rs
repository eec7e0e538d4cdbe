//! Whiteness of innovations: NIS, autocorrelation and the Ljung–Box test.

use crate::bands::chi_square_band;
use crate::error::StatisticsError;
use crate::probability::{chi_square_tail, chi_square_two_sided_p, normal_quantile};

/// Normalised innovations squared, over a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nis {
    /// Sum of squares.
    pub sum: f64,
    /// Number of values: the expectation of the sum.
    pub values: usize,
    /// Sum over number of values; 1 expected.
    pub mean: f64,
    /// Interval that holds the mean with probability `1 - false_alarm`.
    pub band: [f64; 2],
    /// Probability of a mean as far from one or farther, on either side.
    pub p_value: f64,
}

/// Autocorrelation of innovations, and the portmanteau test of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Autocorrelation {
    /// Correlation of each axis with itself, `[lag - 1][axis]`.
    pub correlation: Vec<[f64; 3]>,
    /// Standard deviation of each of these if there is none.
    pub sigma: Vec<[f64; 3]>,
    /// Half width of the band that holds all correlations with probability `1 - false_alarm`, in
    /// their standard deviations.
    pub band: f64,
    /// The statistic of Ljung and Box, all pairs of axes, Hosking's form for several series.
    pub ljung_box: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of as large a statistic from white innovations.
    pub p_value: f64,
}

/// The mean of squared normalised innovations with its band.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] without a value.
pub fn nis(normalised: &[[f64; 3]], false_alarm: f64) -> Result<Nis, StatisticsError> {
    check_probability(false_alarm)?;
    let values = normalised.iter().flatten().filter(|w| !w.is_nan());
    let (count, sum) = values.fold((0, 0.0), |(count, sum), w| (count + 1, sum + w * w));
    let degrees = count as f64;
    let p_value = chi_square_two_sided_p(sum, degrees).ok_or(too_short("NIS"))?;
    Ok(Nis {
        sum,
        values: count,
        mean: sum / degrees,
        band: chi_square_band(degrees, false_alarm).map(|bound| bound / degrees),
        p_value,
    })
}

/// Correlations at the lags 1 to `lags`, and the test that there are none.
///
/// Rows count by number, not by time. Where a value is missing its products are missing, and each
/// correlation has the standard deviation of the products that exist.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] with fewer than four times as many rows as lags.
pub fn autocorrelation(
    normalised: &[[f64; 3]],
    lags: usize,
    false_alarm: f64,
) -> Result<Autocorrelation, StatisticsError> {
    check_probability(false_alarm)?;
    let expected = 4 * lags.max(1);
    if normalised.len() < expected {
        return Err(StatisticsError::TooShort {
            test: "the autocorrelation",
            found: normalised.len(),
            expected,
        });
    }
    let power: [f64; 3] = core::array::from_fn(|axis| {
        let squares = normalised
            .iter()
            .map(|row| row[axis])
            .filter(|w| !w.is_nan())
            .map(|w| w * w);
        let count = squares.clone().count().max(1);
        (squares.sum::<f64>() / count as f64).max(f64::MIN_POSITIVE)
    });
    let mut correlation = Vec::with_capacity(lags);
    let mut sigma = Vec::with_capacity(lags);
    let (mut ljung_box, mut degrees_of_freedom) = (0.0, 0);
    for lag in 1..=lags {
        let mut own = [[0.0; 3]; 2];
        for i in 0..3 {
            for j in 0..3 {
                let pairs = normalised.iter().zip(&normalised[lag..]);
                let products = pairs
                    .map(|(early, late)| early[j] * late[i])
                    .filter(|p| !p.is_nan());
                let (count, sum) = products.fold((0, 0.0), |(count, sum), p| (count + 1, sum + p));
                if count == 0 {
                    continue;
                }
                // Its variance is the number of products: the factor of Ljung and Box.
                let standard = sum / (f64::from(count) * power[i] * power[j]).sqrt();
                ljung_box += standard * standard;
                degrees_of_freedom += 1;
                if i == j {
                    own[1][i] = 1.0 / f64::from(count).sqrt();
                    own[0][i] = standard * own[1][i];
                }
            }
        }
        correlation.push(own[0]);
        sigma.push(own[1]);
    }
    let shown = (3 * lags).max(1) as f64;
    Ok(Autocorrelation {
        correlation,
        sigma,
        band: normal_quantile(1.0 - false_alarm / (2.0 * shown)),
        ljung_box,
        degrees_of_freedom,
        p_value: chi_square_tail(ljung_box, degrees_of_freedom as f64)
            .ok_or(too_short("the autocorrelation"))?,
    })
}

fn too_short(test: &'static str) -> StatisticsError {
    StatisticsError::TooShort {
        test,
        found: 0,
        expected: 1,
    }
}

pub(crate) fn check_probability(false_alarm: f64) -> Result<(), StatisticsError> {
    if false_alarm > 0.0 && false_alarm < 1.0 {
        return Ok(());
    }
    Err(StatisticsError::InvalidArgument {
        what: "the false-alarm probability",
        found: false_alarm,
        expected: "a number between 0 and 1",
    })
}

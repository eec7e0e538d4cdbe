//! The norm channel: |E|² against gravity squared.
//!
//! It does not depend on attitude, hence neither on the gyros nor on any filter: what is wrong
//! with it is wrong with the accelerometers, or with gravity.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use gyrocal_record::Record;

use crate::dependence::{Dependence, dependence};
use crate::error::DiagnosisError;
use crate::significance::two_sided_p;

/// The norm of each sample, and what is expected of it.
#[derive(Debug, Clone, PartialEq)]
pub struct NormChannel {
    /// (|E|² − g²  − the variances) over its standard deviation, row by row; `NaN` where a
    /// component is missing. Of accelerometers without error it is white, of variance one.
    pub normalised: Vec<f64>,
    /// Standard deviation of |E|² of each row from the declared noise \[g²\]: 2 σ for equal ones.
    pub sigma_g2: Vec<f64>,
    /// Number of complete rows.
    pub values: usize,
    /// Mean of |E|² − g² − the variances \[g²\].
    pub mean_g2: f64,
    /// Standard deviation of that mean.
    pub mean_sigma_g2: f64,
    /// Probability of a mean as far from zero.
    pub mean_p_value: f64,
    /// Variance about the mean over that declared.
    pub variance_ratio: f64,
    /// Probability of a variance as far from the declared one, on either side.
    pub variance_p_value: f64,
    /// Dependence on each component of specific force: scale, bias, non-linearity.
    pub on_component: [Dependence; 3],
    /// Dependence on time.
    pub on_time: Dependence,
    /// Dependence on temperature, if it was logged and varies.
    pub on_temperature: Option<Dependence>,
}

/// The norm channel of a record with the declared noise of each accelerometer; gravity is 1
/// unless the bench file says otherwise.
///
/// # Errors
///
/// [`DiagnosisError::TooShort`] with fewer than two complete rows a bin, and those of
/// [`dependence`].
pub fn norm_channel(
    record: &Record,
    accel_noise_g: &[f64; 3],
    gravity_g: f64,
    bins: usize,
) -> Result<NormChannel, DiagnosisError> {
    let variances = accel_noise_g.map(|sigma| sigma * sigma);
    let expected_g2 = gravity_g * gravity_g + variances.iter().sum::<f64>();
    let of_row = |row: &[f64; 3]| {
        let square: f64 = row.iter().map(|a| a * a).sum();
        // d|E|² = 2 a·v to first order; |v|² adds 2 Σ σ⁴, which is nothing but for huge noise.
        let linear: f64 = row
            .iter()
            .zip(&variances)
            .map(|(a, v)| 4.0 * a * a * v)
            .sum();
        let quadratic: f64 = variances.iter().map(|v| 2.0 * v * v).sum();
        (square - expected_g2, (linear + quadratic).sqrt())
    };
    let (excess_g2, sigma_g2): (Vec<f64>, Vec<f64>) = record.accel_g.iter().map(of_row).unzip();
    let normalised: Vec<f64> = excess_g2
        .iter()
        .zip(&sigma_g2)
        .map(|(e, s)| e / s)
        .collect();
    let white: Vec<f64> = normalised.iter().copied().filter(|w| !w.is_nan()).collect();
    let values = white.len();
    let spread = ChiSquared::new(values.saturating_sub(1) as f64);
    let Ok(spread) = spread else {
        return Err(DiagnosisError::TooShort {
            test: "the norm channel",
            found: values,
            expected: 2,
        });
    };
    let count = values as f64;
    let complete = excess_g2.iter().zip(&sigma_g2).filter(|(e, _)| !e.is_nan());
    let (sum_g2, variance_g4) = complete.fold((0.0, 0.0), |(a, b), (e, s)| (a + e, b + s * s));
    let (mean_g2, mean_sigma_g2) = (sum_g2 / count, variance_g4.sqrt() / count);
    let middle = white.iter().sum::<f64>() / count;
    let scatter: f64 = white.iter().map(|w| (w - middle).powi(2)).sum();
    let against = |abscissa: &[f64]| dependence(abscissa, &normalised, 1.0, bins);
    let component = |axis: usize| {
        record
            .accel_g
            .iter()
            .map(|row| row[axis])
            .collect::<Vec<f64>>()
    };
    let temperature = record
        .temperature_c
        .as_ref()
        .filter(|column| column.iter().any(|value| *value != column[0]));
    Ok(NormChannel {
        values,
        mean_g2,
        mean_sigma_g2,
        mean_p_value: two_sided_p(mean_g2 / mean_sigma_g2),
        variance_ratio: scatter / (count - 1.0),
        variance_p_value: (2.0 * spread.cdf(scatter).min(spread.sf(scatter))).min(1.0),
        on_component: [
            against(&component(0))?,
            against(&component(1))?,
            against(&component(2))?,
        ],
        on_time: against(&record.time_s)?,
        on_temperature: temperature.map(|column| against(column)).transpose()?,
        normalised,
        sigma_g2,
    })
}

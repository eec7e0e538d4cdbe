//! The magnitude channel: |E|² of the accelerometer outputs E against gravity squared.
//!
//! It depends neither on the attitude nor on the gyros nor on a filter (docs/method.md, equation
//! 18): a deviation is an error of the accelerometers, or of gravity.

use gyrocal_record::Record;
use gyrocal_statistics::{
    BinnedMeans, binned_means, chi_square_two_sided_p, p_of_least, two_sided_p,
};

use crate::error::DiagnosisError;

/// |E|² of each sample against its expectation.
#[derive(Debug, Clone, PartialEq)]
pub struct MagnitudeChannel {
    /// (|E|² − g² − Σ σ²) over its standard deviation, row by row; `NaN` where a component is
    /// missing. White with variance 1 for accelerometers as declared.
    pub normalised: Vec<f64>,
    /// Standard deviation of |E|² of each row from the declared noise \[g²\]: 2 σ if all are equal.
    pub sigma_g2: Vec<f64>,
    /// Number of complete rows.
    pub values: usize,
    /// Mean of |E|² − g² − Σ σ² \[g²\].
    pub mean_g2: f64,
    /// Standard deviation of that mean.
    pub mean_sigma_g2: f64,
    /// Two-sided p-value of the mean.
    pub mean_p_value: f64,
    /// Variance about the mean over the declared variance.
    pub variance_ratio: f64,
    /// Two-sided p-value of the variance.
    pub variance_p_value: f64,
    /// Binned means over each component of specific force: scale, bias, non-linearity.
    pub on_component: [BinnedMeans; 3],
    /// Binned means over time.
    pub on_time: BinnedMeans,
    /// Binned means over temperature, if it was logged and varies.
    pub on_temperature: Option<BinnedMeans>,
}

impl MagnitudeChannel {
    /// p-value of the least p-value of the mean and of all binned means.
    #[must_use]
    pub fn least_p_value(&self) -> f64 {
        let binned = self.on_component.iter().chain([&self.on_time]);
        let binned = binned.chain(&self.on_temperature);
        let (count, least) = binned.fold((1.0, self.mean_p_value), |(count, least), means| {
            (count + 1.0, f64::min(least, means.p_value))
        });
        p_of_least(least, count)
    }
}

/// The magnitude channel of a record with the declared noise of each accelerometer; `gravity_g` is
/// 1 unless the bench file gives local and unit gravity.
///
/// # Errors
///
/// [`DiagnosisError::TooShort`] with fewer than two complete rows per bin, and the errors of
/// [`binned_means`].
pub fn magnitude_channel(
    record: &Record,
    accel_noise_g: &[f64; 3],
    gravity_g: f64,
    bins: usize,
) -> Result<MagnitudeChannel, DiagnosisError> {
    let variances = accel_noise_g.map(|sigma| sigma * sigma);
    let expected_g2 = gravity_g * gravity_g + variances.iter().sum::<f64>();
    let of_row = |row: &[f64; 3]| {
        let square: f64 = row.iter().map(|a| a * a).sum();
        // d|E|² = 2 a·v to first order; |v|² adds 2 Σ σ⁴, which matters for huge noise only.
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
    let Some(degrees) = values.checked_sub(1).filter(|degrees| *degrees > 0) else {
        return Err(DiagnosisError::TooShort {
            test: "the magnitude test",
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
    let against = |abscissa: &[f64]| binned_means(abscissa, &normalised, 1.0, bins);
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
    Ok(MagnitudeChannel {
        values,
        mean_g2,
        mean_sigma_g2,
        mean_p_value: two_sided_p(mean_g2 / mean_sigma_g2),
        variance_ratio: scatter / (count - 1.0),
        variance_p_value: chi_square_two_sided_p(scatter, degrees as f64).unwrap_or(1.0),
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

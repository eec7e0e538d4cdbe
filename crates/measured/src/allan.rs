//! Overlapping Allan deviation with confidence intervals.
//!
//! W. J. Riley, *Handbook of Frequency Stability Analysis*, NIST Special Publication 1065, 2008:
//! sections 5.2.4 (deviation), 5.3 (confidence intervals), table 5 (degrees of freedom). In its
//! words a gyro's rate is fractional frequency and its angle is phase.

mod coefficients;
mod noise;

use statrs::distribution::{ChiSquared, ContinuousCDF as _};

pub use coefficients::{NoiseCoefficients, noise_coefficients};
pub use noise::NoiseType;

use crate::error::{MeasuredError, Unfit};

/// One averaging time of an Allan deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllanPoint {
    /// Averaging time.
    pub tau_s: f64,
    /// The averaging time in samples.
    pub averaging: usize,
    /// The deviation, in the unit of the rate.
    pub deviation: f64,
    /// Bounds of the confidence interval.
    pub interval: [f64; 2],
    /// Equivalent degrees of freedom of the variance.
    pub degrees_of_freedom: f64,
    /// What dominates, which decides the degrees of freedom.
    pub noise: NoiseType,
}

/// Averaging times in octaves, from one sample up to a third of the record.
#[must_use]
pub fn octaves(samples: usize) -> Vec<usize> {
    let longest = samples / 3;
    std::iter::successors(Some(1_usize), |averaging| averaging.checked_mul(2))
        .take_while(|averaging| *averaging <= longest)
        .collect()
}

/// Overlapping Allan deviation of samples of a rate, each the mean over one interval.
///
/// `confidence` is the probability that the interval holds the deviation.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer than three samples an averaging time, [`Unfit::Setting`] for an
/// interval that is not positive, an averaging of no samples, a confidence that is no
/// probability, and rates or intervals so large or small that a deviation is no finite number.
pub fn allan_deviation(
    rate: &[f64],
    interval_s: f64,
    averaging: &[usize],
    confidence: f64,
) -> Result<Vec<AllanPoint>, MeasuredError> {
    check(rate, interval_s, averaging, confidence)?;
    let phase = phase(rate, interval_s);
    let ramp = noise::ramp(rate);
    let mut points: Vec<AllanPoint> = Vec::with_capacity(averaging.len());
    for &averaging in averaging {
        let tau_s = averaging as f64 * interval_s;
        let (sum, count) = second_differences(&phase, averaging);
        let variance = sum / (2.0 * tau_s * tau_s * count as f64);
        // Too few points to tell: as at the averaging time before.
        let mut noise = noise::identify(&phase, averaging)
            .or(points.last().map(|point| point.noise))
            .unwrap_or(NoiseType::WhiteRate);
        // Half the variance and more. A random walk has ramps of its own.
        let of_ramp = 0.5 * (ramp * averaging as f64).powi(2);
        if of_ramp > 0.5 * variance && noise != NoiseType::RandomWalkRate {
            noise = NoiseType::RateRamp;
        }
        let degrees_of_freedom = noise.degrees_of_freedom(phase.len(), averaging);
        let bound = |probability: f64| {
            let quantile = chi_square_quantile(degrees_of_freedom, probability);
            (variance * degrees_of_freedom / quantile).sqrt()
        };
        let tail = 0.5 * (1.0 - confidence);
        let point = AllanPoint {
            tau_s,
            averaging,
            deviation: variance.sqrt(),
            interval: [bound(1.0 - tail), bound(tail)],
            degrees_of_freedom,
            noise,
        };
        refuse_overflow(&point)?;
        points.push(point);
    }
    Ok(points)
}

fn refuse_overflow(point: &AllanPoint) -> Result<(), MeasuredError> {
    let [low, high] = point.interval;
    if [point.tau_s, point.deviation, low, high]
        .iter()
        .all(|value| value.is_finite())
    {
        return Ok(());
    }
    Err(MeasuredError::unfit(
        Unfit::Setting,
        format!(
            "a deviation of {:e} at an averaging time of {:e} s",
            point.deviation, point.tau_s
        ),
        "finite numbers",
        "choose a unit of the rate and a sampling rate of a usual size",
    ))
}

/// The angle at the ends of the intervals, from zero.
fn phase(rate: &[f64], interval_s: f64) -> Vec<f64> {
    // The mean rate has no part in second differences; without it no digits are lost.
    let mean = rate.iter().sum::<f64>() / rate.len() as f64;
    let mut angle = 0.0;
    let mut phase = Vec::with_capacity(rate.len() + 1);
    phase.push(angle);
    for value in rate {
        angle += (value - mean) * interval_s;
        phase.push(angle);
    }
    phase
}

/// Sum of squares of x(k+2m) - 2 x(k+m) + x(k), and their number.
fn second_differences(phase: &[f64], averaging: usize) -> (f64, usize) {
    let count = phase.len() - 2 * averaging;
    let later = phase[averaging..].iter().zip(&phase[2 * averaging..]);
    let squares = phase.iter().zip(later).map(|(first, (second, third))| {
        let difference = third - 2.0 * second + first;
        difference * difference
    });
    (squares.sum(), count)
}

fn check(
    rate: &[f64],
    interval_s: f64,
    averaging: &[usize],
    confidence: f64,
) -> Result<(), MeasuredError> {
    let setting = |found: String, expected: &str| {
        MeasuredError::unfit(Unfit::Setting, found, expected, "change the option")
    };
    if !(interval_s > 0.0 && interval_s.is_finite()) {
        let found = format!("a sampling interval of {interval_s} s");
        return Err(setting(found, "a positive one"));
    }
    if !(confidence > 0.0 && confidence < 1.0) {
        let found = format!("a confidence of {confidence}");
        return Err(setting(found, "a probability between 0 and 1"));
    }
    if averaging.contains(&0) {
        let found = "an averaging time of no samples".to_owned();
        return Err(setting(found, "one or more"));
    }
    let longest = averaging.iter().copied().max().unwrap_or(1);
    if rate.len() / 3 < longest {
        return Err(MeasuredError::unfit(
            Unfit::TooShort,
            format!("{} samples", rate.len()),
            format!("at least {}", 3 * longest),
            "record for longer, or ask for shorter averaging times",
        ));
    }
    if let Some(row) = rate.iter().position(|value| !value.is_finite()) {
        return Err(MeasuredError::unfit(
            Unfit::Gap,
            format!("a sample that is no finite number (number {})", row + 1),
            "a rate at every sample",
            "cut the recording where samples are missing",
        ));
    }
    Ok(())
}

fn chi_square_quantile(degrees_of_freedom: f64, probability: f64) -> f64 {
    ChiSquared::new(degrees_of_freedom).map_or(f64::NAN, |chi| chi.inverse_cdf(probability))
}

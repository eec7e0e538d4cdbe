//! Allan deviations with confidence intervals, and the parts of a noise that they show.
//!
//! W. J. Riley, *Handbook of Frequency Stability Analysis*, NIST Special Publication 1065, 2008:
//! sections 5.2.4 (deviation), 5.3 (confidence intervals), table 5 (degrees of freedom). In its
//! words a gyro's rate is fractional frequency and its angle is phase.

mod estimators;
mod fit;
mod held;
mod likelihood;
mod noise;
mod ordinates;
mod parts;
mod tones;

pub use estimators::{AllanEstimator, hadamard_deviation, total_deviation};
pub use fit::{Coefficient, FittedPoint, NoiseFit, fit_noise};
pub use noise::NoiseType;
pub use parts::NoisePart;
pub use tones::Tone;

use crate::error::StatisticsError;
use crate::probability::chi_square_quantile;

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
    /// The noise that dominates, which decides the degrees of freedom.
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
/// [`StatisticsError::AveragingTooLong`] with fewer than three samples an averaging time,
/// [`StatisticsError::InvalidArgument`] for an interval that is not positive, an averaging of no
/// samples and a confidence that is no probability, [`StatisticsError::NotFinite`] for a sample
/// that is missing, [`StatisticsError::Overflow`] for rates or intervals so large or small that a
/// deviation is no finite number.
pub fn allan_deviation(
    rate: &[f64],
    interval_s: f64,
    averaging: &[usize],
    confidence: f64,
) -> Result<Vec<AllanPoint>, StatisticsError> {
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
        points.push(point(
            [tau_s, variance, degrees_of_freedom],
            averaging,
            noise,
            confidence,
        )?);
    }
    Ok(points)
}

/// A point of averaging time, variance and degrees of freedom, with its interval.
fn point(
    [tau_s, variance, degrees_of_freedom]: [f64; 3],
    averaging: usize,
    noise: NoiseType,
    confidence: f64,
) -> Result<AllanPoint, StatisticsError> {
    let bound = |probability: f64| {
        let quantile = chi_square_quantile(probability, degrees_of_freedom).unwrap_or(f64::NAN);
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
    Ok(point)
}

fn refuse_overflow(point: &AllanPoint) -> Result<(), StatisticsError> {
    let [low, high] = point.interval;
    if [point.tau_s, point.deviation, low, high]
        .iter()
        .all(|value| value.is_finite())
    {
        return Ok(());
    }
    Err(StatisticsError::Overflow {
        deviation: point.deviation,
        tau_s: point.tau_s,
    })
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
) -> Result<(), StatisticsError> {
    if !(interval_s > 0.0 && interval_s.is_finite()) {
        return Err(StatisticsError::InvalidArgument {
            what: "the sampling interval, in seconds,",
            found: interval_s,
            expected: "a positive number",
        });
    }
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(StatisticsError::InvalidArgument {
            what: "the confidence",
            found: confidence,
            expected: "a probability between 0 and 1",
        });
    }
    if averaging.contains(&0) {
        return Err(StatisticsError::InvalidArgument {
            what: "an averaging time in samples",
            found: 0.0,
            expected: "one or more",
        });
    }
    let longest = averaging.iter().copied().max().unwrap_or(1);
    if rate.len() / 3 < longest {
        return Err(StatisticsError::AveragingTooLong {
            found: rate.len(),
            expected: 3 * longest,
        });
    }
    if let Some(row) = rate.iter().position(|value| !value.is_finite()) {
        return Err(StatisticsError::NotFinite { sample: row + 1 });
    }
    Ok(())
}

//! Total and Hadamard deviations (NIST SP 1065, sections 5.2.11 and 5.2.8).

use super::parts::NoisePart;
use super::{AllanPoint, NoiseType, check, noise, phase, point};
use crate::error::StatisticsError;

/// Estimator of the deviation of means over successive intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum AllanEstimator {
    /// Overlapping Allan deviation.
    #[default]
    Overlapping,
    /// Total deviation: the angle is reflected at both ends of the record, which gives more degrees of
    /// freedom at the longest averaging times. For flicker and random walks its expectation is lower
    /// than the Allan deviation there, by a quarter at most; it is not corrected.
    Total,
    /// Overlapping Hadamard deviation: third differences of the angle, which a ramp of the rate does
    /// not enter.
    Hadamard,
}

impl AllanEstimator {
    /// The estimator in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Overlapping => "overlapping Allan deviation",
            Self::Total => "total deviation",
            Self::Hadamard => "overlapping Hadamard deviation",
        }
    }
}

/// Total deviation of samples of a rate, each the mean over one interval; `averaging` in samples.
///
/// # Errors
/// As for [`allan_deviation`](super::allan_deviation).
pub fn total_deviation(
    rate: &[f64],
    interval_s: f64,
    averaging: &[usize],
    confidence: f64,
) -> Result<Vec<AllanPoint>, StatisticsError> {
    check(rate, interval_s, averaging, confidence)?;
    let phase = phase(rate, interval_s);
    let last = phase.len() - 1;
    // Reflected about the points at both ends.
    let at = |index: isize| {
        if index < 0 {
            2.0 * phase[0] - phase[index.unsigned_abs()]
        } else if index as usize > last {
            2.0 * phase[last] - phase[2 * last - index as usize]
        } else {
            phase[index as usize]
        }
    };
    let mut points: Vec<AllanPoint> = Vec::with_capacity(averaging.len());
    for &averaging in averaging {
        let tau_s = averaging as f64 * interval_s;
        let squares = (1..last as isize).map(|middle| {
            let apart = averaging as isize;
            (at(middle - apart) - 2.0 * phase[middle as usize] + at(middle + apart)).powi(2)
        });
        let variance = squares.sum::<f64>() / (2.0 * tau_s * tau_s * (last - 1) as f64);
        let kind = kind(&phase, averaging, &points);
        // Table 7 of the handbook; below half a record only.
        let ratio = last as f64 / averaging as f64;
        let freedom = match kind {
            NoiseType::WhiteRate => 1.5 * ratio,
            NoiseType::FlickerRate => 1.17 * ratio - 0.22,
            NoiseType::RandomWalkRate | NoiseType::RateRamp => 0.93 * ratio - 0.36,
            _ => kind.degrees_of_freedom(phase.len(), averaging),
        };
        points.push(point(
            [tau_s, variance, freedom],
            averaging,
            kind,
            confidence,
        )?);
    }
    Ok(points)
}

/// Overlapping Hadamard deviation of samples of a rate, each the mean over one interval; `averaging` in
/// samples. Its degrees of freedom are those of the dominant noise, from the covariances of third
/// differences.
///
/// # Errors
/// As for [`allan_deviation`](super::allan_deviation), with four samples for each averaging time.
pub fn hadamard_deviation(
    rate: &[f64],
    interval_s: f64,
    averaging: &[usize],
    confidence: f64,
) -> Result<Vec<AllanPoint>, StatisticsError> {
    check(rate, interval_s, averaging, confidence)?;
    let longest = averaging.iter().copied().max().unwrap_or(1);
    if rate.len() / 4 < longest {
        return Err(StatisticsError::AveragingTooLong {
            found: rate.len(),
            expected: 4 * longest,
        });
    }
    let phase = phase(rate, interval_s);
    let mut points: Vec<AllanPoint> = Vec::with_capacity(averaging.len());
    for &averaging in averaging {
        let tau_s = averaging as f64 * interval_s;
        let count = phase.len() - 3 * averaging;
        let squares = (0..count).map(|start| {
            let at = |number: usize| phase[start + number * averaging];
            (at(3) - 3.0 * at(2) + 3.0 * at(1) - at(0)).powi(2)
        });
        let variance = squares.sum::<f64>() / (6.0 * tau_s * tau_s * count as f64);
        let kind = kind(&phase, averaging, &points);
        let freedom = hadamard_degrees_of_freedom(kind, count, averaging);
        points.push(point(
            [tau_s, variance, freedom],
            averaging,
            kind,
            confidence,
        )?);
    }
    Ok(points)
}

fn kind(phase: &[f64], averaging: usize, before: &[AllanPoint]) -> NoiseType {
    noise::identify(phase, averaging)
        .or(before.last().map(|point| point.noise))
        .unwrap_or(NoiseType::WhiteRate)
}

/// Equivalent degrees of freedom of a mean of `count` squares of third differences: twice the square of
/// its expectation over its variance.
pub(super) fn hadamard_degrees_of_freedom(kind: NoiseType, count: usize, averaging: usize) -> f64 {
    const WEIGHTS: [f64; 4] = [1.0, -3.0, 3.0, -1.0];
    /// Covariances at longer lags add nothing.
    const LONGEST: usize = 8;
    let part = match kind {
        NoiseType::WhiteAngle | NoiseType::FlickerAngle => NoisePart::Quantisation,
        NoiseType::WhiteRate => NoisePart::RandomWalk,
        NoiseType::FlickerRate => NoisePart::BiasInstability,
        NoiseType::RandomWalkRate | NoiseType::RateRamp => NoisePart::RateRandomWalk,
    };
    let covariance = |lag: f64| {
        let mut sum = 0.0;
        for (i, one) in WEIGHTS.iter().enumerate() {
            for (j, other) in WEIGHTS.iter().enumerate() {
                let apart = lag + (i as f64 - j as f64) * averaging as f64;
                let spike = part == NoisePart::Quantisation && apart == 0.0;
                sum += one * other * (part.angle_covariance(apart) + f64::from(u8::from(spike)));
            }
        }
        sum
    };
    let square = |lag: usize| {
        let relative = covariance(lag as f64) / covariance(0.0);
        relative * relative * (count - lag) as f64
    };
    let longest = (LONGEST * averaging).min(count - 1);
    let step = match part {
        NoisePart::Quantisation => averaging,
        _ => (averaging / 32).max(1),
    };
    let later: f64 = (1..)
        .map(|k| k * step)
        .take_while(|lag| *lag <= longest)
        .map(square)
        .sum();
    // White noise of the angle has covariance at whole averaging times alone; the others are smooth
    // between the steps, and the first stands for half a step on each side.
    let sum = match part {
        NoisePart::Quantisation => count as f64 + 2.0 * later,
        _ => step as f64 * (count as f64 + 2.0 * later),
    };
    (count as f64 * count as f64 / sum).max(1.0)
}

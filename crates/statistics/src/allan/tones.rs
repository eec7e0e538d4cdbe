//! Sinusoids in a record.

use core::f64::consts::TAU;

use rustfft::num_complex::Complex64;
use serde::Serialize;

use super::ordinates::fourier_transform;
use crate::descriptive::upper_median;
use crate::math::{cos, exp, hypot, sin, sin_cos};
use crate::periodogram::highest_near;
use crate::probability::NORMAL_97_5;

/// Most sinusoids that are taken for such.
pub(super) const MOST: usize = 8;

/// Probability of one in noise of the fitted density.
const FALSE_ALARM: f64 = 1e-4;

/// Ordinates whose median is the level about one of them.
const ABOUT: usize = 81;

/// A sinusoid of the rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tone {
    /// Its frequency \[Hz\], or that onto which sampling folds it.
    pub frequency_hz: f64,
    /// Standard deviation of the frequency \[Hz\].
    pub frequency_sigma_hz: f64,
    /// Its amplitude, in the unit of the rate.
    pub amplitude: f64,
    /// Ends of the 95 % interval of the amplitude.
    pub interval: [f64; 2],
}

/// A sinusoid in samples: frequency, and coefficients of cosine and sine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) frequency: f64,
    cosine: f64,
    sine: f64,
}

impl Line {
    pub(super) fn amplitude(self) -> f64 {
        hypot(self.cosine, self.sine)
    }

    pub(super) fn take_off(self, values: &mut [f64]) {
        for (row, value) in values.iter_mut().enumerate() {
            let (sin, cos) = sin_cos(TAU * self.frequency * row as f64);
            *value -= self.cosine * cos + self.sine * sin;
        }
    }

    /// `true` if noise of a density shows as large a sinusoid at any frequency very rarely.
    pub(super) fn is_told(self, samples: usize, density: f64) -> bool {
        let power = 0.25 * self.amplitude().powi(2) * samples as f64 / density;
        // Frequencies of the record, twice as many since the best lies between them.
        samples as f64 * exp(-power) < FALSE_ALARM
    }

    /// For samples of `interval_s` and noise of a density at its frequency.
    pub(super) fn tone(self, samples: usize, density: f64, interval_s: f64) -> Tone {
        let (count, amplitude) = (samples as f64, self.amplitude());
        let half = NORMAL_97_5 * (2.0 * density / count).sqrt();
        let sigma = (6.0 * density / count).sqrt() / (core::f64::consts::PI * amplitude * count);
        Tone {
            frequency_hz: self.frequency / interval_s,
            frequency_sigma_hz: sigma / interval_s,
            amplitude,
            interval: [(amplitude - half).max(0.0), amplitude + half],
        }
    }
}

impl Tone {
    /// The same in another unit of the rate.
    pub(super) fn scaled(self, unit: f64) -> Self {
        Self {
            amplitude: unit * self.amplitude,
            interval: self.interval.map(|end| unit * end),
            ..self
        }
    }
}

/// The sinusoid that stands out most above a density of the noise and above its neighbours, and the density that
/// these have.
pub(super) fn largest(values: &[f64], density: impl Fn(f64) -> f64) -> Option<(Line, f64)> {
    let count = values.len();
    let mut buffer: Vec<Complex64> = values.iter().map(|value| Complex64::from(*value)).collect();
    fourier_transform(&mut buffer);
    // The lowest are the walks'.
    let places = 3..count / 2;
    let ratio = |k: usize| buffer[k].norm_sqr() / density(k as f64 / count as f64);
    let ratios: Vec<f64> = places.clone().map(ratio).collect();
    // The median of many neighbours, for groups of them.
    let mut above: Option<(usize, f64, f64)> = None;
    for (group, own) in ratios.chunks(ABOUT).enumerate() {
        let from = (group * ABOUT).saturating_sub(ABOUT / 2);
        let to = ratios.len().min(group * ABOUT + own.len() + ABOUT / 2);
        let level = upper_median(&mut ratios[from..to].to_vec())?;
        for (place, ratio) in own.iter().enumerate() {
            let ratio = ratio / level;
            if above.is_none_or(|(_, most, _)| ratio > most) {
                above = Some((places.start + group * ABOUT + place, ratio, level));
            }
        }
    }
    let (place, _, level) = above?;
    let near = place as f64 / count as f64;
    // The median of an exponential distribution is ln 2 of its mean.
    let level = level / core::f64::consts::LN_2 / count as f64 * density(near);
    let sums = |frequency: f64| fourier_sum(values, frequency);
    let frequency = highest_near(
        |frequency| sums(frequency).norm_sqr(),
        near,
        1.0 / count as f64,
    );
    // Least squares of cosine and sine: their own sums are those of twice the frequency.
    let twice = {
        let (n, angle) = (count as f64, TAU * frequency);
        let size = sin(n * angle) / sin(angle);
        Complex64::new(size * cos((n - 1.0) * angle), size * sin((n - 1.0) * angle))
    };
    let sum = sums(frequency);
    let (cc, ss, cs) = (
        0.5 * (count as f64 + twice.re),
        0.5 * (count as f64 - twice.re),
        0.5 * twice.im,
    );
    let determinant = cc * ss - cs * cs;
    let line = Line {
        frequency,
        cosine: (ss * sum.re - cs * sum.im) / determinant,
        sine: (cc * sum.im - cs * sum.re) / determinant,
    };
    Some((line, level))
}

/// Sums of the values times cosine and sine of a frequency in samples.
fn fourier_sum(values: &[f64], frequency: f64) -> Complex64 {
    // The rotation of one sample, begun anew before its rounding adds up.
    const ANEW: usize = 1024;
    let turned = |angle: f64| {
        let (sin, cos) = sin_cos(angle);
        Complex64::new(cos, sin)
    };
    let step = turned(TAU * frequency);
    let of_block = |(block, values): (usize, &[f64])| {
        let mut at = turned(TAU * (frequency * (block * ANEW) as f64).fract());
        values.iter().fold(Complex64::default(), |sum, value| {
            let next = sum + at * *value;
            at *= step;
            next
        })
    };
    values.chunks(ANEW).enumerate().map(of_block).sum()
}

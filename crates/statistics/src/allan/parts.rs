//! Parts of a noise: their Allan variances and their spectral densities.

use core::f64::consts::{LN_2, PI};

use serde::Serialize;

use crate::math::{exp, ln, sin};

/// A part of the noise of a rate, by the slope of its Allan deviation (IEEE Std 952, annex C).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum NoisePart {
    /// Q: white noise of the angle, variance 3 Q² / τ².
    Quantisation,
    /// N: white noise of the rate, variance N² / τ.
    RandomWalk,
    /// B: flicker of the rate, variance B² (2 ln 2) / π: the deviation of its flat part is 0.664 B.
    BiasInstability,
    /// K: random walk of the rate, variance K² τ / 3.
    RateRandomWalk,
}

/// Number of parts.
pub(super) const PARTS: usize = 4;

impl NoisePart {
    /// Flat Allan variance of a bias instability of one.
    pub const FLAT_VARIANCE: f64 = 2.0 * LN_2 / PI;

    /// The parts, by falling exponent of their spectra.
    pub const ALL: [Self; PARTS] = [
        Self::Quantisation,
        Self::RandomWalk,
        Self::BiasInstability,
        Self::RateRandomWalk,
    ];

    /// The part in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Quantisation => "quantisation",
            Self::RandomWalk => "angle random walk",
            Self::BiasInstability => "bias instability",
            Self::RateRandomWalk => "rate random walk",
        }
    }

    /// Unit of its coefficient after the unit of the rate.
    #[must_use]
    pub fn unit_suffix(self) -> &'static str {
        match self {
            Self::Quantisation => " s",
            Self::RandomWalk => " √s",
            Self::BiasInstability => "",
            Self::RateRandomWalk => " / √s",
        }
    }

    /// Allan variance at an averaging time in samples, for a coefficient of one and samples of one
    /// second.
    pub(super) fn variance(self, averaging: f64) -> f64 {
        match self {
            Self::Quantisation => 3.0 / (averaging * averaging),
            Self::RandomWalk => 1.0 / averaging,
            Self::BiasInstability => Self::FLAT_VARIANCE,
            Self::RateRandomWalk => averaging / 3.0,
        }
    }

    /// Factor from a coefficient for samples of one second to the one for samples of `interval_s`.
    pub(super) fn time_factor(self, interval_s: f64) -> f64 {
        match self {
            Self::Quantisation => interval_s,
            Self::RandomWalk => interval_s.sqrt(),
            Self::BiasInstability => 1.0,
            Self::RateRandomWalk => 1.0 / interval_s.sqrt(),
        }
    }

    /// Generalised covariance of the angle at a lag in samples: the covariances of second differences
    /// follow from it. That of quantisation is a unit at lag zero and is not part of this function.
    pub(super) fn angle_covariance(self, lag: f64) -> f64 {
        let t = lag.abs();
        match self {
            Self::Quantisation => 0.0,
            Self::RandomWalk => -0.5 * t,
            Self::BiasInstability if t == 0.0 => 0.0,
            Self::BiasInstability => t * t * ln(t) / (2.0 * PI),
            Self::RateRandomWalk => t * t * t / 12.0,
        }
    }

    /// Two-sided spectral density of the means over samples of one second, for a coefficient of one, at a
    /// frequency between zero and one half. That of quantisation is without its ends: see [`super::ordinates`].
    pub(super) fn density(self, frequency: f64) -> f64 {
        let square = sin(PI * frequency).powi(2);
        match self {
            Self::Quantisation => 4.0 * square,
            Self::RandomWalk => 1.0,
            Self::BiasInstability => {
                // The mean over a sample, and all frequencies that sampling folds onto this one.
                let cube = |from_whole: f64| exp(-3.0 * ln(from_whole));
                let folded: f64 = (1..=FOLDED)
                    .map(|j| cube(f64::from(j) - frequency) + cube(f64::from(j) + frequency))
                    .sum();
                let rest = (f64::from(FOLDED) + 0.5).powi(-2);
                square * (cube(frequency) + folded + rest) / (2.0 * PI.powi(3))
            }
            // A walk changes within a sample too: increments of its means have the variance 2/3 and the
            // covariance 1/6.
            Self::RateRandomWalk => 0.25 / square - 1.0 / 6.0,
        }
    }
}

/// Pairs of folded frequencies that are summed one by one; the rest is an integral.
const FOLDED: i32 = 4;

#[cfg(test)]
mod tests {
    use super::*;

    /// The Allan variance is the integral of the density times its transfer function.
    #[test]
    fn densities_give_the_allan_variances() {
        const STEPS: u32 = 400_000;
        for part in NoisePart::ALL {
            for averaging in [1.0, 7.0, 64.0] {
                // Squares of the fractions: many points where flicker and walk have their variance.
                let step = |i: u32| 0.5 * (f64::from(i) / f64::from(STEPS)).powi(2);
                let at = |f: f64| {
                    let both = sin(PI * averaging * f).powi(2) / (averaging * sin(PI * f));
                    part.density(f) * both * both
                };
                let sum = (0..STEPS).map(|i| {
                    let (from, to) = (step(i), step(i + 1));
                    at(0.5 * (from + to)) * (to - from)
                });
                let variance = 4.0 * sum.sum::<f64>();
                // The rest of the folded frequencies of flicker is good to 1e-4 of it.
                let ratio = variance / part.variance(averaging);
                assert!((ratio - 1.0).abs() < 1e-4, "{part:?} {averaging} {ratio}");
            }
        }
    }

    /// The variance of one second difference of the angle over 2 τ² is the Allan variance.
    #[test]
    fn covariances_of_the_angle_give_the_allan_variances() {
        for part in NoisePart::ALL {
            for averaging in [1.0, 7.0, 64.0] {
                let at = |lag: f64| part.angle_covariance(lag);
                let delta = if part == NoisePart::Quantisation {
                    6.0
                } else {
                    0.0
                };
                let square =
                    delta + 6.0 * at(0.0) - 8.0 * at(averaging) + 2.0 * at(2.0 * averaging);
                let variance = square / (2.0 * averaging * averaging);
                // A few roundings of t² ln t, which cancel to a tenth.
                assert!(
                    (variance / part.variance(averaging) - 1.0).abs() < 1e-12,
                    "{part:?}"
                );
            }
        }
    }
}

//! Noise of the rates: white noise and random walks, estimated from the record.

use gyrocal_statistics::math::ln;

/// Change of the logarithm of a noise below which it is the same: a tenth of what three days
/// determine.
const SAME: f64 = 0.02;

/// The same for what is fitted in it, sizes, onsets and time constants: weights that are off by a fifth take some
/// thousandths of a standard deviation from the best estimate.
const SAME_FIT: f64 = 0.1;

/// Noise of the rates of a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct RateNoise {
    /// Standard deviation of the white noise of each rate over the declared one.
    pub white: Vec<f64>,
    /// Random walk of the constant of each rate, its unit over √h; zero for none.
    pub walk: Vec<f64>,
}

impl RateNoise {
    /// Rates with a random walk.
    #[must_use]
    pub fn walking(&self) -> Vec<usize> {
        let sizes = self.walk.iter().enumerate();
        sizes
            .filter(|(_, size)| **size > 0.0)
            .map(|(rate, _)| rate)
            .collect()
    }

    /// Whether any of it differs so much that results would change.
    pub(crate) fn differs(&self, other: &Self) -> bool {
        self.differs_by(SAME, other)
    }

    /// Whether any of it differs so much that sizes, onsets and time constants would move.
    pub(crate) fn moves_fit(&self, other: &Self) -> bool {
        self.differs_by(SAME_FIT, other)
    }

    fn differs_by(&self, least: f64, other: &Self) -> bool {
        let own = self.white.iter().chain(&self.walk);
        let others = other.white.iter().chain(&other.walk);
        own.zip(others)
            .any(|(own, other)| own != other && ln(own / other).abs() >= least)
    }

    /// The same without random walks.
    #[must_use]
    pub fn without_walks(&self) -> Self {
        Self {
            white: self.white.clone(),
            walk: vec![0.0; self.walk.len()],
        }
    }
}

/// Noise of the rates at the largest restricted likelihood (Patterson, Thompson, Biometrika 58, 545,
/// 1971): the nominal parameters integrated out, the sizes of effects at their best.
#[derive(Clone, Debug, PartialEq)]
pub struct RateNoiseFit {
    /// The estimate.
    pub noise: RateNoise,
    /// Logarithm of the restricted likelihood, times the prior of the white noise.
    pub log_likelihood: f64,
    /// Standard deviation of the logarithm of each white noise, the others unknown.
    pub white_sigma: Vec<f64>,
    /// Standard deviation of the logarithm of each random walk; infinite for none.
    pub walk_sigma: Vec<f64>,
}

/// Effective degrees of freedom that the white noise of each rate was estimated with: the variance of
/// the logarithm of χ²(ν)/2 is 1/(2 ν).
pub(crate) fn degrees_of_freedom(fit: &RateNoiseFit) -> Vec<f64> {
    let sigmas = fit.white_sigma.iter();
    sigmas.map(|sigma| 0.5 / (sigma * sigma)).collect()
}

//! Noise of the rates: white noise and random walks, estimated from the record.

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

//! Rates of a gyro at rest with noise of known parts, exact in their means over samples.
//!
//! It shares nothing with the analysis: the noise is made in the time domain, flicker as a sum of
//! Gauss-Markov processes whose time constants are a factor of two apart, which follows 1/f within
//! 0.1 % between the shortest and the longest.

use gyrocal_statistics::deviates::Normals;

use crate::gyro_noise::walked;

/// Noise of a gyro at rest, sampled each second, by the coefficients of IEEE Std 952.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SensorNoise {
    /// Q: standard deviation of the white noise of the angle.
    pub quantisation: f64,
    /// N: standard deviation of the white noise of the mean rate over one second.
    pub random_walk: f64,
    /// B: the spectral density is B² / (2 π f), in positive and negative frequencies.
    pub bias_instability: f64,
    /// K: standard deviation of the change of the rate in one second.
    pub rate_random_walk: f64,
    /// The filter of the samples, behind everything else.
    pub filter: Filter,
}

/// Filter of unit gain at rest.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Filter {
    /// None: each sample is the mean rate over its second.
    #[default]
    None,
    /// First order with a time constant in samples.
    Lag(f64),
    /// Two of them, one after the other.
    TwoLags(f64),
    /// Mean over a number of samples.
    MovingMean(usize),
}

/// Time constants of flicker begin at this share of a sample and end at this multiple of the record.
const SHORTEST: f64 = 1.0 / 128.0;
const LONGEST: f64 = 64.0;

/// Seconds that pass in front of the record, so that the filter has forgotten its beginning: in time
/// constants.
const SETTLING: f64 = 40.0;

impl SensorNoise {
    /// Samples of the rate of a seed.
    #[must_use]
    pub fn rates(&self, samples: usize, seed: u64) -> Vec<f64> {
        let mut normals = Normals::of_seed(seed);
        let before = match self.filter {
            Filter::None => 0,
            Filter::Lag(time) | Filter::TwoLags(time) => (SETTLING * time) as usize,
            Filter::MovingMean(count) => count,
        };
        let count = samples + before;
        let mut rates: Vec<f64> = (0..count)
            .map(|_| self.random_walk * normals.normal())
            .collect();
        self.add_walk(&mut rates, &mut normals);
        self.add_flicker(&mut rates, &mut normals);
        if self.quantisation > 0.0 {
            let mut last = self.quantisation * normals.normal();
            for rate in &mut rates {
                let next = self.quantisation * normals.normal();
                *rate += next - last;
                last = next;
            }
        }
        self.filter.of(&rates).split_off(before)
    }

    fn add_walk(&self, rates: &mut [f64], normals: &mut Normals) {
        let mut value = 0.0;
        for rate in rates {
            let [change, other] = [normals.normal(), normals.normal()];
            let (mean, end) = walked(value, self.rate_random_walk, [change, other]);
            *rate += mean;
            value = end;
        }
    }

    fn add_flicker(&self, rates: &mut [f64], normals: &mut Normals) {
        if self.bias_instability == 0.0 {
            return;
        }
        // Density B² / π in the logarithm of the time constant.
        let sigma =
            self.bias_instability * (core::f64::consts::LN_2 / core::f64::consts::PI).sqrt();
        let mut time = SHORTEST;
        while time < LONGEST * rates.len() as f64 {
            let a = 1.0 / time;
            let kept = (-a).exp();
            // Joint distribution of the next value and the mean of a process of unit variance.
            let value_sigma = -(-2.0 * a).exp_m1();
            let value_sigma = value_sigma.sqrt();
            let mean_variance = mean_variance(a);
            let covariance = (-a).exp_m1().powi(2) / a;
            let along = covariance / value_sigma;
            let across = (mean_variance - along * along).max(0.0).sqrt();
            let mut value = normals.normal();
            for rate in rates.iter_mut() {
                let [one, other] = [normals.normal(), normals.normal()];
                let mean = -value * (-a).exp_m1() / a + along * one + across * other;
                *rate += sigma * mean;
                value = kept * value + value_sigma * one;
            }
            time *= 2.0;
        }
    }
}

/// Variance of the mean over a sample of `a` time constants, given the value at its beginning.
fn mean_variance(a: f64) -> f64 {
    if a < 1e-2 {
        // Series: the exact form loses its digits.
        return a * (2.0 / 3.0 - 0.5 * a + 7.0 / 30.0 * a * a);
    }
    (2.0 * a - 3.0 + 4.0 * (-a).exp() - (-2.0 * a).exp()) / (a * a)
}

impl Filter {
    fn of(self, rates: &[f64]) -> Vec<f64> {
        match self {
            Self::None => rates.to_vec(),
            Self::Lag(time) => lag(rates, time),
            Self::TwoLags(time) => lag(&lag(rates, time), time),
            Self::MovingMean(count) => {
                let mean = |end: usize| {
                    let window = &rates[(end + 1).saturating_sub(count)..=end];
                    window.iter().sum::<f64>() / window.len() as f64
                };
                (0..rates.len()).map(mean).collect()
            }
        }
    }
}

fn lag(rates: &[f64], time: f64) -> Vec<f64> {
    let share = -(-1.0 / time).exp_m1();
    rates
        .iter()
        .scan(0.0, |state, rate| {
            *state += share * (rate - *state);
            Some(*state)
        })
        .collect()
}

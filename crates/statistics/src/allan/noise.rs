//! The power law of a noise, and the degrees of freedom that follow from it.

use nalgebra::{Matrix3, Vector3};

use crate::math::{exp, ln};

/// Least number of decimated points that determine the noise type.
const FEWEST_POINTS: usize = 30;

/// Noise of a rate by its power law, in the words of gyros; the exponent is that of the power
/// spectral density of the rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoiseType {
    /// f²: quantisation, or any white error of the angle.
    WhiteAngle,
    /// f: flicker of the angle.
    FlickerAngle,
    /// f⁰: angle random walk.
    WhiteRate,
    /// f⁻¹: bias instability.
    FlickerRate,
    /// f⁻²: rate random walk.
    RandomWalkRate,
    /// No noise: the rate drifts by as much from one average to the next.
    RateRamp,
}

impl NoiseType {
    /// The noise in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::WhiteAngle => "white angle (quantisation)",
            Self::FlickerAngle => "flicker of the angle",
            Self::WhiteRate => "white rate (angle random walk)",
            Self::FlickerRate => "flicker of the rate (bias instability)",
            Self::RandomWalkRate => "rate random walk",
            Self::RateRamp => "ramp of the rate (drift)",
        }
    }

    fn of_exponent(exponent: i32) -> Self {
        match exponent {
            ..=-2 => Self::RandomWalkRate,
            -1 => Self::FlickerRate,
            0 => Self::WhiteRate,
            1 => Self::FlickerAngle,
            2.. => Self::WhiteAngle,
        }
    }

    /// Equivalent degrees of freedom of an overlapping Allan variance, table 5 of NIST SP 1065, for
    /// `phase_points` values of the angle: one more than there are of the rate.
    #[must_use]
    pub fn degrees_of_freedom(self, phase_points: usize, averaging: usize) -> f64 {
        let (n, m) = (phase_points as f64, averaging as f64);
        let edf = match self {
            Self::WhiteAngle => (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m)),
            Self::FlickerAngle => {
                let product = ln((n - 1.0) / (2.0 * m)) * ln((2.0 * m + 1.0) * (n - 1.0) / 4.0);
                exp(product.max(0.0).sqrt())
            }
            Self::WhiteRate => {
                (1.5 * (n - 1.0) / m - 2.0 * (n - 2.0) / n) * (4.0 * m * m / (4.0 * m * m + 5.0))
            }
            // The table prints the numerator without its square, which would leave less than one
            // degree of freedom whatever the length.
            Self::FlickerRate if averaging == 1 => 2.0 * (n - 2.0).powi(2) / (2.3 * n - 4.9),
            Self::FlickerRate => 1.25 * n * n / (m * (n + 3.0 * m)),
            // A ramp is as long as it is: the number is that of the slowest noise.
            Self::RandomWalkRate | Self::RateRamp => {
                (n - 2.0) / (m * (n - 3.0).powi(2))
                    * ((n - 1.0).powi(2) - 3.0 * m * (n - 1.0) + 4.0 * m * m)
            }
        };
        // The approximations fall below one difference near the longest averaging times.
        edf.max(1.0)
    }
}

/// The power law by the lag 1 autocorrelation of the decimated angle: W. J. Riley and C. A.
/// Greenhall, "Power law noise identification using the lag 1 autocorrelation", 18th European
/// Frequency and Time Forum, 2004. `None` if there are too few points.
pub(crate) fn identify(phase: &[f64], averaging: usize) -> Option<NoiseType> {
    const MOST_DIFFERENCES: i32 = 2;
    let mut values: Vec<f64> = phase.iter().step_by(averaging).copied().collect();
    if values.len() < FEWEST_POINTS {
        return None;
    }
    remove_parabola(&mut values)?;
    for differences in 0..=MOST_DIFFERENCES {
        let lag1 = lag1_autocorrelation(&values);
        let delta = lag1 / (1.0 + lag1);
        if delta < 0.25 || differences == MOST_DIFFERENCES {
            // Twice, rounded, and from the exponent of the angle to that of the rate.
            let exponent = -(2.0 * delta).round() as i32 - 2 * differences + 2;
            return Some(NoiseType::of_exponent(exponent));
        }
        values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    None
}

/// Change of the rate from one sample to the next, by least squares, if it is none that white noise
/// of the rate makes; zero otherwise.
pub(crate) fn ramp(rate: &[f64]) -> f64 {
    const SIGMAS: f64 = 5.0;
    let count = rate.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = rate.iter().sum::<f64>() / count;
    let from_middle = |index: usize| index as f64 - middle;
    let squares: f64 = (0..rate.len()).map(|i| from_middle(i).powi(2)).sum();
    let products = rate.iter().enumerate();
    let slope = products
        .map(|(i, r)| from_middle(i) * (r - mean))
        .sum::<f64>()
        / squares;
    let left = rate.iter().enumerate();
    let left: f64 = left
        .map(|(i, r)| (r - mean - slope * from_middle(i)).powi(2))
        .sum();
    let sigma = (left / (count - 2.0) / squares).sqrt();
    if slope.abs() > SIGMAS * sigma {
        slope
    } else {
        0.0
    }
}

fn lag1_autocorrelation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let products = values.windows(2).map(|w| (w[0] - mean) * (w[1] - mean));
    let squares = values.iter().map(|value| (value - mean).powi(2));
    products.sum::<f64>() / squares.sum::<f64>()
}

/// A mean rate and a ramp are no noise.
fn remove_parabola(values: &mut [f64]) -> Option<()> {
    let last = (values.len() - 1) as f64;
    let powers = |index: usize| {
        let u = 2.0 * index as f64 / last - 1.0;
        Vector3::new(1.0, u, u * u)
    };
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for (index, value) in values.iter().enumerate() {
        let row = powers(index);
        normal += row * row.transpose();
        right += row * *value;
    }
    let fit = normal.cholesky()?.solve(&right);
    for (index, value) in values.iter_mut().enumerate() {
        *value -= fit.dot(&powers(index));
    }
    Some(())
}

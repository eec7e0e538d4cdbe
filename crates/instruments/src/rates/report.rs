//! Result of an evaluation in rates, as it is serialised.

use gyrocal_statistics::{NORMAL_97_5, student_quantile};
use serde::Serialize;

use super::of_log::LogRates;
use crate::log::BadSamples;

/// Coefficient of a law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RateCoefficient {
    /// Name, such as `gyro_x.bias`.
    pub name: String,
    /// Estimate.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// Unit of both.
    pub unit: String,
    /// Degrees of freedom of the standard deviation: the noise is estimated from the same logs.
    pub degrees_of_freedom: f64,
}

/// Effect beyond the base law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RateEffect {
    /// Name of the coefficient in the law.
    pub name: String,
    /// Time of a step in its log, and the number of the log from zero.
    pub step: Option<(f64, usize)>,
    /// Half the play of a hysteresis \[K\].
    pub half_play_k: Option<f64>,
    /// Family-wise p-value.
    pub p_value: f64,
    /// Other effects that explain the log as well.
    pub alternatives: Vec<String>,
}

/// Coefficients of the noise of a gyro by IEEE Std 952, as the means over blocks show them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RateNoise {
    /// N \[deg/h sqrt(s)\].
    pub random_walk: f64,
    /// Q \[deg/h s\].
    pub quantisation: f64,
    /// B \[deg/h\].
    pub bias_instability: f64,
    /// K \[deg/h/sqrt(s)\].
    pub rate_random_walk: f64,
    /// Standard deviation of the bias from log to log beyond these \[deg/h\]; zero of a single log, and of
    /// several where the law assumes an equal bias.
    pub between_logs: f64,
}

/// Law of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GyroRates {
    /// Name of the gyro.
    pub gyro: String,
    /// Coefficients. The bias is that at mean temperature and mean time, with Earth rate where that is not known.
    pub coefficients: Vec<RateCoefficient>,
    /// Their covariance.
    pub covariance: Vec<Vec<f64>>,
    /// Terms of the base law that the logs do not determine in addition.
    pub undetermined: Vec<String>,
    /// Effects that were found, in their order.
    pub effects: Vec<RateEffect>,
    /// The noise.
    pub noise: RateNoise,
    /// `true` if several logs leave no difference that tells how much the bias changes from one to the next, as those of a
    /// position each do: all standard deviations assume that it was the same in all of them.
    pub assumes_equal_bias: bool,
}

/// Result of an evaluation in rates.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RateReport {
    /// Each log by its means.
    pub logs: Vec<LogRates>,
    /// The laws of gyros x, y, z.
    pub gyros: Vec<GyroRates>,
    /// Vertical part of Earth rate \[deg/h\]; `None` without latitude or accelerometers: rates and biases are then outputs,
    /// which have up to 15.04 deg/h of Earth rate.
    pub earth_vertical_deg_per_h: Option<f64>,
    /// Horizontal part of Earth rate \[deg/h\]; `None` as for the vertical part.
    pub earth_horizontal_deg_per_h: Option<f64>,
    /// `true` if a log turns about the vertical as under an Earth that turns the other way: within three standard
    /// deviations, where ten tell the two apart. The signs of gyros or accelerometers are wrong then, or biases are as
    /// large as that by chance.
    pub earth_is_reversed: bool,
    /// Correlation of temperature and time; `None` without temperature.
    pub time_and_temperature: Option<f64>,
    /// `true` if temperature and time go together so closely that effects of one cannot be told from those
    /// of the other.
    pub time_is_temperature: bool,
    /// Samples that no noise explains, each with the median of those about it in its place.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bad_samples: Vec<BadSamples>,
}

impl RateReport {
    /// What the standard deviations assume of the logs, in words; `None` where these tell how much a bias changes from one
    /// to the next.
    #[must_use]
    pub fn assumption(&self) -> Option<String> {
        let gyros = self.gyros.iter().filter(|gyro| gyro.assumes_equal_bias);
        let names: Vec<&str> = gyros.map(|gyro| &*gyro.gyro).collect();
        (!names.is_empty()).then(|| {
            format!(
                "an equal bias in all {} logs, by the sigmas of {}: these positions leave no difference that would tell a \
                 change, which goes into bias and terms alike. Repeat three positions, a log each, to tell it",
                self.logs.len(),
                names.join(", ")
            )
        })
    }
}

impl GyroRates {
    /// The effects, each with its coefficient: these are the last of the law.
    pub fn effects(&self) -> impl Iterator<Item = (&RateEffect, &RateCoefficient)> {
        let first = self.coefficients.len() - self.effects.len();
        self.effects.iter().zip(&self.coefficients[first..])
    }
}

impl RateEffect {
    /// When a step is, and how wide the play of a hysteresis; empty of others.
    #[must_use]
    pub fn place(&self, logs: usize) -> String {
        match (self.step, self.half_play_k) {
            (Some((time_s, log)), _) if logs > 1 => {
                format!(" at {time_s:.0} s of log {}", log + 1)
            }
            (Some((time_s, _)), _) => format!(" at {time_s:.0} s"),
            (_, Some(half_k)) => format!(", half play {half_k:.2} K"),
            _ => String::new(),
        }
    }
}

impl RateCoefficient {
    /// Ends of the 95 % interval, by Student's distribution.
    #[must_use]
    pub fn interval(&self) -> [f64; 2] {
        let quantile = student_quantile(0.975, self.degrees_of_freedom).unwrap_or(NORMAL_97_5);
        [-1.0, 1.0].map(|side| self.estimate + side * quantile * self.sigma)
    }
}

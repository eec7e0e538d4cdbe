//! Logs in the rate domain: gyro outputs at rest, or on a turntable, against Earth rate, the rate of the
//! table, specific force, temperature and time.
//!
//! Each log has one attitude to gravity; several logs of one unit are evaluated together. Means over
//! blocks of a log are fitted by generalised least squares with the noise that the logs show: angle random
//! walk and quantisation within blocks, bias instability, rate random walk and changes of the bias from log to
//! log estimated together with the law. Biases may be of any size. What a mean over a whole log tells is known
//! better, since slow noise is part of it: [`LogRates`].

mod blocks;
mod fast_noise;
mod heading;
mod law;
mod noise_model;
mod of_log;
mod terms;

use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::{NORMAL_97_5, student_quantile};
use nalgebra::DVector;
use serde::Serialize;

pub use of_log::LogRates;

use crate::accel_from_norm::refuse_wrong_norm;
use crate::description::Description;
use crate::earth_rate::{deg_per_h, earth_deg_per_h};
use crate::error::{InstrumentError, Unfit};
use crate::log::Log;
use blocks::Blocks;
use fast_noise::fast_parts;
use law::{Data, Law};
use noise_model::NoiseModel;
use terms::{RateTerm, temperature, time_and_temperature};

/// Settings of an evaluation in rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateSettings {
    /// Family-wise false-alarm probability of effects beyond the base law, of each gyro.
    pub false_alarm_probability: f64,
    /// Standard deviation of the level, from the errors of the accelerometers.
    pub level_sigma_deg: f64,
}

impl Default for RateSettings {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            level_sigma_deg: 0.01,
        }
    }
}

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
    /// Standard deviation of the bias from log to log beyond these \[deg/h\]; zero of a single log.
    pub between_logs: f64,
}

/// Law of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GyroRates {
    /// Name of the gyro.
    pub gyro: String,
    /// Coefficients. The bias is that at mean temperature and mean time.
    pub coefficients: Vec<RateCoefficient>,
    /// Their covariance.
    pub covariance: Vec<Vec<f64>>,
    /// Terms of the base law that the logs do not determine in addition.
    pub undetermined: Vec<String>,
    /// Effects that were found, in their order.
    pub effects: Vec<RateEffect>,
    /// The noise.
    pub noise: RateNoise,
}

/// Result of an evaluation in rates.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RateReport {
    /// Each log by its means.
    pub logs: Vec<LogRates>,
    /// The laws of gyros x, y, z.
    pub gyros: Vec<GyroRates>,
    /// Vertical part of Earth rate \[deg/h\].
    pub earth_vertical_deg_per_h: f64,
    /// Horizontal part of Earth rate \[deg/h\].
    pub earth_horizontal_deg_per_h: f64,
    /// `true` if a log turns about the vertical as under an Earth that turns the other way: within three standard
    /// deviations, where ten tell the two apart. The signs of gyros or accelerometers are wrong then, or biases are as
    /// large as that by chance.
    pub earth_is_reversed: bool,
    /// Correlation of temperature and time; `None` without temperature.
    pub time_and_temperature: Option<f64>,
    /// `true` if temperature and time go together so closely that effects of one cannot be told from those
    /// of the other.
    pub time_is_temperature: bool,
}

/// Correlation of temperature and time from which their effects are not told apart.
const TOGETHER: f64 = 0.9;

/// Blocks of all logs together.
const MOST_BLOCKS: usize = 64;

/// Fewest blocks of a log.
const FEWEST_BLOCKS: usize = 8;

/// Evaluates logs of one unit, each at rest in one attitude to gravity or on a turntable.
///
/// # Errors
///
/// [`Unfit::TooShort`] without a log; [`Unfit::NoScale`] in counts; [`Unfit::Setting`] without latitude;
/// [`Unfit::Norm`] if specific force is not gravity; [`Unfit::NeverStatic`] if it turns within a log;
/// [`Unfit::Saturated`] for a gyro that never changes; [`Unfit::NoAccelerometers`].
pub fn evaluate_rates(
    logs: &[Log],
    description: &Description,
    settings: &RateSettings,
) -> Result<RateReport, InstrumentError> {
    let [horizontal, vertical] = earth_deg_per_h(check(logs, description)?);
    let count = (MOST_BLOCKS / logs.len()).max(FEWEST_BLOCKS);
    let axis = description.table.as_ref().and_then(|table| table.axis);
    let blocks: Result<Vec<Blocks>, InstrumentError> = logs
        .iter()
        .map(|log| Blocks::of(log, count, axis, vertical))
        .collect();
    let blocks = blocks?;
    let norms_g = logs.iter().map(mean_norm_g);
    let norms_g: Vec<f64> = norms_g.collect::<Result<_, _>>()?;
    refuse_wrong_norm(norms_g.into_iter())?;
    let level_sigma_rad = settings.level_sigma_deg.to_radians();
    let mut laws = Vec::with_capacity(3);
    for gyro in 0..3 {
        let data = Data {
            gyro,
            logs: &blocks,
            rates: outputs(&blocks, gyro, vertical),
            noise: NoiseModel::of(
                &blocks,
                gyro,
                horizontal,
                level_sigma_rad,
                fast_parts(logs, &blocks, gyro),
            ),
        };
        let law = data.law(settings.false_alarm_probability);
        laws.push(law.ok_or_else(|| never_changes(gyro))?);
    }
    let variances: [_; 3] = core::array::from_fn(|gyro| laws[gyro].fit.variances);
    let earth = [horizontal, vertical];
    let of_log = |(log, blocks)| LogRates::of(log, blocks, earth, level_sigma_rad, &variances);
    let correlation = time_and_temperature(&blocks);
    let range_k = temperature(&blocks).map_or(0.0, |all| all.max() - all.min());
    let logs: Vec<LogRates> = logs.iter().zip(&blocks).map(of_log).collect();
    Ok(RateReport {
        earth_is_reversed: logs.iter().any(|log| is_reversed(log, vertical)),
        logs,
        gyros: laws
            .iter()
            .enumerate()
            .map(|(gyro, law)| report(gyro, law, range_k))
            .collect(),
        earth_vertical_deg_per_h: vertical,
        earth_horizontal_deg_per_h: horizontal,
        time_and_temperature: correlation,
        time_is_temperature: correlation.is_some_and(|r| r.abs() >= TOGETHER),
    })
}

/// Whether a log turns about the vertical as the Earth does, the other way round.
fn is_reversed(log: &LogRates, earth_deg_per_h: f64) -> bool {
    /// Share of Earth rate that tilt and scale may take.
    const OF_EARTH: f64 = 0.02;
    let [rate, sigma] = log.vertical_deg_per_h;
    let off = (3.0 * sigma).max(OF_EARTH * earth_deg_per_h.abs());
    10.0 * sigma < earth_deg_per_h.abs() && (rate + earth_deg_per_h).abs() < off
}

/// Outputs of a gyro less the rate of the table and the vertical part of Earth rate \[deg/h\].
fn outputs(logs: &[Blocks], gyro: usize, vertical: f64) -> DVector<f64> {
    let mut values = Vec::new();
    for log in logs {
        for block in 0..log.len() {
            let table = log.table.as_ref().map_or(0.0, |rates| rates[block][gyro]);
            let rate = deg_per_h(log.rate[block][gyro] - table);
            values.push(rate - vertical * log.up[block][gyro]);
        }
    }
    DVector::from_vec(values)
}

fn report(gyro: usize, law: &Law, range_k: f64) -> GyroRates {
    let fit = &law.fit;
    let name = |term: &RateTerm| term.name(gyro);
    let coefficients = law
        .terms
        .iter()
        .enumerate()
        .map(|(i, term)| RateCoefficient {
            name: term.name(gyro),
            estimate: fit.estimates[i],
            sigma: fit.covariance[(i, i)].sqrt(),
            unit: term.unit(gyro),
            degrees_of_freedom: law.degrees_of_freedom[i],
        });
    let [
        random_walk,
        quantisation,
        bias_instability,
        rate_random_walk,
        between_logs,
    ] = fit.variances.map(f64::sqrt);
    GyroRates {
        gyro: RATES[gyro].id.to_owned(),
        coefficients: coefficients.collect(),
        covariance: fit
            .covariance
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect(),
        undetermined: law.undetermined.iter().map(name).collect(),
        effects: law
            .found
            .iter()
            .map(|found| RateEffect {
                half_play_k: match found.term {
                    RateTerm::Hysteresis(share) => Some(share * range_k),
                    _ => None,
                },
                name: found.term.name(gyro),
                step: match found.term {
                    RateTerm::Step { log, time_s } => Some((time_s, log)),
                    _ => None,
                },
                p_value: found.p_value,
                alternatives: found.alternatives.iter().map(name).collect(),
            })
            .collect(),
        noise: RateNoise {
            random_walk,
            quantisation,
            bias_instability,
            rate_random_walk,
            between_logs,
        },
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

/// Refuses what cannot be evaluated; returns the latitude \[deg\].
fn check(logs: &[Log], description: &Description) -> Result<f64, InstrumentError> {
    if logs.is_empty() {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            "no log",
            "one or more",
            "give the logs of the unit",
        ));
    }
    for log in logs {
        if log.gyro_in_counts || log.accel_in_counts {
            return Err(InstrumentError::unfit(
                Unfit::NoScale,
                "counts whose scale is to be estimated",
                "scales that are given",
                "give `counts_per_rad_per_s` and `counts_per_g`, as a multi-position test of the unit \
                 (gyrocal tumble) prints them",
            ));
        }
        for gyro in 0..3 {
            if log.gyro.iter().all(|rate| rate[gyro] == log.gyro[0][gyro]) {
                return Err(never_changes(gyro));
            }
        }
    }
    description.site.latitude_deg.ok_or_else(|| {
        InstrumentError::unfit(
            Unfit::Setting,
            "a description without latitude",
            "`latitude_deg` in `[site]`",
            "the gyros measure Earth rate beside their errors",
        )
    })
}

/// Norm of the mean specific force of a log \[g\].
fn mean_norm_g(log: &Log) -> Result<f64, InstrumentError> {
    let force = log.force()?;
    let mean = |axis: usize| force.iter().map(|force| force[axis]).sum::<f64>() / log.len() as f64;
    Ok((0..3).map(|axis| mean(axis).powi(2)).sum::<f64>().sqrt())
}

fn never_changes(gyro: usize) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::Saturated,
        format!("{} with the same output in every sample", RATES[gyro].id),
        "an output with noise",
        "the gyro is saturated or dead, or its column is that of something else: look at the column",
    )
}

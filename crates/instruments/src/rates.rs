//! Logs in the rate domain: gyro outputs at rest, or on a turntable, against Earth rate, the rate of the
//! table, specific force, temperature and time.
//!
//! Each log has one attitude to gravity; several logs of one unit are evaluated together. Means over
//! blocks of a log are fitted by generalised least squares with the noise that the logs show: angle random
//! walk and quantisation within blocks, bias instability, rate random walk and changes of the bias from log to
//! log estimated together with the law. Biases may be of any size. What a mean over a whole log tells is known
//! better, since slow noise is part of it: [`LogRates`].

mod between_logs;
mod blocks;
mod fast_noise;
mod heading;
mod law;
mod noise_model;
mod of_log;
mod report;
mod terms;

use gyrocal::generated::catalogue::RATES;
use nalgebra::DVector;

pub use of_log::LogRates;
pub use report::{GyroRates, RateCoefficient, RateEffect, RateNoise, RateReport};

use crate::accel_from_norm::refuse_wrong_norm;
use crate::description::Description;
use crate::earth_rate::{deg_per_h, earth_deg_per_h, is_against};
use crate::error::{InstrumentError, Unfit};
use crate::log::{Log, of_logs};
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

/// Correlation of temperature and time from which their effects are not told apart.
const TOGETHER: f64 = 0.9;

/// Blocks of all logs together.
const MOST_BLOCKS: usize = 64;

/// Fewest blocks of a log.
const FEWEST_BLOCKS: usize = 8;

/// Evaluates logs of one unit, each at rest in one attitude to gravity or on a turntable. Gyros alone suffice, but Earth
/// rate is taken off only with accelerometers and latitude, and terms in specific force need the former. Samples that no noise explains
/// are left out, as by [`Log::without_bad_samples`].
///
/// # Errors
///
/// [`Unfit::TooShort`] without a log; [`Unfit::NoScale`] in counts; [`Unfit::Norm`] if specific force is not gravity;
/// [`Unfit::NeverStatic`] if it turns within a log; [`Unfit::Saturated`] for a gyro that never changes;
/// [`Unfit::NoAccelerometers`] for a turntable without them whose axis is not given.
pub fn evaluate_rates(
    logs: &[Log],
    description: &Description,
    settings: &RateSettings,
) -> Result<RateReport, InstrumentError> {
    check(logs)?;
    // Without an attitude or a latitude the outputs stay what they are.
    let has_attitude = logs.iter().all(|log| log.accel.is_some());
    let latitude_deg = description.site.latitude_deg.filter(|_| has_attitude);
    let earth = latitude_deg.map(earth_deg_per_h);
    let [horizontal, vertical] = earth.unwrap_or([0.0; 2]);
    let cleaned = logs
        .iter()
        .map(|log| log.clone().without_bad_samples(false));
    let logs = &cleaned.collect::<Vec<Log>>()[..];
    let count = (MOST_BLOCKS / logs.len()).max(FEWEST_BLOCKS);
    let axis = description.table.as_ref().and_then(|table| table.axis);
    let blocks: Result<Vec<Blocks>, InstrumentError> = logs
        .iter()
        .map(|log| Blocks::of(log, count, axis, vertical))
        .collect();
    let blocks = blocks?;
    let norms_g: Vec<f64> = logs.iter().filter_map(mean_norm_g).collect();
    if !norms_g.is_empty() {
        refuse_wrong_norm(norms_g.into_iter())?;
    }
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
    let rates = [horizontal, vertical];
    let of_log = |(log, blocks)| LogRates::of(log, blocks, rates, level_sigma_rad, &variances);
    let correlation = time_and_temperature(&blocks);
    let range_k = temperature(&blocks).map_or(0.0, |all| all.max() - all.min());
    let bad_samples = of_logs(logs);
    let logs: Vec<LogRates> = logs.iter().zip(&blocks).map(of_log).collect();
    Ok(RateReport {
        bad_samples,
        earth_is_reversed: earth.is_some()
            && logs.iter().any(|log| {
                let rate = log.vertical_deg_per_h;
                rate.and_then(|rate| is_against(rate, vertical)) == Some(true)
            }),
        logs,
        gyros: laws
            .iter()
            .enumerate()
            .map(|(gyro, law)| report(gyro, law, range_k, blocks.len()))
            .collect(),
        earth_vertical_deg_per_h: earth.map(|[_, vertical]| vertical),
        earth_horizontal_deg_per_h: earth.map(|[horizontal, _]| horizontal),
        time_and_temperature: correlation,
        time_is_temperature: correlation.is_some_and(|r| r.abs() >= TOGETHER),
    })
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

fn report(gyro: usize, law: &Law, range_k: f64, logs: usize) -> GyroRates {
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
        assumes_equal_bias: logs > 1 && law.free_differences == 0,
    }
}

/// Refuses what cannot be evaluated.
fn check(logs: &[Log]) -> Result<(), InstrumentError> {
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
    Ok(())
}

/// Norm of the mean specific force of a log \[g\]; `None` of gyros alone.
fn mean_norm_g(log: &Log) -> Option<f64> {
    let force = log.accel.as_ref()?;
    let mean = |axis: usize| force.iter().map(|force| force[axis]).sum::<f64>() / log.len() as f64;
    Some((0..3).map(|axis| mean(axis).powi(2)).sum::<f64>().sqrt())
}

fn never_changes(gyro: usize) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::Saturated,
        format!("{} with the same output in every sample", RATES[gyro].id),
        "an output with noise",
        "the gyro is saturated or dead, or its column is that of something else: look at the column",
    )
}

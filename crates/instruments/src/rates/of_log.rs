//! What one log tells by its means: mean rates, their vertical part, and biases of the gyros.

use nalgebra::Vector3;
use serde::Serialize;

use super::blocks::Blocks;
use super::fast_noise::mean_variance;
use super::heading::half_width;
use super::noise_model::Variances;
use crate::earth_rate::deg_per_h;
use crate::log::Log;

/// What the means of one log tell. A mean is that of the whole log: what changes slowly is part of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LogRates {
    /// Length of the log.
    pub duration_s: f64,
    /// Mean outputs of the gyros and their standard deviations \[deg/h\].
    pub rate_deg_per_h: [[f64; 2]; 3],
    /// Mean output along specific force, up, and its standard deviation \[deg/h\]: Earth rate, and bias; `None` of gyros
    /// alone.
    pub vertical_deg_per_h: Option<[f64; 2]>,
    /// Magnitude of the mean output across specific force \[deg/h\]: Earth rate, and bias; `None` of gyros alone.
    pub horizontal_deg_per_h: Option<f64>,
    /// Bias of each gyro at this specific force: output less Earth rate \[deg/h\], or the output where Earth rate is not
    /// known.
    pub bias_deg_per_h: [f64; 3],
    /// Half the widths of the 95 % intervals of the biases, for any heading \[deg/h\].
    pub bias_half_width_deg_per_h: [f64; 3],
    /// Least and largest temperature \[degrees Celsius\].
    pub temperature_c: Option<[f64; 2]>,
}

impl LogRates {
    /// Means of a log on the Earth with a horizontal and a vertical rate \[deg/h\], whose slow noise is known
    /// from its blocks.
    pub(super) fn of(
        log: &Log,
        blocks: &Blocks,
        [horizontal, vertical]: [f64; 2],
        level_sigma_rad: f64,
        variances: &[Variances; 3],
    ) -> Self {
        let duration_s = log.interval_s * log.len() as f64;
        let up = blocks.mean_up;
        let table = blocks.table.as_ref().map_or_else(Vector3::zeros, |rates| {
            rates.iter().sum::<Vector3<f64>>() / rates.len() as f64
        });
        let sum: Vector3<f64> = log.gyro.iter().map(|rate| Vector3::from(*rate)).sum();
        let mean = (sum / log.len() as f64 - table).map(deg_per_h);
        let along = |direction: Vector3<f64>| {
            let sum = |part: usize| -> f64 {
                let parts = variances.iter().zip(direction.iter());
                parts
                    .map(|(of_gyro, share)| share * share * of_gyro[part])
                    .sum()
            };
            let of_blocks = sum(0) / duration_s + 2.0 * sum(1) / (duration_s * duration_s);
            let rate = |sample: usize| deg_per_h(direction.dot(&Vector3::from(log.gyro[sample])));
            mean_variance(log, blocks.block_s, rate).unwrap_or(of_blocks)
        };
        let level = level_sigma_rad * horizontal.hypot(vertical);
        let sigma: [f64; 3] = core::array::from_fn(|gyro| along(axis(gyro)).sqrt());
        let across = |gyro: usize| horizontal * (1.0 - up[gyro].powi(2)).max(0.0).sqrt();
        let temperature = log.temperature_c.as_ref().map(|values| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            [
                low,
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        });
        let has_attitude = log.accel.is_some();
        let across_up = (mean - up * up.dot(&mean)).norm();
        Self {
            duration_s,
            rate_deg_per_h: core::array::from_fn(|gyro| [mean[gyro], sigma[gyro]]),
            vertical_deg_per_h: has_attitude.then(|| {
                // An error of the level sees what is across.
                let sigma = along(up).sqrt().hypot(level_sigma_rad * across_up);
                [up.dot(&mean), sigma]
            }),
            horizontal_deg_per_h: has_attitude.then_some(across_up),
            bias_deg_per_h: core::array::from_fn(|gyro| mean[gyro] - vertical * up[gyro]),
            bias_half_width_deg_per_h: core::array::from_fn(|gyro| {
                half_width(across(gyro), sigma[gyro].hypot(level))
            }),
            temperature_c: temperature,
        }
    }
}

fn axis(gyro: usize) -> Vector3<f64> {
    let mut axis = Vector3::zeros();
    axis[gyro] = 1.0;
    axis
}

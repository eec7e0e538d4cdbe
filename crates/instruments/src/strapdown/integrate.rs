//! Attitude from gyro increments, and specific force in the axes that they hold.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::InstrumentError;
use crate::log::Log;

/// One averaging interval in the axes of the virtual platform.
#[derive(Debug, Clone, PartialEq)]
pub struct PlatformRow {
    /// Middle of the interval.
    pub time_s: f64,
    /// Mean specific force in platform axes.
    pub force_g: [f64; 3],
    /// Unit quaternion (w, x, y, z) that takes body components to platform components in the
    /// middle of the interval.
    pub platform_q_body: [f64; 4],
    /// Scatter of the gyros' samples within the interval, root of the three variances' sum
    /// \[rad/s\].
    pub gyro_scatter_rad_per_s: f64,
    /// The same of the accelerometers \[g\].
    pub accel_scatter_g: f64,
}

/// Integrates a log into rows of one averaging interval each.
///
/// The rotation over a sample is its increment α plus the coning term α' × α / 12 with the
/// increment α' before it, the two-sample algorithm: exact to third order where the rate changes
/// linearly. Specific force is taken at the attitude in the middle of its sample. A row is a
/// mean over an interval in which gravity turns uniformly, which makes it shorter than in the
/// middle by (turn)²/24, 8e-7 for a minute.
///
/// The platform's axes are those of the body in the middle of the first row.
///
/// # Errors
///
/// [`crate::Unfit::NoAccelerometers`].
pub fn integrate(log: &Log, averaging_s: f64) -> Result<Vec<PlatformRow>, InstrumentError> {
    let force = log.force()?;
    let block = ((averaging_s / log.interval_s).round() as usize).max(1);
    let mut attitude = UnitQuaternion::identity();
    let mut before = Vector3::zeros();
    let mut sums = Vec::new();
    let mut middles = Vec::new();
    let mut sum = Vector3::zeros();
    for (sample, (rate, force_g)) in log.gyro.iter().zip(force).enumerate() {
        if sample % block == block / 2 {
            middles.push(attitude);
        }
        let interval_s = match sample {
            0 => log.interval_s,
            _ => log.time_s[sample] - log.time_s[sample - 1],
        };
        let increment = Vector3::from(*rate) * interval_s;
        let turn = increment + before.cross(&increment) / 12.0;
        let half = UnitQuaternion::from_scaled_axis(0.5 * turn);
        sum += (attitude * half) * Vector3::from(*force_g);
        attitude *= UnitQuaternion::from_scaled_axis(turn);
        before = increment;
        if (sample + 1) % block == 0 {
            sums.push(sum / block as f64);
            sum = Vector3::zeros();
        }
        if sample % 4096 == 0 {
            attitude.renormalize();
        }
    }
    let platform_c_start = middles.first().copied().unwrap_or_default().inverse();
    let rows = sums.iter().enumerate().map(|(row, force_g)| {
        let samples = row * block..(row + 1) * block;
        let end_s = log.time_s[samples.end - 1];
        let start_s = log.time_s[samples.start] - log.interval_s;
        PlatformRow {
            time_s: 0.5 * (start_s + end_s),
            force_g: (platform_c_start * force_g).into(),
            platform_q_body: quaternion(platform_c_start * middles[row]),
            gyro_scatter_rad_per_s: scatter(&log.gyro[samples.clone()]),
            accel_scatter_g: scatter(&force[samples]),
        }
    });
    Ok(rows.collect())
}

fn quaternion(rotation: UnitQuaternion<f64>) -> [f64; 4] {
    [rotation.w, rotation.i, rotation.j, rotation.k]
}

fn scatter(samples: &[[f64; 3]]) -> f64 {
    let n = samples.len() as f64;
    let variance = |axis: usize| {
        let mean = samples.iter().map(|sample| sample[axis]).sum::<f64>() / n;
        let squares = samples.iter().map(|sample| (sample[axis] - mean).powi(2));
        squares.sum::<f64>() / (n - 1.0)
    };
    (0..3).map(variance).sum::<f64>().sqrt()
}

//! The fast parts of the noise of logs, angle random walk and quantisation, by the scatter within blocks.

use nalgebra::DVector;

use super::blocks::{Blocks, table_angles};
use crate::earth_rate::deg_per_h;
use crate::fast_noise::{fast_parts_of, mean_variance_of, part_length};
use crate::log::Log;

/// Share of a column that the columns before it have to leave.
const LEAST_LEFT: f64 = 1e-6;

/// Squares of angle random walk \[deg²/h² s\] and quantisation \[deg²/h² s²\] of a gyro, common to all logs.
///
/// Scatter of means over blocks alone hardly tells one from the other, and means over whole logs depend on
/// which it is. Within blocks both are known from many means. `None` if a log has too few samples.
pub(super) fn fast_parts(logs: &[Log], blocks: &[Blocks], gyro: usize) -> Option<[f64; 2]> {
    let (mut sum, mut duration_s) = ([0.0; 2], 0.0);
    for (log, blocks) in logs.iter().zip(blocks) {
        let own = of_log(log, blocks.block_s, |sample| {
            deg_per_h(log.gyro[sample][gyro])
        })?;
        let own_s = log.interval_s * log.len() as f64;
        for (sum, part) in sum.iter_mut().zip(own) {
            *sum += own_s * part;
        }
        duration_s += own_s;
    }
    Some(sum.map(|sum| sum / duration_s))
}

/// Variance of the mean of `rate` \[deg/h\] over a whole log that the fast parts make; `None` if the log is too
/// short.
pub(super) fn mean_variance(log: &Log, block_s: f64, rate: impl Fn(usize) -> f64) -> Option<f64> {
    let parts = of_log(log, block_s, rate)?;
    let duration_s = log.interval_s * log.len() as f64;
    Some(mean_variance_of(parts, duration_s).iter().sum())
}

/// The parts of a rate of one log: Allan variances of what bias, rate of the table and turning Earth rate leave,
/// fitted by 3 Q²/τ² + N²/τ and a constant, none of them negative.
fn of_log(log: &Log, block_s: f64, rate: impl Fn(usize) -> f64) -> Option<[f64; 2]> {
    let length = part_length(block_s, log.interval_s);
    let means = |of: &dyn Fn(usize) -> f64| {
        let count = log.len() / length;
        let mean = |part: usize, _| {
            let samples = part * length..(part + 1) * length;
            samples.map(of).sum::<f64>() / length as f64
        };
        DVector::from_fn(count, mean)
    };
    let mut columns = vec![means(&|_| 1.0)];
    if let (Some(rates), Some(angles)) = (&log.table_rate, table_angles(log)) {
        columns.push(means(&|sample| rates[sample]));
        columns.push(means(&|sample| angles[sample].cos()));
        columns.push(means(&|sample| angles[sample].sin()));
    }
    let left = without(means(&rate), columns);
    fast_parts_of(&[left.as_slice()], log.interval_s * length as f64)
}

/// What a least squares fit of columns leaves of values; columns that depend on those before take nothing.
fn without(mut values: DVector<f64>, columns: Vec<DVector<f64>>) -> DVector<f64> {
    let mut directions: Vec<DVector<f64>> = Vec::with_capacity(columns.len());
    for column in columns {
        let whole = column.norm();
        let mut own = column;
        for direction in &directions {
            own -= direction.dot(&own) * direction;
        }
        if own.norm() > LEAST_LEFT * whole {
            own.normalize_mut();
            values -= own.dot(&values) * &own;
            directions.push(own);
        }
    }
    values
}

//! The fast parts of the noise, angle random walk and quantisation, by the scatter within blocks.

use gyrocal_statistics::allan::{allan_deviation, octaves};
use nalgebra::{DMatrix, DVector};

use super::blocks::{Blocks, table_angles};
use crate::earth_rate::deg_per_h;
use crate::log::Log;

/// Means of a block whose scatter determines the fast parts.
const PARTS_OF_BLOCK: usize = 64;

/// Share of a column that the columns before it have to leave.
const LEAST_LEFT: f64 = 1e-6;

/// Level of the intervals of an Allan deviation, which are not used.
const CONFIDENCE: f64 = 0.95;

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
    let [random_walk, quantisation] = of_log(log, block_s, rate)?;
    let duration_s = log.interval_s * log.len() as f64;
    // The angle at both ends is quantised.
    Some(random_walk / duration_s + 2.0 * quantisation / (duration_s * duration_s))
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
    let averaging = averaging(left.len());
    let short_s = log.interval_s * length as f64;
    let points = allan_deviation(left.as_slice(), short_s, &averaging, CONFIDENCE).ok()?;
    if points.len() < 3 {
        return None;
    }
    // Each row over its standard deviation.
    let weights = points.iter().map(|point| {
        let variance = point.deviation * point.deviation;
        (point.degrees_of_freedom / 2.0).sqrt() / variance
    });
    let weights = DVector::from_iterator(points.len(), weights);
    let design = DMatrix::from_fn(points.len(), 3, |row, part| {
        let tau_s = points[row].tau_s;
        weights[row] * [1.0 / tau_s, 3.0 / (tau_s * tau_s), 1.0][part]
    });
    let right = DVector::from_fn(points.len(), |row, _| {
        weights[row] * points[row].deviation * points[row].deviation
    });
    let [random_walk, quantisation, _] = least_not_negative(&design, &right)?;
    Some([random_walk, quantisation])
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

/// Least squares with no negative coefficient: the best of the fits of all choices of columns that has none.
fn least_not_negative(design: &DMatrix<f64>, right: &DVector<f64>) -> Option<[f64; 3]> {
    let fitted = (1_usize..8).filter_map(|chosen| {
        let places: Vec<usize> = (0..3).filter(|place| chosen >> place & 1 == 1).collect();
        let own = design.select_columns(&places);
        let solved = (own.transpose() * &own)
            .cholesky()?
            .solve(&(own.transpose() * right));
        if solved.min() < 0.0 {
            return None;
        }
        let mut all = [0.0; 3];
        for (place, value) in places.iter().zip(solved.iter()) {
            all[*place] = *value;
        }
        Some((all, (right - own * &solved).norm_squared()))
    });
    fitted
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(parts, _)| parts)
}

/// Samples of a part of a block.
fn part_length(block_s: f64, interval_s: f64) -> usize {
    ((block_s / interval_s) as usize / PARTS_OF_BLOCK).max(1)
}

/// Numbers of parts that are averaged, to a block.
fn averaging(parts: usize) -> Vec<usize> {
    octaves(parts)
        .into_iter()
        .filter(|count| *count <= PARTS_OF_BLOCK)
        .collect()
}

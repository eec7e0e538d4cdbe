//! The fast parts of the noise of a gyro, angle random walk and quantisation, by Allan variances.

use gyrocal_statistics::allan::{allan_deviation, octaves};
use nalgebra::{DMatrix, DVector};

/// Means of a block whose scatter determines the fast parts.
const PARTS_OF_BLOCK: usize = 64;

/// Level of the intervals of an Allan deviation, which are not used.
const CONFIDENCE: f64 = 0.95;

/// Squares of angle random walk and quantisation of means over `short_s`, in stretches without a gap: Allan variances of
/// all stretches together, fitted by 3 Q²/τ² + N²/τ and a constant, none of them negative. `None` of too few means.
pub(crate) fn fast_parts_of(stretches: &[&[f64]], short_s: f64) -> Option<[f64; 2]> {
    // Variance by its degrees of freedom, and these.
    let mut sums: Vec<[f64; 3]> = Vec::new();
    for stretch in stretches {
        let averaging = averaging(stretch.len());
        let Ok(points) = allan_deviation(stretch, short_s, &averaging, CONFIDENCE) else {
            continue;
        };
        for (at, point) in points.iter().enumerate() {
            if at == sums.len() {
                sums.push([point.tau_s, 0.0, 0.0]);
            }
            sums[at][1] += point.degrees_of_freedom * point.deviation * point.deviation;
            sums[at][2] += point.degrees_of_freedom;
        }
    }
    if sums.len() < 3 {
        return None;
    }
    let variances: Vec<f64> = sums.iter().map(|[_, sum, freedom]| sum / freedom).collect();
    // Each row over its standard deviation.
    let pairs = sums.iter().zip(&variances);
    let weights = pairs.map(|([_, _, freedom], variance)| (freedom / 2.0).sqrt() / variance);
    let weights = DVector::from_iterator(sums.len(), weights);
    let design = DMatrix::from_fn(sums.len(), 3, |row, part| {
        let tau_s = sums[row][0];
        weights[row] * [1.0 / tau_s, 3.0 / (tau_s * tau_s), 1.0][part]
    });
    let right = DVector::from_fn(sums.len(), |row, _| weights[row] * variances[row]);
    let [random_walk, quantisation, _] = least_not_negative(&design, &right)?;
    Some([random_walk, quantisation])
}

/// Variance of a mean over `duration_s` by the two fast parts.
pub(crate) fn mean_variance_of([random_walk, quantisation]: [f64; 2], duration_s: f64) -> [f64; 2] {
    // The angle at both ends is quantised.
    [
        random_walk / duration_s,
        2.0 * quantisation / (duration_s * duration_s),
    ]
}

/// Samples of a part of a block.
pub(crate) fn part_length(block_s: f64, interval_s: f64) -> usize {
    ((block_s / interval_s) as usize / PARTS_OF_BLOCK).max(1)
}

/// Numbers of parts that are averaged, to a block.
fn averaging(parts: usize) -> Vec<usize> {
    octaves(parts)
        .into_iter()
        .filter(|count| *count <= PARTS_OF_BLOCK)
        .collect()
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

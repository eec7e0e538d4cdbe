//! Covariances of overlapping Allan variances of one record over averaging times.
//!
//! An overlapping Allan variance is a mean of squares of second differences z of the angle, divided by
//! 2 τ². For Gaussian noise cov(z², z'²) = 2 cov(z, z')², so that the covariance of two such means is
//! twice the sum over lags of the squared cross-covariance of the differences. Those of the
//! parts of a noise add, and are combinations of their generalised covariances (C. A. Greenhall,
//! "Recipes for degrees of freedom of frequency stability estimators", IEEE Transactions on
//! Instrumentation and Measurement 40, 1991).

use nalgebra::DMatrix;

use super::parts::{NoisePart, PARTS};

/// Weights of a second difference.
const WEIGHTS: [f64; 3] = [1.0, -2.0, 1.0];

/// Steps of lags are this fraction of the distance to the nearest kink of the cross-covariance.
const RESOLUTION: usize = 16;

/// Longest lag, in longest averaging times: the tail of flicker falls with the square of the lag.
const LONGEST: usize = 8;

/// Sums of products of cross-covariances for every pair of parts: the covariance matrix for any
/// variances of the parts is a quadratic form of them.
pub(super) struct ScaleCovariance {
    pairs: Vec<(usize, usize, DMatrix<f64>)>,
}

impl ScaleCovariance {
    /// For averaging times in samples of a record of `samples`.
    pub(super) fn new(samples: usize, averaging: &[usize]) -> Self {
        let scales = averaging.len();
        let mut pairs: Vec<(usize, usize, DMatrix<f64>)> = (0..PARTS)
            .flat_map(|p| (p..PARTS).map(move |q| (p, q, DMatrix::zeros(scales, scales))))
            .collect();
        for row in 0..scales {
            for column in row..scales {
                let sums = sums(samples, averaging[row], averaging[column]);
                for (p, q, matrix) in &mut pairs {
                    matrix[(row, column)] = sums[*p][*q];
                    matrix[(column, row)] = sums[*p][*q];
                }
            }
        }
        Self { pairs }
    }

    /// Covariance matrix for variances of the parts, for samples of one second.
    pub(super) fn of(&self, variances: &[f64; PARTS]) -> DMatrix<f64> {
        let scales = self
            .pairs
            .first()
            .map_or(0, |(_, _, matrix)| matrix.nrows());
        let mut covariance = DMatrix::zeros(scales, scales);
        for (p, q, matrix) in &self.pairs {
            let twice = if p == q { 1.0 } else { 2.0 };
            let factor = twice * variances[*p] * variances[*q];
            if factor != 0.0 {
                covariance += matrix * factor;
            }
        }
        covariance
    }

    /// The same without the first averaging times.
    pub(super) fn without_first(&self, first: usize) -> Self {
        let pairs = self.pairs.iter().map(|(p, q, matrix)| {
            let left = matrix.nrows() - first;
            (
                *p,
                *q,
                matrix.view((first, first), (left, left)).into_owned(),
            )
        });
        Self {
            pairs: pairs.collect(),
        }
    }
}

/// Sums for one pair of averaging times.
fn sums(samples: usize, one: usize, other: usize) -> [[f64; PARTS]; PARTS] {
    let (short, long) = (one.min(other), one.max(other));
    let [differences, differences_long] = [short, long].map(|m| samples + 1 - 2 * m);
    // Number of pairs of differences whose centres are this lag apart: both stretches of centres have
    // the middle of the record in common.
    let pairs = |lag: usize| {
        let overlap = (differences + differences_long) as f64 / 2.0 - lag as f64;
        overlap.clamp(0.0, differences.min(differences_long) as f64)
    };
    let mut sums = [[0.0; PARTS]; PARTS];
    let mut add = |lag: usize, weight: f64, cross: &[f64; PARTS], from: usize| {
        let weight = weight * pairs(lag);
        for p in 0..PARTS {
            for q in p.max(from)..PARTS {
                sums[p][q] += weight * cross[p] * cross[q];
            }
        }
    };
    let longest = (LONGEST * long).min(samples - short - long);
    let mut lags = vec![0];
    while let Some(&lag) = lags.last().filter(|lag| **lag < longest) {
        let distance = lag.min(lag.abs_diff(long));
        let step = (distance.max(short) / RESOLUTION).max(1);
        let next = if lag < long {
            (lag + step).min(long)
        } else {
            lag + step
        };
        lags.push(next.min(longest));
    }
    // Trapezoids with the ends of the sum (Euler and Maclaurin), both signs of the lag at once: for
    // steps of one sample this is the sum itself.
    for (place, &lag) in lags.iter().enumerate() {
        let before = place.checked_sub(1).map_or(0, |before| lag - lags[before]);
        let after = lags.get(place + 1).map_or(0, |next| next - lag);
        let ends = match (before, after) {
            (0, 0) => 1.0,
            (0, _) => 0.0,
            (_, 0) => 1.0,
            _ => 0.0,
        };
        let weight = (before + after) as f64 + ends;
        let mut cross = smooth(lag as f64, short as f64, long as f64);
        cross[0] = 0.0;
        add(lag, weight, &cross, 1);
    }
    for (lag, size) in spikes(short, long) {
        let mut cross = smooth(lag as f64, short as f64, long as f64);
        cross[0] = size;
        let weight = if lag == 0 { 1.0 } else { 2.0 };
        let lag_pairs = pairs(lag);
        for q in 0..PARTS {
            sums[0][q] += weight * lag_pairs * size * cross[q];
        }
    }
    let squares = [short, long].map(|m| 2.0 * (m * m) as f64);
    let counts = differences as f64 * differences_long as f64;
    sums.map(|row| row.map(|sum| 2.0 * sum / (counts * squares[0] * squares[1])))
}

/// Cross-covariance of second differences whose centres are `lag` apart, without that of quantisation.
fn smooth(lag: f64, short: f64, long: f64) -> [f64; PARTS] {
    let mut cross = [0.0; PARTS];
    for (i, one) in WEIGHTS.iter().enumerate() {
        for (j, other) in WEIGHTS.iter().enumerate() {
            let apart = lag + (i as f64 - 1.0) * short - (j as f64 - 1.0) * long;
            for (sum, part) in cross.iter_mut().zip(NoisePart::ALL) {
                *sum += one * other * part.angle_covariance(apart);
            }
        }
    }
    cross
}

/// Lags at which the cross-covariance of quantisation is not zero, none of them negative, and its size.
fn spikes(short: usize, long: usize) -> Vec<(usize, f64)> {
    let mut sizes = std::collections::BTreeMap::new();
    for (i, one) in (-1_i64..=1).zip(WEIGHTS) {
        for (j, other) in (-1_i64..=1).zip(WEIGHTS) {
            let lag = j * long as i64 - i * short as i64;
            if lag >= 0 {
                *sizes.entry(lag as usize).or_insert(0.0) += one * other;
            }
        }
    }
    sizes.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Covariance of the Allan variances as quadratic forms of independent unit deviates: 2 tr(A A').
    fn dense(
        samples: usize,
        averaging: &[usize],
        deviates: usize,
        phase: impl Fn(usize, usize) -> f64,
    ) -> DMatrix<f64> {
        let forms: Vec<DMatrix<f64>> = averaging
            .iter()
            .map(|&m| {
                let count = samples + 1 - 2 * m;
                let difference = DMatrix::from_fn(count, deviates, |k, column| {
                    phase(k + 2 * m, column) - 2.0 * phase(k + m, column) + phase(k, column)
                });
                let norm = count as f64 * 2.0 * (m * m) as f64;
                difference.transpose() * difference / norm
            })
            .collect();
        DMatrix::from_fn(averaging.len(), averaging.len(), |row, column| {
            2.0 * forms[row].dot(&forms[column])
        })
    }

    fn assert_equal(found: &DMatrix<f64>, expected: &DMatrix<f64>, relative: f64) {
        for row in 0..found.nrows() {
            for column in 0..found.ncols() {
                let scale = (expected[(row, row)] * expected[(column, column)]).sqrt();
                let difference = found[(row, column)] - expected[(row, column)];
                let place = format!("{row} {column}: {found} {expected}");
                assert!(difference.abs() < relative * scale, "{place}");
            }
        }
    }

    /// The same by quadratic forms, for noise whose angle is a linear map of independent deviates.
    #[test]
    fn covariances_are_those_of_quadratic_forms() {
        const SAMPLES: usize = 200;
        let averaging = [1, 2, 4, 8, 16, 32, 64];
        let sums = ScaleCovariance::new(SAMPLES, &averaging);
        // Steps of up to a sixteenth of the shorter averaging time leave less than a hundredth of a variance.
        const STEPS: f64 = 0.01;
        let white = dense(SAMPLES, &averaging, SAMPLES, |k, i| {
            f64::from(u8::from(i < k))
        });
        assert_equal(&sums.of(&[0.0, 1.0, 0.0, 0.0]), &white, STEPS);
        let quantised = dense(SAMPLES, &averaging, SAMPLES + 1, |k, i| {
            f64::from(u8::from(i == k))
        });
        assert_equal(&sums.of(&[1.0, 0.0, 0.0, 0.0]), &quantised, 1e-12);
        // A rate walk changes by deviate 2i over sample i, and its mean over it by half of that and
        // deviate 2i + 1 over the root of twelve.
        let walk = dense(SAMPLES, &averaging, 2 * SAMPLES, |k, i| {
            let (sample, first) = (i / 2, i % 2 == 0);
            match (sample < k, first) {
                (false, _) => 0.0,
                (true, true) => (k - sample) as f64 - 0.5,
                (true, false) => 1.0 / 12.0_f64.sqrt(),
            }
        });
        assert_equal(&sums.of(&[0.0, 0.0, 0.0, 1.0]), &walk, STEPS);
        let mixed = dense(SAMPLES, &averaging, 2 * SAMPLES + 1, |k, i| {
            if i < SAMPLES {
                f64::from(u8::from(i < k))
            } else {
                2.0 * f64::from(u8::from(i - SAMPLES == k))
            }
        });
        assert_equal(&sums.of(&[4.0, 1.0, 0.0, 0.0]), &mixed, STEPS);
    }

    /// Flicker has no finite set of deviates: its degrees of freedom are those of the handbook's
    /// approximation, which is good to some percent.
    #[test]
    fn degrees_of_freedom_of_flicker_are_those_of_the_handbook() {
        use super::super::NoiseType;
        let averaging = [2, 4, 8, 16, 32, 64];
        let covariance = ScaleCovariance::new(1000, &averaging).of(&[0.0, 0.0, 1.0, 0.0]);
        for (k, m) in averaging.iter().enumerate() {
            let level = NoisePart::BiasInstability.variance(*m as f64);
            let found = 2.0 * level * level / covariance[(k, k)];
            let expected = NoiseType::FlickerRate.degrees_of_freedom(1001, *m);
            assert!(
                (found / expected - 1.0).abs() < 0.1,
                "{m}: {found} {expected}"
            );
        }
    }
}

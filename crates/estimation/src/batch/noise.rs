//! Likelihood of the noise: its derivatives, carried along with the filter.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::DMatrix;

use super::filter::predict_columns;
use super::linearisation::Whitened;
use super::pass::Taken;
use super::step::{Step, add};
use super::walk::{Joint, WalkStep, dot};

/// Likelihood of the noise at one point, and its derivatives by the natural logarithms of the noise
/// variances: those of the outputs, those of the noise inputs, those of the random walks.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseScore {
    /// Number of output values used.
    pub values: usize,
    /// Sum of the logarithms of the innovations' variances.
    pub log_variance: f64,
    /// Its derivatives.
    pub d_log_variance: Vec<f64>,
    /// Gram matrix of the whitened residual and the columns of the pass.
    pub gram: DMatrix<f64>,
    /// Its derivatives.
    pub d_gram: Vec<DMatrix<f64>>,
    /// Expected information on the logarithms with all columns known, by rows.
    pub information: Vec<f64>,
}

impl NoiseScore {
    /// The log-likelihood with all columns known.
    #[must_use]
    pub fn log_likelihood(&self) -> f64 {
        let constant = self.values as f64 * ln(core::f64::consts::TAU);
        -0.5 * (self.gram[(0, 0)] + self.log_variance + constant)
    }

    /// Its gradient.
    #[must_use]
    pub fn gradient(&self) -> Vec<f64> {
        let each = self.d_log_variance.iter().zip(&self.d_gram);
        each.map(|(variance, gram)| -0.5 * (variance + gram[(0, 0)]))
            .collect()
    }
}

/// Derivatives of mean, columns and covariance of a filter with respect to logarithms of variances
/// (Gupta, Mehra, IEEE Trans. Automatic Control 19(6), 1974).
pub(crate) struct NoiseFilter<const M: usize> {
    outputs: usize,
    stride: usize,
    /// The first noise that derivatives are by.
    first: usize,
    each: Vec<Derivative<M>>,
    score: NoiseScore,
    /// Derivative of the whitened row, before it is whitened.
    d_row: Vec<f64>,
    d_cross: Vec<f64>,
}

/// Derivatives by one logarithm.
struct Derivative<const M: usize> {
    /// Of the columns of the filter.
    columns: Vec<f64>,
    covariance: Joint<M>,
    /// Of the last innovation.
    innovation: f64,
    /// Of the variance of the last innovation, over it.
    variance: f64,
}

impl<const M: usize> NoiseFilter<M> {
    pub(crate) fn new(outputs: usize, columns: usize, walks: usize, first: usize) -> Self {
        let count = outputs + M + walks;
        let stride = columns + 1;
        let first = first.min(count);
        Self {
            outputs,
            stride,
            first,
            each: (first..count)
                .map(|_| Derivative {
                    columns: vec![0.0; (M + walks) * stride],
                    covariance: Joint::new([[0.0; M]; M], walks),
                    innovation: 0.0,
                    variance: 0.0,
                })
                .collect(),
            score: NoiseScore {
                values: 0,
                log_variance: 0.0,
                d_log_variance: vec![0.0; count],
                gram: DMatrix::zeros(stride, stride),
                d_gram: vec![DMatrix::zeros(stride, stride); count],
                information: vec![0.0; count * count],
            },
            d_row: vec![0.0; stride],
            d_cross: vec![0.0; walks],
        }
    }

    pub(crate) fn predict(&mut self, step: &Step<M>, walks: &[WalkStep<M>]) {
        for (k, own) in (self.first..).zip(&mut self.each) {
            predict_columns(&step.moving, walks, &mut own.columns, self.stride);
            own.covariance.predict(&step.moving, walks);
            let Some(input) = k.checked_sub(self.outputs) else {
                continue;
            };
            match input.checked_sub(M) {
                None => add(&mut own.covariance.moving, &step.shares[input]),
                Some(walk) => own.covariance.add_walk(walk, &walks[walk]),
            }
        }
    }

    /// Takes an output after the filter has.
    pub(crate) fn take(&mut self, whitened: &Whitened<'_>, taken: &Taken<'_, M>) {
        let deviation = whitened.deviation;
        let total = deviation * deviation;
        let score = &mut self.score;
        score.values += 1;
        score.log_variance += ln(total);
        for (j, value) in whitened.columns.iter().enumerate() {
            for (i, other) in whitened.columns[..=j].iter().enumerate() {
                score.gram[(i, j)] += value * other;
            }
        }
        let direct = whitened.output;
        for (k, own) in (self.first..).zip(&mut self.each) {
            let variance = if k == direct { taken.variance } else { 0.0 };
            own.take(
                whitened,
                taken,
                variance,
                &mut self.d_row,
                &mut self.d_cross,
            );
            score.d_log_variance[k] += own.variance;
            // Of the whitened row w = v / s: v' / s - w s' / s.
            for (d_row, column) in self.d_row.iter_mut().zip(whitened.columns) {
                *d_row = *d_row / deviation - 0.5 * column * own.variance;
            }
            let gram = &mut score.d_gram[k];
            for (j, column) in whitened.columns.iter().enumerate() {
                for (i, other) in whitened.columns[..=j].iter().enumerate() {
                    gram[(i, j)] += self.d_row[j] * other + self.d_row[i] * column;
                }
            }
        }
        let count = self.first + self.each.len();
        for k in self.first..count {
            for l in self.first..=k {
                let (one, other) = (&self.each[k - self.first], &self.each[l - self.first]);
                let information =
                    0.5 * one.variance * other.variance + one.innovation * other.innovation / total;
                score.information[k * count + l] += information;
                if l < k {
                    score.information[l * count + k] += information;
                }
            }
        }
    }

    pub(crate) fn finish(self) -> NoiseScore {
        let mut score = self.score;
        score.gram.fill_lower_triangle_with_upper_triangle();
        for gram in &mut score.d_gram {
            gram.fill_lower_triangle_with_upper_triangle();
        }
        score
    }
}

impl<const M: usize> Derivative<M> {
    /// Takes an output whose own noise variance has the derivative `d_noise`; leaves the derivative of
    /// the innovations in `d_row`.
    fn take(
        &mut self,
        whitened: &Whitened<'_>,
        taken: &Taken<'_, M>,
        d_noise: f64,
        d_row: &mut [f64],
        d_cross_walks: &mut [f64],
    ) {
        let stride = d_row.len();
        let deviation = whitened.deviation;
        let total = deviation * deviation;
        let h = &taken.jacobian;
        d_row.fill(0.0);
        for (h, row) in h.iter().zip(self.columns.chunks_exact(stride)) {
            for (d_row, value) in d_row.iter_mut().zip(row) {
                *d_row -= h * value;
            }
        }
        let d_cross = self.covariance.with_output(h, d_cross_walks);
        let d_total = d_noise + dot(h, &d_cross);
        let all = taken.cross.iter().chain(taken.walk_cross);
        let d_all = d_cross.iter().chain(d_cross_walks.iter());
        let rows = self.columns.chunks_exact_mut(stride);
        for ((row, cross), d_cross) in rows.zip(all).zip(d_all) {
            let gain = cross / total;
            let d_gain = (d_cross - gain * d_total) / total;
            let innovation = d_gain * deviation;
            for ((value, own), column) in row.iter_mut().zip(&*d_row).zip(whitened.columns) {
                *value += innovation * column + gain * own;
            }
        }
        self.subtract(taken, &d_cross, d_cross_walks, total, d_total);
        self.innovation = d_row[0];
        self.variance = d_total / total;
    }

    /// The derivative of - c cᵀ / S, c being the covariance with the output.
    fn subtract(
        &mut self,
        taken: &Taken<'_, M>,
        d_cross: &[f64; M],
        d_walks: &[f64],
        total: f64,
        d_total: f64,
    ) {
        let change = |c: f64, other: f64, d_c: f64, d_other: f64| {
            (d_c * other + c * d_other - c * other * (d_total / total)) / total
        };
        let joint = &mut self.covariance;
        let (cross, walks) = (taken.cross, taken.walk_cross);
        for i in 0..M {
            for j in 0..M {
                joint.moving[i][j] -= change(cross[i], cross[j], d_cross[i], d_cross[j]);
            }
        }
        let count = walks.len();
        for w in 0..count {
            for i in 0..M {
                joint.cross[w][i] -= change(cross[i], walks[w], d_cross[i], d_walks[w]);
            }
            for v in 0..count {
                joint.walks[w * count + v] -= change(walks[w], walks[v], d_walks[w], d_walks[v]);
            }
        }
    }
}

fn ln(value: f64) -> f64 {
    gyrocal_scalar::Scalar::ln(value)
}

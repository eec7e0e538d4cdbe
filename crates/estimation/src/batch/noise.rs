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
    /// Information on the logarithms with all columns known, by rows: expected of the variances, and as the
    /// innovations have it of their means.
    pub information: Vec<f64>,
    /// Sums over the innovations of each whitened row times the derivatives of that innovation's mean, over
    /// its standard deviation: a row of 1 + columns for each logarithm. Of the information on the means the
    /// columns take that on their projection.
    pub with_rows: Vec<f64>,
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

/// Rows that are gathered before they are multiplied: with their derivatives they stay in the
/// second-level cache.
const BLOCK: usize = 48;

/// Derivatives of mean, columns and covariance of a filter with respect to logarithms of variances
/// (Gupta, Mehra, IEEE Trans. Automatic Control 19(6), 1974).
pub(crate) struct NoiseFilter<const M: usize> {
    outputs: usize,
    stride: usize,
    /// The first noise that derivatives are by.
    first: usize,
    each: Vec<Derivative<M>>,
    /// Derivatives of the columns of the filter: a row for each moving state, then for each walk, that
    /// holds those by each logarithm side by side. All have the same transition and the same gain.
    columns: Vec<f64>,
    score: NoiseScore,
    /// Share of residual and columns in the innovations whose information is taken.
    shares: Vec<f64>,
    /// Derivatives of the innovations, then of the whitened rows, by each logarithm.
    d_rows: Vec<f64>,
    d_cross: Vec<f64>,
    /// Gain of the last output: of the moving states, then of the walks.
    gains: Vec<f64>,
    sums: Sums,
}

/// Derivatives by one logarithm.
struct Derivative<const M: usize> {
    covariance: Joint<M>,
    /// Of the last innovation.
    innovation: f64,
    /// Of the variance of the last innovation, over it.
    variance: f64,
}

/// Sums of w wᵀ over the whitened rows w, and of w' wᵀ for each derivative w' of them.
struct Sums {
    /// These below each other.
    products: DMatrix<f64>,
    /// A row and its derivatives a column.
    block: DMatrix<f64>,
    held: usize,
    stride: usize,
}

impl Sums {
    fn new(stride: usize, derivatives: usize) -> Self {
        let size = stride * (1 + derivatives);
        Self {
            products: DMatrix::zeros(size, stride),
            block: DMatrix::zeros(size, BLOCK),
            held: 0,
            stride,
        }
    }

    fn add(&mut self, row: &[f64], derivatives: &[f64]) {
        let mut held = self.block.column_mut(self.held);
        let (first, others) = held.as_mut_slice().split_at_mut(self.stride);
        first.copy_from_slice(row);
        others.copy_from_slice(derivatives);
        self.held += 1;
        if self.held == BLOCK {
            self.multiply();
        }
    }

    fn multiply(&mut self) {
        let all = self.block.columns(0, self.held);
        let rows = all.rows(0, self.stride).transpose();
        self.products.gemm(1.0, &all, &rows, 1.0);
        self.held = 0;
    }

    /// The sum of w wᵀ.
    fn gram(&self) -> DMatrix<f64> {
        self.products.rows(0, self.stride).into_owned()
    }

    /// The derivative of it.
    fn d_gram(&self, derivative: usize) -> DMatrix<f64> {
        let from = (1 + derivative) * self.stride;
        let product = self.products.rows(from, self.stride);
        product + product.transpose()
    }
}

impl<const M: usize> NoiseFilter<M> {
    pub(crate) fn new(outputs: usize, columns: usize, walks: usize, first: usize) -> Self {
        let count = outputs + M + walks;
        let stride = columns + 1;
        let first = first.min(count);
        let derivatives = count - first;
        let derivative = |_| Derivative {
            covariance: Joint::new([[0.0; M]; M], walks),
            innovation: 0.0,
            variance: 0.0,
        };
        Self {
            outputs,
            stride,
            first,
            each: (0..derivatives).map(derivative).collect(),
            columns: vec![0.0; (M + walks) * derivatives * stride],
            score: NoiseScore {
                values: 0,
                log_variance: 0.0,
                d_log_variance: vec![0.0; count],
                gram: DMatrix::zeros(0, 0),
                d_gram: Vec::new(),
                information: vec![0.0; count * count],
                with_rows: vec![0.0; count * stride],
            },
            shares: {
                let mut shares = vec![0.0; stride];
                shares[0] = 1.0;
                shares
            },
            d_rows: vec![0.0; derivatives * stride],
            d_cross: vec![0.0; walks],
            gains: vec![0.0; M + walks],
            sums: Sums::new(stride, derivatives),
        }
    }

    /// Takes the information where the columns have changed by `change`.
    pub(crate) fn change_columns(&mut self, change: &[f64]) {
        for (share, change) in self.shares[1..].iter_mut().zip(change) {
            *share = *change;
        }
    }

    pub(crate) fn predict(&mut self, step: &Step<M>, walks: &[WalkStep<M>]) {
        if self.each.is_empty() {
            return;
        }
        let width = self.d_rows.len();
        predict_columns(&step.moving, walks, &mut self.columns, width);
        for (k, own) in (self.first..).zip(&mut self.each) {
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
        let reciprocal = 1.0 / total;
        self.score.values += 1;
        self.score.log_variance += ln(total);
        self.set_innovations(&taken.jacobian);
        let all = taken.cross.iter().chain(taken.walk_cross);
        for (gain, cross) in self.gains.iter_mut().zip(all) {
            *gain = cross * reciprocal;
        }
        let direct = whitened.output;
        let (stride, width) = (self.stride, self.d_rows.len());
        let per_deviation = 1.0 / deviation;
        for (index, own) in self.each.iter_mut().enumerate() {
            let k = self.first + index;
            let d_noise = if k == direct { taken.variance } else { 0.0 };
            let d_row = &mut self.d_rows[index * stride..(index + 1) * stride];
            own.innovation = d_row.iter().zip(&self.shares).map(|(d, s)| d * s).sum();
            let with_row = &mut self.score.with_rows[k * stride..(k + 1) * stride];
            for (sum, column) in with_row.iter_mut().zip(whitened.columns) {
                *sum += own.innovation * per_deviation * column;
            }
            let d_moving = own
                .covariance
                .with_output(&taken.jacobian, &mut self.d_cross);
            let d_total = d_noise + dot(&taken.jacobian, &d_moving);
            own.variance = d_total * reciprocal;
            let d_all = d_moving.iter().chain(self.d_cross.iter());
            let rows = self.columns.chunks_exact_mut(width);
            for ((row, gain), d_cross) in rows.zip(&self.gains).zip(d_all) {
                let innovation = (d_cross - gain * d_total) * per_deviation;
                let row = &mut row[index * stride..(index + 1) * stride];
                for ((value, own), column) in row.iter_mut().zip(&*d_row).zip(whitened.columns) {
                    *value += innovation * column + gain * own;
                }
            }
            own.subtract(taken, &self.gains, &d_moving, &self.d_cross);
            self.score.d_log_variance[k] += own.variance;
            // Of the whitened row w = v / s: v' / s - w s' / s.
            let half = 0.5 * own.variance;
            for (d_row, column) in d_row.iter_mut().zip(whitened.columns) {
                *d_row = *d_row * per_deviation - half * column;
            }
        }
        self.sums.add(whitened.columns, &self.d_rows);
        self.add_information(reciprocal);
    }

    /// Sets the derivatives of the innovations of an output.
    fn set_innovations(&mut self, jacobian: &[f64; M]) {
        let width = self.d_rows.len();
        self.d_rows.fill(0.0);
        if width == 0 {
            return;
        }
        for (h, row) in jacobian.iter().zip(self.columns.chunks_exact(width)) {
            for (d_row, value) in self.d_rows.iter_mut().zip(row) {
                *d_row -= h * value;
            }
        }
    }

    /// Adds the expected information of the last output, one over whose variance is `reciprocal`.
    fn add_information(&mut self, reciprocal: f64) {
        let count = self.first + self.each.len();
        for (k, one) in (self.first..).zip(&self.each) {
            for (l, other) in (self.first..=k).zip(&self.each) {
                let information = 0.5 * one.variance * other.variance
                    + one.innovation * other.innovation * reciprocal;
                self.score.information[k * count + l] += information;
                if l < k {
                    self.score.information[l * count + k] += information;
                }
            }
        }
    }

    pub(crate) fn finish(mut self) -> NoiseScore {
        self.sums.multiply();
        let mut score = self.score;
        score.gram = self.sums.gram();
        let size = self.stride;
        score.d_gram = vec![DMatrix::zeros(size, size); self.first];
        score
            .d_gram
            .extend((0..self.each.len()).map(|derivative| self.sums.d_gram(derivative)));
        score
    }
}

impl<const M: usize> Derivative<M> {
    /// The derivative of - c cᵀ / S, c being the covariance with the output and `gains` c / S.
    fn subtract(
        &mut self,
        taken: &Taken<'_, M>,
        gains: &[f64],
        d_moving: &[f64; M],
        d_walks: &[f64],
    ) {
        let (of_moving, of_walks) = gains.split_at(M);
        let joint = &mut self.covariance;
        let left: [f64; M] = core::array::from_fn(|i| d_moving[i] - taken.cross[i] * self.variance);
        for i in 0..M {
            for j in 0..=i {
                joint.moving[i][j] -= d_moving[i] * of_moving[j] + of_moving[i] * left[j];
                joint.moving[j][i] = joint.moving[i][j];
            }
        }
        let count = of_walks.len();
        for (w, gain) in of_walks.iter().enumerate() {
            let left_walk = d_walks[w] - taken.walk_cross[w] * self.variance;
            for i in 0..M {
                joint.cross[w][i] -= d_moving[i] * gain + of_moving[i] * left_walk;
            }
            for v in 0..=w {
                let change = left_walk * of_walks[v] + gain * d_walks[v];
                joint.walks[w * count + v] -= change;
                joint.walks[v * count + w] = joint.walks[w * count + v];
            }
        }
    }
}

fn ln(value: f64) -> f64 {
    gyrocal_scalar::Scalar::ln(value)
}

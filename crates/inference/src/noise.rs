//! Likelihood of the noise: its derivatives, carried along with the filter.

use gyrocal_estimation::EstimationError;
use gyrocal_scalar::Scalar;
use nalgebra::DMatrix;

use crate::error::PassError;
use crate::pass::{Made, Pass, Taken, Watch};
use crate::small::{add_triangle, apply, dot, product, sandwich};

/// Likelihood of the noise at one point, and its derivatives by the natural logarithms of the noise
/// variances: those of the outputs, those of the noises, those of further noises.
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
        let constant = self.values as f64 * Scalar::ln(core::f64::consts::TAU);
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
struct NoiseFilter {
    states: usize,
    outputs: usize,
    triangle: usize,
    /// Factors of the noises.
    factors: Vec<f64>,
    stride: usize,
    /// The first noise that derivatives are by.
    first: usize,
    each: Vec<Derivative>,
    /// Derivatives of the columns of the filter: a row for each state, that holds those by each logarithm
    /// side by side. All have the same transition and the same gain.
    columns: Vec<f64>,
    score: NoiseScore,
    /// Share of residual and columns in the innovations whose information is taken.
    shares: Vec<f64>,
    /// Derivatives of the innovations, then of the whitened rows, by each logarithm.
    d_rows: Vec<f64>,
    d_cross: Vec<f64>,
    /// Gain of the last output.
    gains: Vec<f64>,
    moved: Vec<f64>,
    memory: Vec<f64>,
    sums: Sums,
}

/// Derivatives by one logarithm.
struct Derivative {
    /// By rows.
    covariance: Vec<f64>,
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

impl NoiseFilter {
    fn new(pass: &Pass<'_>, columns: usize, first: usize) -> Self {
        let outputs = pass.record.layout().outputs;
        let (states, noises) = pass.sizes();
        let count = outputs + noises;
        let stride = columns + 1;
        let first = first.min(count);
        let derivatives = count - first;
        let derivative = |_| Derivative {
            covariance: vec![0.0; states * states],
            innovation: 0.0,
            variance: 0.0,
        };
        let mut shares = vec![0.0; stride];
        shares[0] = 1.0;
        Self {
            states,
            outputs,
            triangle: states * (states + 1) / 2,
            factors: (outputs..count)
                .map(|noise| pass.factors.get(noise).copied().unwrap_or(1.0))
                .collect(),
            stride,
            first,
            each: (0..derivatives).map(derivative).collect(),
            columns: vec![0.0; states * derivatives * stride],
            score: NoiseScore {
                values: 0,
                log_variance: 0.0,
                d_log_variance: vec![0.0; count],
                gram: DMatrix::zeros(0, 0),
                d_gram: Vec::new(),
                information: vec![0.0; count * count],
                with_rows: vec![0.0; count * stride],
            },
            shares,
            d_rows: vec![0.0; derivatives * stride],
            d_cross: vec![0.0; states],
            gains: vec![0.0; states],
            moved: vec![0.0; states * derivatives * stride],
            memory: vec![0.0; states * states],
            sums: Sums::new(stride, derivatives),
        }
    }

    /// Sets the derivatives of the innovations of an output.
    fn set_innovations(&mut self, jacobian: &[f64]) {
        let width = self.d_rows.len();
        self.d_rows.fill(0.0);
        if width == 0 {
            return;
        }
        for (h, row) in jacobian.iter().zip(self.columns.chunks_exact(width)) {
            if *h != 0.0 {
                for (d_row, value) in self.d_rows.iter_mut().zip(row) {
                    *d_row -= h * value;
                }
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

    fn finish(mut self) -> NoiseScore {
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

impl Watch for NoiseFilter {
    fn begin(&mut self, state: usize, noise: usize, variance: f64) {
        let derivative = (self.outputs + noise).checked_sub(self.first);
        if let Some(own) = derivative.and_then(|index| self.each.get_mut(index)) {
            own.covariance[state * self.states + state] += variance;
        }
    }

    fn step(&mut self, made: &Made<'_>) -> Result<(), EstimationError> {
        match self.states {
            _ if self.each.is_empty() => {}
            3 => self.step_of(3, made),
            states => self.step_of(states, made),
        }
        Ok(())
    }

    fn take(&mut self, taken: &Taken<'_>) {
        match self.states {
            3 => self.take_of(3, taken),
            states => self.take_of(states, taken),
        }
    }
}

impl NoiseFilter {
    #[inline(always)]
    fn step_of(&mut self, n: usize, made: &Made<'_>) {
        let width = self.d_rows.len();
        product(made.by_states, &self.columns, n, width, &mut self.moved);
        core::mem::swap(&mut self.columns, &mut self.moved);
        for (k, own) in (self.first..).zip(&mut self.each) {
            sandwich(made.by_states, &mut own.covariance, n, &mut self.memory);
            if let Some(noise) = k.checked_sub(self.outputs) {
                let share = &made.shares[noise * self.triangle..(noise + 1) * self.triangle];
                add_triangle(&mut own.covariance, n, share, self.factors[noise]);
            }
        }
    }

    #[inline(always)]
    fn take_of(&mut self, n: usize, taken: &Taken<'_>) {
        let (jacobian, cross) = (&taken.jacobian[..n], &taken.cross[..n]);
        let whitened = &taken.whitened;
        let deviation = whitened.deviation;
        let total = deviation * deviation;
        let reciprocal = 1.0 / total;
        self.score.values += 1;
        self.score.log_variance += Scalar::ln(total);
        self.set_innovations(taken.jacobian);
        for (gain, cross) in self.gains.iter_mut().zip(taken.cross) {
            *gain = cross * reciprocal;
        }
        let (stride, width) = (self.stride, self.d_rows.len());
        let per_deviation = 1.0 / deviation;
        for (index, own) in self.each.iter_mut().enumerate() {
            let k = self.first + index;
            let d_noise = if k == whitened.output {
                taken.variance
            } else {
                0.0
            };
            let d_row = &mut self.d_rows[index * stride..(index + 1) * stride];
            own.innovation = dot(d_row, &self.shares);
            let with_row = &mut self.score.with_rows[k * stride..(k + 1) * stride];
            for (sum, column) in with_row.iter_mut().zip(whitened.columns) {
                *sum += own.innovation * per_deviation * column;
            }
            let d_cross = &mut self.d_cross[..n];
            apply(&own.covariance[..n * n], jacobian, d_cross);
            let d_total = d_noise + dot(jacobian, d_cross);
            own.variance = d_total * reciprocal;
            let rows = self.columns.chunks_exact_mut(width);
            for ((row, gain), d_cross) in rows.zip(&self.gains).zip(&self.d_cross) {
                let innovation = (d_cross - gain * d_total) * per_deviation;
                let row = &mut row[index * stride..(index + 1) * stride];
                for ((value, own), column) in row.iter_mut().zip(&*d_row).zip(whitened.columns) {
                    *value += innovation * column + gain * own;
                }
            }
            own.subtract(n, cross, &self.gains, &self.d_cross);
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
}

impl Derivative {
    /// The derivative of - c cᵀ / S, c being the covariance with the output and `gains` c / S.
    #[inline(always)]
    fn subtract(&mut self, n: usize, cross: &[f64], gains: &[f64], d_cross: &[f64]) {
        let (cross, gains, d_cross) = (&cross[..n], &gains[..n], &d_cross[..n]);
        let covariance = &mut self.covariance[..n * n];
        for i in 0..n {
            for j in 0..=i {
                let left = d_cross[j] - cross[j] * self.variance;
                let change = d_cross[i] * gains[j] + gains[i] * left;
                covariance[i * n + j] -= change;
                covariance[j * n + i] = covariance[i * n + j];
            }
        }
    }
}

impl Pass<'_> {
    /// Likelihood of the noise with its derivatives, all columns held fixed.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn noise_score(&self) -> Result<NoiseScore, PassError> {
        self.noise_score_from(0)
    }

    /// The same with derivatives by the noises from `first` on only; those by the others are zero.
    ///
    /// # Errors
    /// As [`Self::reduce`].
    pub fn noise_score_from(&self, first: usize) -> Result<NoiseScore, PassError> {
        let none = vec![0.0; self.columns.len()];
        let mut filter = NoiseFilter::new(self, 0, first);
        self.run(Some(&none), &mut filter)?;
        Ok(filter.finish())
    }

    /// The same with the columns free, for a likelihood that they are to be eliminated from, and with
    /// derivatives by the noises from `first` on only; those by the others are zero. The information is
    /// that where the columns have changed by `change`; by nothing if that is empty.
    ///
    /// # Errors
    /// As [`Self::noise_score`], and [`EstimationError::InvalidArgument`] if there is not one change for
    /// each column.
    pub fn noise_score_of_columns(
        &self,
        first: usize,
        change: &[f64],
    ) -> Result<NoiseScore, PassError> {
        let count = self.columns.len();
        if !change.is_empty() && change.len() != count {
            return Err(EstimationError::InvalidArgument {
                expected: "one change for each column",
            }
            .into());
        }
        let mut filter = NoiseFilter::new(self, count, first);
        for (share, change) in filter.shares[1..].iter_mut().zip(change) {
            *share = *change;
        }
        self.run(None, &mut filter)?;
        Ok(filter.finish())
    }
}

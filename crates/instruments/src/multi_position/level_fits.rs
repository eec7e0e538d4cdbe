//! Laws at one level of noise between stops, and at all.

use gyrocal_statistics::math::ln;
use nalgebra::{Cholesky, DMatrix, DVector};

use super::levels::Grid;
use super::stop_parts::StopParts;
use super::tridiagonal::Tridiagonal;

/// Least share of a column that others leave of it, where a fit has it.
const LEAST_SHARE: f64 = 1e-9;

/// Products of rates, terms and biases of logs over the covariance of one level, in this order.
pub(super) struct Gram {
    ln_determinant: f64,
    products: DMatrix<f64>,
}

/// A law fitted at one level.
pub(super) struct FitAtLevel {
    /// Restricted log-likelihood: the coefficients are integrated out.
    pub(super) log_likelihood: f64,
    /// The products with the columns of the law swept: its covariance in their place, estimates between them and the
    /// rates, and what the law leaves of all others.
    swept: DMatrix<f64>,
}

/// The products of one gyro at all levels, in the order of the grid.
///
/// The covariance is factored once for each pair of flicker and walk: the differences within stops, which have no
/// scatter, are eliminated, and what is left of the means is brought to tridiagonal form, to which each scatter is added.
pub(super) fn all_levels(parts: &StopParts, grid: &Grid, biases: usize) -> Vec<Gram> {
    let of = parts.covariance(biases);
    let means = of.columns.nrows() - of.differences;
    let mut pairs: Vec<_> = grid
        .pairs()
        .map(|[flicker, walk]| {
            let whole = &of.fixed + &of.flicker * (flicker * flicker) + &of.walk * (walk * walk);
            let within = (of.differences, of.differences);
            // Fast noise, which each part has, keeps the covariance positive definite.
            let factor = Cholesky::new_unchecked(whole.view((0, 0), within).clone_owned());
            let factor = factor.l_dirty();
            let shape = (of.differences, means);
            let mut across = whole.view((0, of.differences), shape).clone_owned();
            factor.solve_lower_triangular_unchecked_mut(&mut across);
            let mut columns = of.columns.rows(0, of.differences).clone_owned();
            factor.solve_lower_triangular_unchecked_mut(&mut columns);
            let rest = whole.view((of.differences, of.differences), (means, means));
            let form = Tridiagonal::of(
                rest - across.tr_mul(&across),
                of.columns.rows(of.differences, means) - across.tr_mul(&columns),
            );
            let pivots = (0..of.differences).map(|i| factor[(i, i)]);
            let ln_determinant: f64 = pivots.map(|pivot| 2.0 * ln(pivot)).sum();
            let products = columns.tr_mul(&columns);
            let levels: Vec<Gram> = grid
                .scatter()
                .iter()
                .map(|scatter| {
                    let scatter = parts.unit_deg_per_h * scatter;
                    let (of_means, by_means) = form.with(scatter * scatter);
                    Gram {
                        ln_determinant: ln_determinant + of_means,
                        products: &products + by_means,
                    }
                })
                .collect();
            levels.into_iter()
        })
        .collect();
    let mut all = Vec::with_capacity(grid.len());
    for _ in grid.scatter() {
        all.extend(pairs.iter_mut().filter_map(Iterator::next));
    }
    all
}

impl Gram {
    /// Fit of the rates by some columns; `None` where they are not determined.
    pub(super) fn fit(&self, columns: &[usize]) -> Option<FitAtLevel> {
        let mut swept = self.products.clone();
        let mut ln_information = 0.0;
        for column in columns {
            let pivot = swept[(*column, *column)];
            // Not a number of a column without any length.
            let is_left = pivot > LEAST_SHARE * self.products[(*column, *column)];
            if !is_left {
                return None;
            }
            ln_information += ln(pivot);
            sweep(&mut swept, *column);
        }
        Some(FitAtLevel {
            log_likelihood: -0.5 * (self.ln_determinant + ln_information + swept[(0, 0)]),
            swept,
        })
    }
}

/// Solves a symmetric matrix for one of its columns in place (Goodnight 1979, "A tutorial on the SWEEP operator").
fn sweep(matrix: &mut DMatrix<f64>, at: usize) {
    let pivot = matrix[(at, at)].recip();
    let column = matrix.column(at).clone_owned();
    for j in (0..matrix.ncols()).filter(|j| *j != at) {
        let share = matrix[(at, j)] * pivot;
        matrix.column_mut(j).axpy(-share, &column, 1.0);
        matrix[(at, j)] = share;
    }
    matrix.column_mut(at).scale_mut(-pivot);
    matrix[(at, at)] = pivot;
}

impl FitAtLevel {
    /// What the law leaves of the rates, squared over their covariance.
    pub(super) fn left(&self) -> f64 {
        self.swept[(0, 0)]
    }

    pub(super) fn estimates(&self, columns: &[usize]) -> DVector<f64> {
        DVector::from_fn(columns.len(), |i, _| self.swept[(columns[i], 0)])
    }

    pub(super) fn covariance(&self, columns: &[usize]) -> DMatrix<f64> {
        let count = columns.len();
        DMatrix::from_fn(count, count, |i, j| self.swept[(columns[i], columns[j])])
    }

    /// Estimate of one column more over its standard deviation, and the log-likelihood with it.
    pub(super) fn beside(&self, gram: &Gram, column: usize) -> Option<[f64; 2]> {
        let information = self.swept[(column, column)];
        if information.is_nan() || information <= LEAST_SHARE * gram.products[(column, column)] {
            return None;
        }
        let normal = self.swept[(column, 0)] / information.sqrt();
        let gain = 0.5 * (normal * normal - ln(information));
        Some([normal, self.log_likelihood + gain])
    }
}

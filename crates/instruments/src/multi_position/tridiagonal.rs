//! Symmetric matrices in tridiagonal form: a multiple of the identity is added without a further factorisation.

use gyrocal_statistics::math::ln;
use nalgebra::DMatrix;

/// A symmetric positive definite matrix, tridiagonal in an orthonormal basis, and columns in this basis.
pub(super) struct Tridiagonal {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
    columns: DMatrix<f64>,
}

impl Tridiagonal {
    /// By Householder reflections (Golub and Van Loan, Matrix Computations, algorithm 8.3.1).
    pub(super) fn of(mut matrix: DMatrix<f64>, mut columns: DMatrix<f64>) -> Self {
        let rows = matrix.nrows();
        let mut beside = Vec::with_capacity(rows);
        for at in 1..rows {
            let below = rows - at;
            let mut mirror = matrix
                .view((at, at - 1), (below, 1))
                .column(0)
                .clone_owned();
            let length = mirror.norm();
            let signed = if mirror[0] < 0.0 { -length } else { length };
            if length <= mirror[0].abs() {
                // Nothing is beyond the first.
                beside.push(mirror[0]);
                continue;
            }
            beside.push(-signed);
            mirror[0] += signed;
            let share = 2.0 / mirror.norm_squared();
            let mut rest = matrix.view_mut((at, at), (below, below));
            let mut turned = &rest * &mirror * share;
            let half = 0.5 * share * turned.dot(&mirror);
            turned.axpy(-half, &mirror, 1.0);
            rest.ger(-1.0, &mirror, &turned, 1.0);
            rest.ger(-1.0, &turned, &mirror, 1.0);
            let mut own = columns.rows_mut(at, below);
            let shares = own.tr_mul(&mirror) * share;
            own.ger(-1.0, &mirror, &shares, 1.0);
        }
        Self {
            diagonal: matrix.diagonal().as_slice().to_vec(),
            beside,
            columns: columns.transpose(),
        }
    }

    /// Logarithm of the determinant of the matrix with `added` on its diagonal, and the products of the columns over
    /// that matrix.
    pub(super) fn with(&self, added: f64) -> (f64, DMatrix<f64>) {
        let count = self.columns.nrows();
        let mut products = DMatrix::zeros(count, count);
        let mut row = vec![0.0; count];
        let (mut ln_determinant, mut share) = (0.0, 0.0);
        for (at, diagonal) in self.diagonal.iter().enumerate() {
            let before = at.checked_sub(1).map_or(0.0, |last| self.beside[last]);
            let pivot = diagonal + added - share * before;
            ln_determinant += ln(pivot);
            for (own, column) in row.iter_mut().zip(self.columns.column(at).iter()) {
                *own = column - share * *own;
            }
            for (j, of_j) in row.iter().enumerate() {
                let over = of_j / pivot;
                for (product, of_i) in products.column_mut(j).iter_mut().zip(&row) {
                    *product += over * of_i;
                }
            }
            share = self.beside.get(at).map_or(0.0, |next| next / pivot);
        }
        (ln_determinant, products)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Cholesky;

    use super::*;

    #[test]
    fn products_and_determinants_are_those_of_the_whole_matrix() {
        for rows in [1, 2, 3, 9] {
            let of = |i: usize, j: usize| 1.0 / (1.0 + i.abs_diff(j) as f64) + ((i * j) % 5) as f64;
            let half = DMatrix::from_fn(rows, rows, of);
            let matrix = &half * half.transpose() + DMatrix::identity(rows, rows);
            let columns = DMatrix::from_fn(rows, 4, |i, j| ((7 * i + 3 * j) % 11) as f64 - 5.0);
            let form = Tridiagonal::of(matrix.clone(), columns.clone());
            for added in [0.0, 0.3, 1e4] {
                let whole = &matrix + added * DMatrix::identity(rows, rows);
                let cholesky = Cholesky::new(whole).unwrap();
                let expected = columns.tr_mul(&cholesky.solve(&columns));
                let (ln_determinant, products) = form.with(added);
                let scale = expected.norm();
                // A few operations for each row.
                assert!((products - expected).norm() < 1e-12 * scale);
                assert!((ln_determinant - cholesky.determinant().ln()).abs() < 1e-10);
            }
        }
    }
}

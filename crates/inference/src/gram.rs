//! The Gram matrix of whitened innovation columns.

use nalgebra::DMatrix;

/// Rows that are gathered before they are multiplied: long enough for a matrix product, and in
/// the second-level cache with some hundred columns.
const BLOCK: usize = 96;

/// Sum of w wᵀ over the rows w = [residual, columns] of a whitened linear model: its first
/// diagonal element is the sum of squares, the rest of the first row the gradient, and the rest
/// the information on the columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Gram {
    matrix: DMatrix<f64>,
    /// One row of the linear model a column.
    block: DMatrix<f64>,
    held: usize,
}

impl Gram {
    /// The matrix of no rows, for a residual and `columns` columns.
    #[must_use]
    pub fn new(columns: usize) -> Self {
        let size = columns + 1;
        Self {
            matrix: DMatrix::zeros(size, size),
            block: DMatrix::zeros(size, BLOCK),
            held: 0,
        }
    }

    /// Number of columns without the residual.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.matrix.nrows() - 1
    }

    /// Adds a row; its first element is the residual.
    ///
    /// # Panics
    /// If the row has not one element for the residual and one for each column.
    pub fn add(&mut self, row: &[f64]) {
        self.block.column_mut(self.held).copy_from_slice(row);
        self.held += 1;
        if self.held == BLOCK {
            self.multiply();
        }
    }

    /// The sum.
    #[must_use]
    pub fn finish(mut self) -> DMatrix<f64> {
        self.multiply();
        self.matrix.fill_lower_triangle_with_upper_triangle();
        self.matrix
    }

    fn multiply(&mut self) {
        let block = self.block.columns(0, self.held);
        self.matrix.gemm(1.0, &block, &block.transpose(), 1.0);
        self.held = 0;
    }
}

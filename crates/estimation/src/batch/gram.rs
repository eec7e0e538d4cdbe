//! The Gram matrix of whitened innovation columns.

use alloc::vec;
use alloc::vec::Vec;

/// Rows that are gathered before they are multiplied: what fits into the first-level cache with
/// a dozen columns, and is long enough for a matrix product with a hundred.
const BLOCK: usize = 96;

/// Sum of w wᵀ over the rows w = [residual, columns] of a whitened linear model: its first
/// diagonal element is the sum of squares, the rest of the first row the gradient, and the rest
/// the information on the columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Gram {
    size: usize,
    matrix: Vec<f64>,
    block: Vec<f64>,
    held: usize,
}

impl Gram {
    /// Of no rows with `columns` columns beside the residual.
    #[must_use]
    pub fn new(columns: usize) -> Self {
        let size = columns + 1;
        Self {
            size,
            matrix: vec![0.0; size * size],
            block: vec![0.0; size * BLOCK],
            held: 0,
        }
    }

    /// Number of columns beside the residual.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.size - 1
    }

    /// Adds a row; its first element is the residual.
    ///
    /// # Panics
    /// If the row has not one element for the residual and one for each column.
    pub fn add(&mut self, row: &[f64]) {
        let at = self.held * self.size;
        self.block[at..at + self.size].copy_from_slice(row);
        self.held += 1;
        if self.held == BLOCK {
            self.multiply();
        }
    }

    /// The sum, row by row with one row for the residual and one for each column.
    #[must_use]
    pub fn finish(mut self) -> Vec<f64> {
        self.multiply();
        for i in 0..self.size {
            for j in 0..i {
                self.matrix[i * self.size + j] = self.matrix[j * self.size + i];
            }
        }
        self.matrix
    }

    /// Adds the upper triangle of the block's own product.
    fn multiply(&mut self) {
        let size = self.size;
        for row in self.block[..self.held * size].chunks_exact(size) {
            for i in 0..size {
                let factor = row[i];
                // Columns that have not begun yet are zero for whole stretches.
                if factor == 0.0 {
                    continue;
                }
                let sums = &mut self.matrix[i * size + i..(i + 1) * size];
                for (sum, value) in sums.iter_mut().zip(&row[i..]) {
                    *sum += factor * value;
                }
            }
        }
        self.held = 0;
    }
}

//! Results of generated functions as flat vectors, in the order of the program.

/// Appends a result to a flat vector in the order in which a program numbers its nonzeros.
///
/// Sparse results `[T; NNZ]` hold them in that order already; dense ones `[[T; C]; R]` are
/// read column by column, as CasADi stores them.
pub trait Nonzeros<T> {
    /// Appends the scalars of `self` to `flat`.
    fn append_to(&self, flat: &mut Vec<T>);
}

impl<T: Copy, const N: usize> Nonzeros<T> for [T; N] {
    fn append_to(&self, flat: &mut Vec<T>) {
        flat.extend_from_slice(self);
    }
}

impl<T: Copy, const R: usize, const C: usize> Nonzeros<T> for [[T; C]; R] {
    fn append_to(&self, flat: &mut Vec<T>) {
        for column in 0..C {
            flat.extend(self.iter().map(|row| row[column]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dense_matrices_are_read_by_columns() {
        let mut flat = Vec::new();
        [[1, 2, 3], [4, 5, 6]].append_to(&mut flat);
        [7, 8].append_to(&mut flat);
        assert_eq!(flat, [1, 4, 2, 5, 3, 6, 7, 8]);
    }
}

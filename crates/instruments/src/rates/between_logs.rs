//! What logs tell of changes of the bias from one to the next.

use nalgebra::{DMatrix, DVector};

use super::blocks::Blocks;

/// Largest condition number of the columns, each scaled to length one, of determined terms.
const WORST_CONDITION: f64 = 300.0;

/// Differences of the biases of logs that columns leave free: these alone tell how much the bias changes from log to log.
/// None of a single log.
pub(super) fn free_differences(columns: &DMatrix<f64>, logs: &[Blocks]) -> usize {
    with_free_biases(columns, logs).ncols() - columns.ncols()
}

/// The columns with a bias for each log, as far as these are independent of them.
pub(super) fn with_free_biases(columns: &DMatrix<f64>, logs: &[Blocks]) -> DMatrix<f64> {
    let mut all = columns.clone();
    if logs.len() < 2 {
        return all;
    }
    let mut first = 0;
    for log in logs {
        let own = first..first + log.len();
        first = own.end;
        let bias = DVector::from_fn(columns.nrows(), |row, _| {
            f64::from(u8::from(own.contains(&row)))
        });
        let place = all.ncols();
        let mut more = all.clone().insert_column(place, 0.0);
        more.set_column(place, &bias);
        if are_independent(&more) {
            all = more;
        }
    }
    all
}

/// Whether columns are determined together.
pub(super) fn are_independent(columns: &DMatrix<f64>) -> bool {
    let mut scaled = columns.clone();
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length == 0.0 {
            return false;
        }
        column /= length;
    }
    let values = scaled.singular_values();
    values.max() <= WORST_CONDITION * values.min()
}

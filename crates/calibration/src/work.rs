//! Work of passes over records, counted in rows and columns: the same on every machine.

use core::cell::Cell;

thread_local! {
    static SPENT: Cell<u64> = const { Cell::new(0) };
    static OF_A_ROW: Cell<u64> = const { Cell::new(0) };
}

/// Work of the step of the model at a row, in products: the functions and the filter of three states
/// take some five hundred floating-point operations.
const MODEL: u64 = 250;

/// Columns that the streaming filter carries: its states.
const FILTER: usize = 12;

/// Work of all passes over records that this thread has made so far, in products of the sums of their
/// Gram matrices: each row of a pass counts the square of its columns, and a constant for the model.
/// The difference of two values is the work done between them. It is no measure of time: the step of the
/// model takes longer than the products that it counts for, and derivatives by the noise of the gyros are
/// not counted.
#[must_use]
pub fn work() -> u64 {
    SPENT.get()
}

/// The rows that follow carry so many columns.
pub(crate) fn carry(columns: usize) {
    // Residual and three moving states beside the columns; half of a symmetric matrix, three outputs.
    let columns = columns as u64 + 4;
    OF_A_ROW.set(MODEL + 3 * columns * columns / 2);
}

/// A pass has come to a row.
pub(crate) fn count_row() {
    SPENT.set(SPENT.get().wrapping_add(OF_A_ROW.get()));
}

/// A streaming filter has come to a row.
pub(crate) fn count_filtered_row() {
    carry(FILTER);
    count_row();
}
